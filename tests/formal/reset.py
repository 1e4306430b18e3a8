"""After a reset in any state, the memories of every core hold their initial words once it is ready again."""

import re
import sys

from cores import CORES, HERE, RTL, sources
from solver import Trial, break_each, prove

TOP = "reset_properties"
# Clocks: two resets and the clearing of the largest core behind each of them.
DEPTH = "24"
# Core, file, and what is planted in it.
BUGS = [
    ("rls", "rls_ctrl.v", "            second  <= 1'b0;\n            i       <=", "            i       <="),
    ("rls", "rls_ctrl.v", "            element <= B_R;\n        end", "        end"),
    ("rls, forgetting", "rls_ctrl.v", "if (rst) begin\n            state   <= CLEAR",
     "if (rst && state != CLEAR) begin\n            state   <= CLEAR"),
    ("rls, slow units", "rls_core.v", "clear ? zero : ra_sel ? x", "ra_sel ? x"),
    ("rls, a division for each element", "rls_core.v", "clear_diag ? DELTA : clear ? zero", "clear ? zero"),
    ("rls", "rls_core.v", "            yy  <= {W{1'b0}};\n        end", "        end"),
    ("lms", "lms_ctrl.v", "take | (state == CLEAR)", "take"),
    ("nlms", "lms_ctrl.v", "CLEAR:   state <= last ? IDLE : CLEAR", "CLEAR:   state <= IDLE"),
    ("sign_lms", "sign_lms_core.v", "clear ? W0 : add_q", "clear ? {W{1'b0}} : add_q"),
    ("rls, fixed point", "rls_fixed_core.v", "            j        <= {IB{1'b0}};\n            head",
     "            head"),
    ("nlms, fixed point", "lms_ctrl.v", "            state <= CLEAR;\n            j     <= {AB{1'b0}};",
     "            state <= CLEAR;"),
    ("sign_lms, fixed point", "sign_lms_fixed_core.v", "clear ? w0_word : w_word", "w_word"),
]


# What a test bench sees of the watched words of both memories.
WATCHED = [f"connect -set {port}_{name} \\dut.ram{port}.{signal}" for port in "ab"
           for name, signal in [("at", "watched"), ("word", "word")]]


def memory():
    """Text of the memory, whose first words are anything; one that the solver chooses can be looked at."""
    text, count = re.subn(r"^    initial begin$.*?^    end$", """\
    wire [AW-1:0] watched = $anyconst;
    wire [W-1:0]  word    = mem[watched];""", (RTL / "sp_ram.v").read_text(), flags=re.DOTALL | re.MULTILINE)
    assert count == 1, "the initial words of sp_ram.v are not where they were"
    return text


def trial(core, question, bug=None):
    texts = sources(core, "reset.sv", bug=bug) | {"sp_ram.v": memory()}
    files = " ".join(f"@/{file}" for file in texts if file != "core.vh")
    script = [f"read_verilog -sv -formal -DSYNTHESIS -I@/ {files}", f"hierarchy -check -top {TOP}", "proc", "flatten",
              *WATCHED,
              f"prep -top {TOP}", "memory_map", "async2sync", "chformal -lower"]
    return Trial(f"{core}: {bug[1] if bug else question[0]}", texts, script, question)


def run(scratch):
    properties = set(re.findall(r"(\w+): +assert ", (HERE / "reset.sv").read_text()))
    proofs = [trial(core, question) for core in CORES
              for question in (["-t", f"0:{DEPTH}:{DEPTH}"], ["-c", "-t", DEPTH])]
    planted = [trial(core, ["-t", f"0:{DEPTH}:{DEPTH}"], bug) for core, *bug in BUGS]
    break_each(planted, prove("reset", scratch, proofs, planted), properties)
    if missing := set(CORES) - {core for core, *_ in BUGS}:
        sys.exit(f"no bug is planted in {sorted(missing)}")
    print(f"reset, from any registers and memories in {len(CORES)} cores: {', '.join(sorted(properties))}")
    print(f"  each broken by one of {len(BUGS)} planted bugs, and a bug in every core found")
