"""The cores that the properties are about, and every internal name of them that the proofs know."""

import re
from dataclasses import dataclass
from pathlib import Path

from solver import plant

HERE = Path(__file__).parent
RTL = HERE.parent.parent / "src/fpga/export/rtl"
# Bits of an exact value where words are as short as in FIXED.
EXACT_BITS = 24


@dataclass(frozen=True)
class Core:
    """A core with two taps, its parameters, and its internal names."""

    top: str
    files: tuple
    parameters: dict
    control: str  # file with the control machine
    inside: str  # instance of that machine, with a full stop behind; empty where the core is it
    units: tuple  # instances that may take their time
    under_way: str  # the states from the taking of a sample to the clock of its result
    latency: int  # clocks from the one that takes a sample to the one of its result
    period: int  # clocks of a sample
    told: str = "1'b1"  # what else an induction has to know
    out_waits: str = "1'b0"  # what holds the clock of the result back
    second: bool = True  # whether the machine has the register of this name
    absent: tuple = ()  # states that its parameters leave out
    image: str = "0"  # initial word of the second memory at the address b_at
    word_bits: int = 5


# The diagonal of R, behind two words of each of W and t.
RLS_IMAGE = "b_at == 4 || b_at == 7 ? 9 : 0"


def rls(latency, period, **parameters):
    return Core("rls_core", ("rls_core.v", "rls_ctrl.v", "den_check.v"),
                {"W": 32, "P": 2, "DELTA": 9} | parameters, "rls_ctrl.v", "ctrl.", ("add", "mul", "div"),
                "state >= 4'd2 && state <= 4'd11 || out_valid", latency, period, image=RLS_IMAGE, word_bits=32)


def lms(files, units, last, latency, period, absent=(), image="0", **parameters):
    """A core under the control of lms_ctrl.v or sign_lms_ctrl.v, whose result comes in the state `last`."""
    return Core(files[0].removesuffix(".v"), files, parameters, files[1], "ctrl.", units,
                f"state >= 4'd2 && state <= 4'd{last}", latency, period, out_waits="waits", second=False,
                absent=absent, image=image, word_bits=parameters.get("W", 5))


# Words of five bits, two of them behind the point.
FIXED = {f"W{signal}": 5 for signal in "XDTNKWY"} | {f"N{signal}": 2 for signal in "XDTNKWY"}
LMS, LMS_FIXED = ("lms_core.v", "lms_ctrl.v", "den_check.v"), ("lms_fixed_core.v", "lms_ctrl.v", "fx.v")
SIGN_LMS = ("sign_lms_core.v", "sign_lms_ctrl.v", "den_check.v")
SIGN_LMS_FIXED = ("sign_lms_fixed_core.v", "sign_lms_ctrl.v", "fx.v")
CORES = {
    "rls": rls(31, 36),
    "rls, forgetting": rls(31, 36, IALPHA=3),
    "rls, slow units": rls(35, 40, IALPHA=3, ADD_LATENCY=2),
    "rls, a division for each element": rls(31, 36, DIV_ELEM=1),
    "lms": lms(LMS, (), 6, 4, 10, ("LL_R", "LL_W"), W=32, N=2),
    "nlms": lms(LMS, ("with_divider.div",), 6, 7, 13, W=32, N=2, NLMS=1),
    "sign_lms": lms(SIGN_LMS, ("div",), 7, 7, 13, image="3", W=32, M=2, RECOMPUTE=4, W0=3),
    "rls, fixed point": Core(
        "rls_fixed_core", ("rls_fixed_core.v", "fx.v"),
        FIXED | {"P": 2, "MW": 5, "WR": 5, "NR": 2, "ALPHA": 16, "DELTA": 9}, "rls_fixed_core.v", "", ("add", "mul", "div"),
        "state >= 4'd2 && state <= 4'd11 || out_valid", 25, 30,
        image=RLS_IMAGE,
        told="!second || state == 4'd7 || state >= 4'd12"),
    "nlms, fixed point": lms(LMS_FIXED, ("with_divider.div",), 6, 7, 13, N=2, NLMS=1, **FIXED),
    "sign_lms, fixed point": lms(SIGN_LMS_FIXED, ("div",), 7, 7, 13, image="3", M=2, W0=3, **FIXED),
}


def states(core):
    """Names and numbers of the states of a core's control, as its text declares them."""
    text = (RTL / CORES[core].control).read_text()
    found = re.search(r"localparam \[3:0\] (IDLE .*?);", text, re.DOTALL)[1]
    return {name: int(number) for name, number in re.findall(r"(\w+) *= 4'd(\d+)", found)
            if name not in CORES[core].absent}


def header(core):
    """Text of core.vh, by which the properties know the core."""
    design = CORES[core]
    words, taps = design.word_bits, design.parameters.get("P")
    defines = {
        "CORE": design.top,
        "PARAMETERS": ", ".join(f".{name}({value})" for name, value in design.parameters.items()),
        "X_BITS": words, "D_BITS": words, "Y_BITS": words, "A_BITS": words, "B_BITS": words,
        "A_ADDRESS_BITS": 2 if taps else 1, "B_ADDRESS_BITS": 3 if taps else 1,
        "LEGAL": " || ".join(f"state == 4'd{number}" for number in states(core).values()),
        "UNDER_WAY": design.under_way, "TOLD": design.told, "OUT_WAITS": design.out_waits,
        "LATENCY": design.latency, "PERIOD": design.period, "IMAGE": design.image,
    }
    return "".join(f"`define {name} {text}\n" for name, text in defines.items())


def sources(core, *properties, bug=None):
    """Texts of the core, maybe with a bug, of core.vh, of free units and of the properties."""
    texts = {file: source(file) for file in CORES[core].files}
    if bug:
        file, right, wrong = bug
        texts[file] = plant(file, texts[file], right, wrong)
    if "fx.v" in texts:
        texts["fx.v"] = without(texts["fx.v"], "fx_div")
    texts["core.vh"] = header(core)
    for name in ["free_units.sv", *properties]:
        texts[name] = (HERE / name).read_text()
    return texts


def source(name):
    """Text of a file of the export, with exact values no wider than short words need."""
    text = (RTL / name).read_text()
    return re.sub(r"\bAW( *)= 128\b", rf"AW\1= {EXACT_BITS}", text)


def without(text, module):
    """The text without one of its modules."""
    kept, count = re.subn(rf"^module {module}\b.*?^endmodule$", "", text, flags=re.DOTALL | re.MULTILINE)
    assert count == 1, f"{module} is not in the text once"
    return kept
