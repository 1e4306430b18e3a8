"""cocotb test of the exported pipeline: the words of y.hex and the declared clocks.

Run `python3 test_pipeline.py` (cocotb 2, Icarus Verilog 11 or newer).
"""

import json
import os
from pathlib import Path

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, ReadOnly

FOLDER = Path(__file__).resolve().parent
PARAMS = json.loads((FOLDER / "params.json").read_text())


def words(name):
    return [int(line, 16) for line in (FOLDER / name).read_text().split()]


@cocotb.test()
async def words_and_clocks_are_the_declared_ones(dut):
    stimulus, expected = words("in.hex"), words("y.hex")
    count = min(len(expected), int(os.environ.get("SAMPLES", "200")))
    dut.rst.value = 1
    dut.in_valid.value = 0
    dut.x.value = 0
    dut.d.value = 0
    cocotb.start_soon(Clock(dut.clk, 10, unit="ns").start(start_high=False))
    for _ in range(2):
        await FallingEdge(dut.clk)
    dut.rst.value = 0
    accepted, finished, clock = [], [], 0
    while len(finished) < count:
        taken = len(accepted)
        dut.in_valid.value = int(taken < count)
        if taken < count:
            dut.x.value = stimulus[2 * taken]
            dut.d.value = stimulus[2 * taken + 1]
        await ReadOnly()
        if int(dut.out_valid.value):
            got = int(dut.y.value)
            assert got == expected[len(finished)], (
                f"sample {len(finished)}: expected {expected[len(finished)]:x}, got {got:x}"
            )
            finished.append(clock)
        if int(dut.in_ready.value):
            accepted.append(clock)
        await FallingEdge(dut.clk)
        clock += 1
    periods = {b - a for a, b in zip(accepted, accepted[1:])}
    latencies = {b - a for a, b in zip(accepted, finished)}
    assert periods <= {PARAMS["clocks_per_sample"]}, periods
    assert latencies == {PARAMS["latency_clocks"]}, latencies


def parameters():
    def bits(name):
        return f"{PARAMS['word_bits']}'h{PARAMS[name + '_bits']}"

    names = {"w": "word_bits"}
    if PARAMS["filter"] == "rls":
        numbers = ["p", "w", "ftz", "elem", "as_printed"]
        constants = ["one", "alpha", "ialpha", "delta"]
    else:
        numbers = ["n", "w", "ftz", "normalised", "mean", "as_printed"]
        constants = ["one", "half", "mu", "eps"]
    chosen = {name.upper(): PARAMS[names.get(name, name)] for name in numbers}
    chosen.update({name.upper(): bits(name) for name in constants})
    return chosen


if __name__ == "__main__":
    from cocotb_tools.runner import get_runner

    kind = PARAMS["filter"]
    runner = get_runner(os.environ.get("SIM", "icarus"))
    runner.build(
        sources=[
            FOLDER / name
            for name in (f"{kind}_core.v", f"{kind}_ctrl.v", "ram_sp.v", "fp_sim.v")
        ],
        hdl_toplevel=f"{kind}_core",
        parameters=parameters(),
        build_args=["-g2012"],
        build_dir=FOLDER / "build" / "cocotb",
        always=True,
    )
    runner.test(
        hdl_toplevel=f"{kind}_core",
        test_module="test_pipeline",
        test_dir=FOLDER,
        build_dir=FOLDER / "build" / "cocotb",
    )
