// Behavioural floating-point units: one clock, combinational, round to nearest even, no fusion.
// For simulation only; replace them by your vendor's or an open-source unit of the same ports.
//
// W = 64 is IEEE 754 binary64, W = 32 binary32. FTZ = 1 reads subnormal operands as zero and
// returns zero for subnormal results, with their sign. NaNs leave in the canonical form.
// binary32 results go through binary64: rounding twice is harmless there, since 53 >= 2*24 + 2.
`timescale 1ns/1ps

module fp_sim #(
    parameter W = 64,
    parameter FTZ = 0,
    parameter OPERATION = 0             // 0 add or subtract, 1 multiply, 2 divide
) (
    input  wire [W-1:0] a,
    input  wire [W-1:0] b,
    input  wire         sub,
    output reg  [W-1:0] q
);
    // 2^-149, the smallest binary32 subnormal, is a normal binary64.
    localparam [63:0] TINY = 64'h36a0_0000_0000_0000;

    function [63:0] widen(input [63:0] v);
        reg [10:0] exponent;
        reg [31:0] fraction;
        reg [63:0] magnitude;
        begin
            if (W == 64) begin
                widen = v;
                if (FTZ != 0 && v[62:52] == 0) widen = {v[63], 63'd0};
            end else begin
                fraction = {9'd0, v[22:0]};
                exponent = {3'd0, v[30:23]} + 11'd896;
                if (v[30:23] == 8'hff)
                    widen = {v[31], 11'h7ff, v[22:0], 29'd0};
                else if (v[30:23] != 0)
                    widen = {v[31], exponent, v[22:0], 29'd0};
                else if (FTZ != 0 || v[22:0] == 0)
                    widen = {v[31], 63'd0};
                else begin
                    magnitude = $realtobits($itor(fraction) * $bitstoreal(TINY));
                    widen = {v[31], magnitude[62:0]};
                end
            end
        end
    endfunction

    function [63:0] narrow(input [63:0] v);
        reg [52:0] significand;
        reg [31:0] rounded;
        reg guard, sticky;
        integer shift;
        begin
            if (W == 64) begin
                narrow = v;
                if (v[62:52] == 11'h7ff && v[51:0] != 0) narrow = 64'h7ff8_0000_0000_0000;
                else if (FTZ != 0 && v[62:52] == 0) narrow = {v[63], 63'd0};
            end else begin
                rounded = 0;
                if (v[62:52] == 11'h7ff)
                    rounded = (v[51:0] != 0) ? 32'h7fc0_0000 : {v[63], 8'hff, 23'd0};
                else begin
                    significand = {1'b1, v[51:0]};
                    shift = 897 - v[62:52];
                    if (shift <= 0) begin
                        // Normal: the rounding carry may run into the exponent, up to infinity.
                        rounded = {1'b0, 8'd1, v[51:29]} + ((0 - shift) << 23);
                        guard = v[28];
                        sticky = |v[27:0];
                        if (v[62:52] >= 1151) begin
                            rounded = 32'h7f80_0000;
                            guard = 0;
                            sticky = 0;
                        end
                    end else if (shift <= 24) begin
                        rounded = significand >> (29 + shift);
                        guard = significand[28 + shift];
                        sticky = |(significand & ((53'd1 << (28 + shift)) - 53'd1));
                    end else begin
                        guard = 0;
                        sticky = 0;
                    end
                    if (guard && (sticky || rounded[0])) rounded = rounded + 1;
                    if (FTZ != 0 && rounded[30:23] == 0) rounded = 0;
                    rounded[31] = v[63];
                end
                narrow = {32'd0, rounded};
            end
        end
    endfunction

    generate
        if (W == 64 && FTZ == 0) begin : plain
            // The same without conversions, for speed.
            reg [63:0] bits;
            always @* begin
                if (OPERATION == 1) bits = $realtobits($bitstoreal(a) * $bitstoreal(b));
                else if (OPERATION == 2) bits = $realtobits($bitstoreal(a) / $bitstoreal(b));
                else if (sub) bits = $realtobits($bitstoreal(a) - $bitstoreal(b));
                else bits = $realtobits($bitstoreal(a) + $bitstoreal(b));
                if (&bits[62:52] && |bits[51:0]) bits = 64'h7ff8_0000_0000_0000;
                q = bits;
            end
        end else begin : converted
            real x, z, r;
            reg [63:0] bits;
            always @* begin
                x = $bitstoreal(widen({{(64 - W){1'b0}}, a}));
                z = $bitstoreal(widen({{(64 - W){1'b0}}, b}));
                if (OPERATION == 1) r = x * z;
                else if (OPERATION == 2) r = x / z;
                else if (sub) r = x - z;
                else r = x + z;
                bits = narrow($realtobits(r));
                q = bits[W-1:0];
            end
        end
    endgenerate
endmodule

module fp_add #(parameter W = 64, parameter FTZ = 0) (
    input wire [W-1:0] a, input wire [W-1:0] b, input wire sub, output wire [W-1:0] q
);
    fp_sim #(.W(W), .FTZ(FTZ), .OPERATION(0)) unit (.a(a), .b(b), .sub(sub), .q(q));
endmodule

module fp_mul #(parameter W = 64, parameter FTZ = 0) (
    input wire [W-1:0] a, input wire [W-1:0] b, output wire [W-1:0] q
);
    fp_sim #(.W(W), .FTZ(FTZ), .OPERATION(1)) unit (.a(a), .b(b), .sub(1'b0), .q(q));
endmodule

module fp_div #(parameter W = 64, parameter FTZ = 0) (
    input wire [W-1:0] a, input wire [W-1:0] b, output wire [W-1:0] q
);
    fp_sim #(.W(W), .FTZ(FTZ), .OPERATION(2)) unit (.a(a), .b(b), .sub(1'b0), .q(q));
endmodule
