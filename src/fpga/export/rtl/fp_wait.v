// The handshake of a floating-point unit: counts the clocks of an operation.
//
//   req  ---->|         |----> done   in the LATENCY-th clock of req, and on until take
//   take ---->| fp_wait |----> first  in the first one
//
// The operands are held while req is up. take, up in a clock with done, ends the operation; req may
// stay up, and the next clock then begins another one. req withdrawn before is forgotten.
`default_nettype none

module fp_wait #(
    parameter LATENCY = 1
) (
    input  wire clk,
    input  wire rst,
    input  wire req,
    input  wire take,
    output wire first,      // first clock of an operation
    output wire done
);
    generate
        if (LATENCY > 1) begin : counted
            localparam CB = $clog2(LATENCY);
            /* verilator lint_off WIDTH */
            localparam [CB-1:0] LAST = LATENCY - 1;
            /* verilator lint_on WIDTH */
            reg [CB-1:0] waited;
            wire is_last = waited == LAST;
            always @(posedge clk)
                if (rst | ~req | (is_last & take)) waited <= {CB{1'b0}};
                else if (!is_last) waited <= waited + 1'b1;
            assign done  = req & is_last;
            assign first = waited == {CB{1'b0}};
        end else begin : at_once
            assign done  = req;
            assign first = 1'b1;
            /* verilator lint_off UNUSED */
            wire unused = clk | rst | take;
            /* verilator lint_on UNUSED */
        end
    endgenerate
endmodule

`default_nettype wire
