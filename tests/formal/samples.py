"""Two samples of the least-mean-squares cores with two taps, word for word against the algorithm.

Words have four bits, and a unit is a function of its operands of which the solver knows nothing else. What the
core gives has to be what the operations below give, each with its operands in their order.
"""

import re

from cores import CORES, HERE, header, source
from reset import WATCHED, memory
from solver import Trial, break_each, plant, prove

TOP = "samples_properties"


class Algorithm:
    """Operations of two samples, written down as Verilog."""

    def __init__(self, parameters):
        self.parameters = parameters
        self.lines = []

    def word(self, text):
        name = f"word_{len(self.lines)}"
        self.lines.append(f"    wire [3:0] {name} = {text};")
        return name

    def told(self, unit, *operands):
        """The result of the unit's next operation."""
        name = f"word_{len(self.lines)}"
        sub, a, b = ("", *operands)[-3:]
        ports = (f".sub({sub}), " if sub else "") + f".a({a}), .b({b}), .q({name})"
        self.lines.append(f"    wire [3:0] {name}; told_{unit} unit_{name} ({ports});")
        return name

    def add(self, a, b):
        return self.told("sum", "1'b0", a, b)

    def subtract(self, a, b):
        return self.told("sum", "1'b1", a, b)

    def multiply(self, a, b):
        return self.told("product", a, b)

    def divide(self, a, b):
        return self.told("quotient", a, b)

    def constant(self, name):
        return f"4'd{self.parameters[name]}"

    def dot(self, start, left, right):
        for a, b in zip(left, right):
            start = self.add(start, self.multiply(a, b))
        return start

    def text(self, results, first, second):
        """Text of algorithm.vh: the results, and both memories after the samples."""
        lines = [f"    wire [3:0] y_{n} = {result};" for n, result in enumerate(results)]
        for memory_of, at, words in [("first_after", "a_at", first), ("second_after", "b_at", second)]:
            choice = " : ".join(f"{at} == {k} ? {word}" for k, word in enumerate(words[:-1]))
            lines.append(f"    wire [3:0] {memory_of} = {choice} : {words[-1]};")
        return "\n".join(self.lines + lines) + "\n"


UNITS = """(define-sort Word () (_ BitVec 4))
(declare-fun sum (Bool Word Word) Word)
(declare-fun product (Word Word) Word)
(declare-fun quotient (Word Word) Word)
"""
ZERO, HALF = "4'd0", "4'd2"


def lms(algorithm):
    f, constant = algorithm, algorithm.constant
    ring, weights, results, previous = [ZERO, ZERO], [ZERO, ZERO], [], ZERO
    for n in range(2):
        desired = f.multiply(f.add(f"x_{n}", previous), HALF)
        previous = ring[n] = f"x_{n}"
        taps = [ring[n], ring[1 - n]]
        gain = constant("MU")
        if f.parameters["NLMS"]:
            gain = f.divide(gain, f.dot(constant("EPS"), taps, taps))
        results.append(f.dot(ZERO, taps, weights))
        step = f.multiply(f.subtract(desired, results[n]), gain)
        weights = [f.add(weights[j], f.multiply(taps[j], step)) for j in range(2)]
    return f.text(results, ring, weights)


def nan(word):
    return f"{word}[2:0] > 4"


def sign_lms(algorithm):
    f, constant = algorithm, algorithm.constant
    ring, weights, results = [ZERO, ZERO], 2 * [constant("W0")], []
    norm = fresh = ZERO
    for n in range(2):
        square = f.multiply(f"x_{n}", f"x_{n}")
        fresh = f.add(fresh, square)
        old = f.multiply(ring[n], ring[n])
        norm = f.subtract(f.add(norm, square), old)
        # The fresh norm is complete after two samples.
        norm = fresh if n == 1 else f.word(f"{norm}[3] ? {ZERO} : {norm}")
        ring[n] = f"x_{n}"
        taps = [ring[n], ring[1 - n]]
        rcp = f.divide(constant("MU"), f.add(constant("ALPHA"), norm))
        results.append(f.dot(ZERO, taps, weights))
        error = f.subtract(f"d_{n}", results[n])
        if f.parameters["NLMS"]:
            step = f.multiply(error, rcp)
        else:
            step = f.word(f"{error}[2:0] == 0 || {nan(error)} ? {ZERO} : "
                          f"{nan(rcp)} || !{error}[3] ? {rcp} : {{~{rcp}[3], {rcp}[2:0]}}")
        weights = [f.add(weights[j], f.multiply(taps[j], step)) for j in range(2)]
    return f.text(results, ring, weights)


