"""No memory port is read and written in a clock.

A clock that writes a port may leave anything on its read side: two cores in the same state, one with any
words there, go to the same state and put out the same. It is shown as the step of an induction, from
every state that its control does not exclude. Registers and words of the memories are found by yosys.
"""

import sys

from cores import CORES, HERE, source, without
from solver import Trial, plant, prove

PROPERTY = "reads_nothing_where_it_writes"
# Core, file, and what is planted in it.
BUGS = [
    ("rls", "rls_ctrl.v", "(state == RFW_R)) & second & take", "(state == RFW_R)) & second & take | rb_we"),
    ("rls", "rls_ctrl.v", "assign p_en      = (dot |", "assign p_en      = (dot | load |"),
    ("rls, forgetting", "rls_core.v", "scale ? IALPHA : rb_rdata", "rb_rdata"),
    ("rls, slow units", "rls_ctrl.v", "assign p_en      = (dot |", "assign p_en      = (dot | (state == RIL_W) |"),
    ("rls, a division for each element", "rls_core.v", "rb_sel ? mul_q : add_q", "rb_sel ? mul_q : rb_rdata"),
    ("lms", "lms_ctrl.v", "assign rr_en     = state == LMW_R", "assign rr_en     = state == LMW_W"),
    ("nlms", "lms_core.v", "add_sel == 2'd1 ? rr", "add_sel == 2'd1 ? rb_rdata"),
    ("sign_lms", "sign_lms_ctrl.v", "assign rr_a_en     = take", "assign rr_a_en     = state == L_W"),
    ("rls, fixed point", "rls_fixed_core.v", "& second) rr <= rb_rdata", "& second | (state == RFR_M)) rr <= rb_rdata"),
    ("nlms, fixed point", "lms_fixed_core.v", "clear ? {WW{1'b0}} : w_word", "clear ? rb_rdata : w_word"),
    ("sign_lms, fixed point", "sign_lms_ctrl.v", "assign rr_b_en     = state == LMW_R",
     "assign rr_b_en     = rb_we"),
]


def trial(core, bug=None):
    """Two of a core, one of which reads anything where it writes."""
    design = CORES[core]
    sources = {name: source(name) for name in design.files}
    if bug:
        name, right, wrong = bug
        sources[name] = plant(name, sources[name], right, wrong)
    # What control.py proves of the states that there are; "1'b1" where all hold.
    core_file = f"{design.top}.v"
    sources[core_file] = sources[core_file].replace("endmodule", f"always @* assume ({design.told});\nendmodule")
    if "fx.v" in sources:
        sources["fx.v"] = without(sources["fx.v"], "fx_div")
    sources["units.sv"] = (HERE / "units.sv").read_text()
    files = " ".join(f"@/{name}" for name in sources)
    parameters = " ".join(f"-set {name} {value}" for name, value in design.parameters.items())
    script = []
    for copy, define in [("told", ""), ("any", "-DANY")]:
        script += [f"read_verilog -sv -formal -DSYNTHESIS {define} {files}",
                   f"chparam {parameters} {design.top}", f"prep -flatten -top {design.top}",
                   "memory_map", "dffunmap", "opt_clean", "expose t:$dff %co1:+[Q] w:* %i",
                   f"rename {design.top} {copy}", f"design -stash {copy}", "design -reset-vlog"]
    script += ["design -copy-from told told", "design -copy-from any any",
               "miter -equiv -flatten -make_assert told any both", "hierarchy -top both", "chformal -lower"]
    return Trial(f"{core}: {right}" if bug else core, sources, script, ["-i", "-t", "1"], "z3")


def run(scratch):
    proofs = [trial(core) for core in CORES]
    planted = [trial(core, bug) for core, *bug in BUGS]
    answers = prove(f"memory ports, {PROPERTY}", scratch, proofs, planted)
    for question, answer in zip(planted, answers):
        if answer.passed or "Assert failed" not in answer.text:
            sys.exit(f"{question.name}: planted, and {PROPERTY} holds\n{answer.text}")
    if missing := set(CORES) - {core for core, *_ in BUGS}:
        sys.exit(f"no bug is planted in {sorted(missing)}")
    print(f"memory ports: {PROPERTY} by induction in {len(CORES)} cores: {'; '.join(CORES)}")
    print(f"  broken by each of {len(BUGS)} planted bugs")
