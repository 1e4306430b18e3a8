// Values a params.vh may leave out.
`ifndef VEC_WIDTH
`define VEC_WIDTH 64
`endif
`ifndef VEC_FTZ
`define VEC_FTZ 0
`endif
`ifndef VEC_UPDATE_SUB
`define VEC_UPDATE_SUB 0
`endif
`ifndef VEC_TRACE_CLOCKS
`define VEC_TRACE_CLOCKS 0
`endif
`ifndef VEC_CLOCK_PS
`define VEC_CLOCK_PS 25000
`endif
`ifdef VEC_UNITS_PERIOD
`ifndef VEC_OTHER_UNITS
`define VEC_OWN_UNITS
`endif
`endif
`ifndef VEC_ADD_LATENCY
`define VEC_ADD_LATENCY 1
`endif
`ifndef VEC_MUL_LATENCY
`define VEC_MUL_LATENCY 1
`endif
`ifndef VEC_DIV_LATENCY
`define VEC_DIV_LATENCY 1
`endif
`ifndef VEC_SCALES
`define VEC_SCALES 0
`endif
`ifndef VEC_SPLIT
`define VEC_SPLIT 0
`endif
// Bits of a top level's ports.
`ifndef VEC_TOP_SAMPLE_BITS
`define VEC_TOP_SAMPLE_BITS (`VEC_TOP_CODE != 0 ? 32 : `VEC_WIDTH)
`endif
`ifndef VEC_TOP_RESULT_BITS
`define VEC_TOP_RESULT_BITS `VEC_WIDTH
`endif
