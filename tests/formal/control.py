"""Control of every core: no sample is lost or doubled whatever source and units do, and every state is reached."""

import re
import sys

from cores import CORES, HERE, sources, states
from solver import Trial, all_broken, prove

TOP = "control_properties"
# Clocks beyond a sample: the reset, the clearing and some in which the source or a unit lets the core wait.
MORE_CLOCKS = 14
# Core, file, what is planted in it, and what that may break.
BUGS = [
    ("rls", "rls_ctrl.v", "out_valid <= ~rst & y_en", "out_valid <= y_en | (state == LRL_W)",
     {"result_of_a_sample", "result_in_its_clock", "under_way_by_state", "takes_none_before_result"}),
    ("rls", "rls_ctrl.v", "assign in_ready  = state == LOAD", "assign in_ready  = (state == LOAD) | y_en",
     {"takes_none_before_result", "under_way_by_state"}),
    ("rls", "rls_ctrl.v", "(mul_req & ~mul_done) | (div_req", "(div_req", {"still_while_a_unit_waits"}),
    ("rls", "rls_ctrl.v", "corrected | (state == RFW_W)) & take", "corrected | (state == RFW_W))",
     {"writes_no_unready_word"}),
    ("rls, slow units", "rls_ctrl.v", "RFR_W:   state <= !corrected ? RFR_W :", "RFR_W:   state <=",
     {"result_in_its_clock"}),
    ("rls, forgetting", "rls_ctrl.v", "(element == B_LAST) ? IDLE", "(element == B_LAST) ? 4'd15",
     {"state_has_a_name"}),
    ("lms", "lms_ctrl.v", "!last ? LMW_R : in_valid ? LOAD : IDLE", "!last ? LMW_R : in_valid ? OUT_R : IDLE",
     {"under_way_by_state", "takes_what_is_offered", "result_of_a_sample"}),
    ("nlms", "lms_ctrl.v", "LOAD:    state <= !in_valid ? IDLE :", "LOAD:    state <=",
     {"under_way_by_state", "result_of_a_sample"}),
    ("nlms", "lms_ctrl.v", "assign out_valid = (state == ERR) & ~stall", "assign out_valid = (state == ERR)",
     {"result_of_a_sample", "under_way_by_state", "result_in_its_clock"}),
    ("nlms", "lms_ctrl.v", "assign out_valid = (state == ERR) & ~stall",
     "assign out_valid = ((state == ERR) & ~stall) | (state == IDLE)", {"result_of_a_sample"}),
    ("sign_lms", "sign_lms_ctrl.v", "IDLE:    state <= in_valid ? L_R : IDLE", "IDLE:    state <= IDLE",
     {"takes_what_is_offered"}),
    ("rls, fixed point", "rls_fixed_core.v", "out_valid <= ~rst & (state == OUT_W) & ~stall",
     "out_valid <= ~rst & (state == OUT_W)", {"result_in_its_clock", "result_of_a_sample", "under_way_by_state"}),
]
# Core, file, what is planted in it, and a state that is then not reached.
LEFT_OUT = [
    ("rls", "rls_ctrl.v", "RFM_R:   state <= last_j ? RFM_W", "RFM_R:   state <= last_j ? OUT_R", "RFM_W"),
    ("rls, slow units", "rls_ctrl.v", "OUT_R:   state <= last_j ? OUT_W", "OUT_R:   state <= last_j ? RFW_R", "OUT_W"),
    ("nlms", "lms_ctrl.v", "NLMS != 0 ? LL_R : OUT_R", "OUT_R", "LL_R"),
    ("sign_lms", "sign_lms_ctrl.v", "NRM_A:   state <= NRM_W", "NRM_A:   state <= OUT_R", "NRM_W"),
    ("rls, fixed point", "rls_fixed_core.v", "if (!corrected) state <= RFR_M", "if (!corrected) state <= OUT_R",
     "RFR_M"),
]


def clocks(core):
    return str(CORES[core].period + MORE_CLOCKS)


def at_once(core):
    """All clocks in one question, which takes the solver less time than a question for each."""
    return ["-t", f"0:{clocks(core)}:{clocks(core)}"]


def trial(core, name, question, defines="", bug=None):
    design = CORES[core]
    texts = sources(core, "control.sv", bug=bug)
    covers = "".join(f"            {state.lower()}_reached: cover (state == 4'd{number});\n"
                     for state, number in states(core).items())
    texts["control.sv"] = texts["control.sv"].replace(
        "            // States.\n", f"`ifdef STATES\n{covers}`endif\n")
    waits = [f"\\dut.{unit}.waits" for unit in design.units] + 3 * ["1'b0"]
    connections = {
        "state": f"\\dut.{design.inside}state",
        "second": f"\\dut.{design.inside}second" if design.second else "1'b0",
        "ra_we": "\\dut.ra_we", "rb_we": "\\dut.rb_we",
        "waits_a": waits[0], "waits_b": waits[1], "waits_c": waits[2],
    }
    files = " ".join(f"@/{file}" for file in texts if file != "core.vh")
    script = [f"read_verilog -sv -formal -DSYNTHESIS {defines} -I@/ {files}", f"hierarchy -check -top {TOP}",
              "proc", "flatten", *[f"connect -set {left} {right}" for left, right in connections.items()],
              f"prep -top {TOP}", "async2sync", "chformal -lower"]
    return Trial(f"{core}: {name}", texts, script, question)


def run(scratch):
    text = (HERE / "control.sv").read_text()
    properties = set(re.findall(r"(\w+): +assert ", text))
    bounded = set(re.findall(r"(\w+): +assert ", text[text.index("// Neither of these"):]))
    proofs = []
    for core in CORES:
        proofs += [trial(core, "start of the induction", ["-t", "3"]),
                   trial(core, "step of the induction", ["-i", "-t", "3"]),
                   trial(core, "bounded", at_once(core), "-DBOUNDED"),
                   trial(core, "states", ["-c", "-t", clocks(core)], "-DSTATES")]
    planted = [trial(core, right, at_once(core), "-DBOUNDED", (file, right, wrong))
               for core, file, right, wrong, _ in BUGS]
    left_out = [trial(core, right, ["-c", "-t", clocks(core)], "-DSTATES", (file, right, wrong))
                for core, file, right, wrong, _ in LEFT_OUT]
    answers = prove("control", scratch, proofs, planted + left_out)
    broken = set()
    for (core, _, right, wrong, wanted), answer in zip(BUGS, answers):
        found = answer.broken(properties)
        if not found & wanted:
            sys.exit(f"{core}: {right} -> {wrong}: broke {found or 'nothing'}, wanted one of {wanted}\n{answer.text}")
        broken |= found
    all_broken(properties, broken)
    for (core, *_, state), answer in zip(LEFT_OUT, answers[len(planted):]):
        if answer.passed or f"Unreached cover statement at {TOP}: {state.lower()}_reached" not in answer.text:
            sys.exit(f"{core}: {state} is reached without the way to it\n{answer.text}")
    print(f"control, by induction in {len(CORES)} cores: {', '.join(sorted(properties - bounded))}")
    print(f"  through a sample after a reset: {', '.join(sorted(bounded))}")
    print(f"  each broken by one of {len(BUGS)} planted bugs")
    print(f"states, all reached: {'; '.join(f'{core} {len(states(core))}' for core in CORES)}")
    print(f"  one is not with each of {len(LEFT_OUT)} planted bugs")