# Cores, their algorithms and constants.
CASES = {
    "lms": (lms, {"MU": 5, "NLMS": 0}),
    "nlms": (lms, {"MU": 5, "EPS": 6, "NLMS": 1}),
    "sign_lms": (sign_lms, {"MU": 5, "ALPHA": 6, "W0": 3, "RECOMPUTE": 2, "NLMS": 0}),
}
# Clocks that units withhold their results in a run, at most.
WITHHELD = 1
# Core, file, and what is planted in it.
BUGS = [
    ("lms", "lms_core.v", "add_sel == 2'd3 ? xp : p", "add_sel == 2'd3 ? x : p"),
    ("lms", "lms_ctrl.v", "wire [AB-1:0] slot_next = slot == {AB{1'b0}} ? LAST : slot - 1'b1",
     "wire [AB-1:0] slot_next = slot"),
    ("lms", "lms_core.v", "clear ? {W{1'b0}} : x;", "clear ? {W{1'b0}} : d;"),
    ("lms", "lms_core.v", "acc_eps ? EPS : {W{1'b0}}", "acc_eps ? EPS : yy ^ dd"),
    ("nlms", "lms_core.v", ".a(MU), .b(den)", ".a(den), .b(MU)"),
    ("nlms", "lms_ctrl.v", "assign rcp_en    = div_req & div_done", "assign rcp_en    = div_req & ~div_done"),
    ("nlms", "lms_core.v", "mul_sel == 3'd3 ? HALF", "mul_sel == 3'd5 ? HALF"),
    ("sign_lms", "sign_lms_core.v", "norm_fresh ? fresh : add_q[W-1]", "norm_fresh ? norm : add_q[W-1]"),
    ("sign_lms", "sign_lms_core.v", ".a(mul_sel == 3'd1 ? x : mul_sel == 3'd2 ? rr",
     ".a(mul_sel == 3'd1 ? x : mul_sel == 3'd2 ? x"),
    ("sign_lms", "sign_lms_core.v", "rcp[W-1] ^ (ee[W-1] & ~rcp_nan)", "rcp[W-1]"),
]


def short(text):
    """The text of a file with the constants of a format of four bits: sign, exponent of one bit, fraction."""
    for name, value in [("ONE", 1), ("HALF", 2), ("FB", 2)]:
        text = re.sub(rf"(localparam .*\b{name} *= )W == 64 \? .*?;", rf"\g<1>{value};", text)
    return text


def trial(core, mode, bug=None):
    algorithm, constants = CASES[core]
    design = CORES[core]
    withheld = WITHHELD if design.units else 0
    # Reset, clearing, two samples, and the clock in which the core is ready for the next.
    clocks = 2 * design.period + withheld + 6
    taps = {name: 2 for name in ("N", "M") if name in design.parameters}
    texts = {file: source(file) for file in design.files}
    if bug:
        file, right, wrong = bug
        texts[file] = plant(file, texts[file], right, wrong)
    texts = {file: short(text) for file, text in texts.items()}
    parameters = ", ".join(f".{name}({value})" for name, value in (constants | taps | {"W": 4}).items())
    texts["core.vh"] = re.sub("`define PARAMETERS .*", f"`define PARAMETERS {parameters}\n`define WITHHELD {withheld}",
                              header(core))
    texts["algorithm.vh"] = algorithm(Algorithm(constants))
    texts["sp_ram.v"] = memory()
    for name in ("told_units.sv", "samples.sv"):
        texts[name] = (HERE / name).read_text()
    files = " ".join(f"@/{file}" for file in texts if not file.endswith(".vh"))
    waits = [f"\\dut.{unit}.waits" for unit in design.units] + 3 * ["1'b0"]
    connections = WATCHED + [f"connect -set waits_{letter} {waits[n]}" for n, letter in enumerate("abc")]
    script = [f"read_verilog -sv -formal -DSYNTHESIS -I@/ {files}", f"hierarchy -check -top {TOP}", "proc", "flatten",
              *connections, f"prep -top {TOP}", "memory_map", "async2sync", "chformal -lower"]
    question = ["-c", "-t", str(clocks)] if mode == "cover" else ["-t", f"0:{clocks}:{clocks}"]
    return Trial(f"{core}: {bug[1] if bug else mode}", texts, script, question, "z3", UNITS)


def run(scratch):
    proofs = [trial(core, mode) for core in CASES for mode in ("proof", "cover")]
    planted = [trial(core, "proof", bug) for core, *bug in BUGS]
    properties = set(re.findall(r"(\w+): +assert ", (HERE / "samples.sv").read_text()))
    break_each(planted, prove("samples", scratch, proofs, planted), properties)
    print(f"two samples, word for word with any units: {'; '.join(CASES)}: {', '.join(sorted(properties))}")
    print(f"  each broken by one of {len(BUGS)} planted bugs")
