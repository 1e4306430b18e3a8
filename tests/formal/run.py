"""Proves properties of the exported Verilog, and shows that each fails on a planted bug.

    python3 tests/formal/run.py

SBY, YOSYS and SMTBMC name the programs. A proof is by induction, from reset on, for any input. A bug is
planted in the text of the design; a run of a few clocks from reset has to break one of the properties that
are named beside it, and between them the bugs break every property of the file.
"""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
RTL = HERE.parent.parent / "src/fpga/export/rtl"
PROGRAMS = [os.environ.get(name, usual) for name, usual in
            [("SBY", "sby"), ("YOSYS", "yosys"), ("SMTBMC", "yosys-smtbmc")]]
# Registers of the ports that the properties know by name.
REGISTERS = ("due", "held", "waited", "waiting")
SCRIPT = """[options]
mode {mode}
depth {depth}
[engines]
smtbmc --nopresat z3
[script]
read_verilog -sv -formal axi_stream.v axi_stream.sv
hierarchy -check -top axi_stream_properties
proc
flatten
{registers}
prep -top axi_stream_properties
[files]
axi_stream.v
axi_stream.sv
"""

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


def check(folder, mode, depth, design):
    """Runs SBY in a folder; whether it passed, and what it printed."""
    folder.mkdir()
    (folder / "axi_stream.v").write_text(design)
    (folder / "axi_stream.sv").write_text((HERE / "axi_stream.sv").read_text())
    registers = "\n".join(f"connect -set dut_{name} \\dut.{name}" for name in REGISTERS)
    (folder / "run.sby").write_text(SCRIPT.format(mode=mode, depth=depth, registers=registers))
    sby, yosys, smtbmc = PROGRAMS
    run = subprocess.run([sby, "--yosys", yosys, "--smtbmc", smtbmc, "-f", "run.sby"], cwd=folder,
                         capture_output=True, text=True, check=False)
    return run.returncode == 0, run.stdout + run.stderr


def main():
    design = (RTL / "axi_stream.v").read_text()
    properties = set(re.findall(r"(\w+): assert ", (HERE / "axi_stream.sv").read_text()))
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        for mode, depth, words in [("prove", 3, "successful proof by k-induction"),
                                   ("cover", 14, "reached cover statement")]:
            passed, text = check(scratch / mode, mode, depth, design)
            if not passed or words not in text:
                sys.exit(f"{mode}: not passed\n{text}")
        print(f"stream ports: {len(properties)} properties proved by induction, for any source and sink")
        broken = set()
        for number, (right, wrong, wanted) in enumerate(BUGS):
            if design.count(right) != 1:
                sys.exit(f"not once in axi_stream.v: {right}")
            passed, text = check(scratch / f"bug{number}", "bmc", 24, design.replace(right, wrong))
            found = set(re.findall(r"failed assertion axi_stream_properties\.(\w+)", text))
            if passed or not found or not found <= wanted:
                sys.exit(f"{right} -> {wrong}: broke {found or 'nothing'}, wanted one of {wanted}\n{text}")
            broken |= found
        if properties - broken:
            sys.exit(f"no bug breaks {sorted(properties - broken)}")
        print(f"{len(BUGS)} planted bugs break each of them")


if __name__ == "__main__":
    main()
