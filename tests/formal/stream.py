"""The stream ports, for any input, by induction from reset on.

A bug is planted in the text of the ports; a run of a few clocks from reset has to break one of the properties
that are named beside it, and between them the bugs break every property of the file.
"""

import re
import sys

from cores import HERE, RTL
from solver import Trial, all_broken, plant, prove

# Registers of the ports that the properties know by name.
REGISTERS = ("due", "held", "waited", "waiting")
TOP = "axi_stream_properties"

# What is planted, and the properties that it may break.
BUGS = [
    ("sample_valid  = s_axis_tvalid & s_axis_tready", "sample_valid  = s_axis_tvalid",
     {"source_is_filter"}),
    ("sample        = s_axis_tdata[SB-1:0]", "sample        = s_axis_tdata[SB-1:0] ^ 1'b1",
     {"word_is_sample"}),
    ("aresetn & sample_ready & ~due[1]", "sample_ready & ~due[1]", {"not_in_reset"}),
    ("aresetn & sample_ready & ~due[1]", "aresetn & sample_ready", {"at_most_two"}),
    ("{1'b0, taken} - {1'b0, given}", "{1'b0, taken}", {"held_counts"}),
    ("assign m_axis_tvalid = held != 2'd0", "assign m_axis_tvalid = held == 2'd1", {"none_lost", "waits"}),
    ("if (given | (held == 2'd0)) oldest", "if (given | result_valid) oldest", {"in_order", "waits"}),
    ("if (given | (held == 2'd0)) oldest", "if (given) oldest", {"in_order"}),
    ("m_axis_tdata = {{(RD-RB){oldest[RB-1]}}, oldest}",
     "m_axis_tdata = {{(RD-RB){result[RB-1]}}, oldest}", {"waits", "in_order"}),
    ("lost       | (flag_overrun & ~flags_clear)", "(lost | flag_overrun) & ~flags_clear", {"flags"}),
    ("~s_axis_tvalid | (sample != waiting)", "~s_axis_tvalid", {"flags"}),
    ("s_axis_tvalid & ~s_axis_tready", "s_axis_tvalid", {"memory", "flags"}),
    ("            due    <= 2'd0;\n", "", {"held_counts"}),
]


def trial(name, question, design):
    sources = {"axi_stream.v": design, "axi_stream.sv": (HERE / "axi_stream.sv").read_text()}
    script = ["read_verilog -sv -formal @/axi_stream.v @/axi_stream.sv", f"hierarchy -check -top {TOP}",
              "proc", "flatten",
              *[f"connect -set dut_{register} \\dut.{register}" for register in REGISTERS],
              f"prep -top {TOP}", "async2sync", "chformal -lower"]
    return Trial(name, sources, script, question, "z3")


def run(scratch):
    design = (RTL / "axi_stream.v").read_text()
    properties = set(re.findall(r"(\w+): assert ", (HERE / "axi_stream.sv").read_text()))
    proofs = [trial("start of the induction", ["-t", "3"], design),
              trial("step of the induction", ["-i", "-t", "3"], design),
              trial("two words wait and go", ["-c", "-t", "14"], design)]
    planted = [trial(right, ["-t", "24"], plant("axi_stream.v", design, right, wrong))
               for right, wrong, _ in BUGS]
    answers = prove("stream ports", scratch, proofs, planted)
    print(f"stream ports: {len(properties)} by induction: {', '.join(sorted(properties))}")
    broken = set()
    for (right, wrong, wanted), answer in zip(BUGS, answers):
        found = answer.broken(properties)
        if not found or not found <= wanted:
            sys.exit(f"{right} -> {wrong}: broke {found or 'nothing'}, wanted one of {wanted}\n{answer.text}")
        broken |= found
    all_broken(properties, broken)
    print(f"  each broken by one of {len(BUGS)} planted bugs")
