"""cocotb test of the filter cores against a folder of golden vectors, and its runner.

    python3 test_cocotb.py [VECTOR_FOLDER]      # or: VEC_DIR=... pytest test_rls_cocotb.py

Needs cocotb 2 (`pip install cocotb`) and Icarus Verilog. The folder (default: the one of this
file) holds params.vh, in.hex, y.hex and ram_final.hex as README.txt describes them. Driver,
monitor and checker are separate, so that a block of your own can take the core's place.
"""

import os
import re
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent


def vector_folder():
    return Path(os.environ.get("VEC_DIR", HERE)).resolve()


def parameters(folder):
    """The `define lines of params.vh as a dictionary, without the prefix VEC_."""
    text = (folder / "params.vh").read_text()
    return dict(re.findall(r"^`define VEC_(\w+)[ \t]*(.*?)[ \t]*$", text, re.MULTILINE))


def words(folder, name):
    """The words of a vector file as integers; comments left out."""
    lines = (line.split("//")[0].strip() for line in (folder / name).read_text().splitlines())
    return [int(line, 16) for line in lines if line]


def runner():
    """Builds the core with the vectors' parameters and runs the tests below on it."""
    try:
        from cocotb_tools.runner import get_results, get_runner
    except ImportError:
        raise SystemExit("cocotb 2 is not installed: pip install cocotb") from None

    folder = vector_folder()
    given = parameters(folder)
    benches = (path.stem.removeprefix("tb_") for path in sorted(HERE.glob("tb_*.v")))
    kind = next((name for name in benches if name.upper() in given), None)
    if kind is None:
        raise SystemExit(f"{folder}/params.vh names no filter whose testbench is here")
    top = f"{kind}_core"
    core = (HERE / f"{top}.v").read_text()
    declared = re.findall(r"^\s*parameter\s+(?:\[.*?\]\s*)?(\w+)", core, re.MULTILINE)
    # The first parameter of a core is its tap count, under the filter's usual letter.
    names = {key: key for key in declared} | {"TAPS": declared[0], "WIDTH": "W"}
    units = "fp_units.v" if (HERE / "fp_units.v").exists() else "fp_sim.v"
    names_of_sources = (f"{top}.v", f"{kind}_ctrl.v", "den_check.v", "sp_ram.v", "fp_wait.v", units)
    sources = [HERE / name for name in names_of_sources]
    simulator = get_runner(os.environ.get("SIM", "icarus"))
    with tempfile.TemporaryDirectory() as build:
        simulator.build(
            sources=sources,
            hdl_toplevel=top,
            parameters={names[key]: value for key, value in given.items() if key in names},
            build_args=["-g2012"],
            timescale=("1ns", "1ps"),
            build_dir=build,
            always=True,
        )
        results = simulator.test(
            hdl_toplevel=top,
            test_module=Path(__file__).stem,
            build_dir=build,
            test_dir=build,
            extra_env={
                "VEC_DIR": str(folder),
                "PYTHONDONTWRITEBYTECODE": "1",
                "PYTHONPATH": os.pathsep.join([str(HERE), *sys.path]),
            },
        )
        count, failed = get_results(results)
    if failed or not count:
        raise SystemExit(f"{failed} of {count} tests failed")


def test_core_against_vectors():
    """Entry for pytest."""
    runner()


if os.environ.get("COCOTB_TEST_MODULES"):
    import random

    import cocotb
    from cocotb.clock import Clock
    from cocotb.triggers import ReadOnly, RisingEdge

    class Driver:
        """Offers (x, d) pairs; holds each until it is taken; pauses between two as told."""

        def __init__(self, dut, pairs, pause):
            self.dut, self.pairs, self.pause = dut, pairs, pause

        async def run(self):
            dut = self.dut
            for x, d in self.pairs:
                for _ in range(self.pause()):
                    dut.in_valid.value = 0
                    await RisingEdge(dut.clk)
                dut.in_valid.value, dut.x.value, dut.d.value = 1, x, d
                while True:
                    await ReadOnly()
                    ready = int(dut.in_ready.value)
                    await RisingEdge(dut.clk)
                    if ready:
                        break
            dut.in_valid.value = 0

    class Monitor:
        """Notes in which cycle samples are taken and results given, and the result words."""

        def __init__(self, dut):
            self.dut, self.taken, self.given, self.words = dut, [], [], []

        async def run(self):
            cycle = 0
            while True:
                await ReadOnly()
                if int(self.dut.in_valid.value) and int(self.dut.in_ready.value):
                    self.taken.append(cycle)
                if int(self.dut.out_valid.value):
                    self.given.append(cycle)
                    self.words.append(int(self.dut.y.value))
                await RisingEdge(self.dut.clk)
                cycle += 1

    class Checker:
        """Compares in order, keeps all mismatches, reports the first ones in hexadecimal."""

        def __init__(self):
            self.mismatches = []

        def compare(self, what, expected, got):
            for k, (want, have) in enumerate(zip(expected, got)):
                if want != have:
                    self.mismatches.append(f"{what}[{k}]: expected {want:016x} got {have:016x}")
            if len(expected) != len(got):
                self.mismatches.append(f"{what}: expected {len(expected)} got {len(got)} of them")

        def finish(self):
            text = "\n".join(self.mismatches[:10])
            assert not self.mismatches, f"{len(self.mismatches)} mismatches, first:\n{text}"

    async def run_all(dut, pause):
        folder = vector_folder()
        given = parameters(folder)
        flat = words(folder, "in.hex")
        expected = words(folder, "y.hex")
        pairs = list(zip(flat[0::2], flat[1::2]))
        cocotb.start_soon(Clock(dut.clk, 25, unit="ns").start())
        dut.rst.value, dut.in_valid.value, dut.x.value, dut.d.value = 1, 0, 0, 0
        for _ in range(3):
            await RisingEdge(dut.clk)
        dut.rst.value = 0
        monitor = Monitor(dut)
        cocotb.start_soon(monitor.run())
        await Driver(dut, pairs, pause).run()
        period = int(given.get("UNITS_PERIOD", given["PERIOD"]))
        for _ in range(period + 2):
            await RisingEdge(dut.clk)
        return given, expected, monitor

    @cocotb.test()
    async def back_to_back(dut):
        """Words, latency, period and final memories with the strobe always up."""
        given, expected, monitor = await run_all(dut, lambda: 0)
        checker = Checker()
        checker.compare("y", expected, monitor.words)
        latencies = [out - start for start, out in zip(monitor.taken, monitor.given)]
        checker.compare("latency", [int(given.get("UNITS_LATENCY", given["LATENCY"]))] * len(expected), latencies)
        periods = [b - a for a, b in zip(monitor.taken, monitor.taken[1:])]
        checker.compare("period", [int(given.get("UNITS_PERIOD", given["PERIOD"]))] * (len(expected) - 1), periods)
        rama = [int(dut.rama.mem[k].value) for k in range(len(dut.rama.mem))]
        ramb = [int(dut.ramb.mem[k].value) for k in range(len(dut.ramb.mem))]
        checker.compare("memory", words(vector_folder(), "ram_final.hex"), rama + ramb)
        checker.finish()

    @cocotb.test()
    async def with_pauses(dut):
        """After a reset the same words and latency, with random pauses between the samples."""
        rng = random.Random(1)
        given = parameters(vector_folder())
        longest = 3 * int(given.get("UNITS_PERIOD", given["PERIOD"]))
        given, expected, monitor = await run_all(dut, lambda: rng.randrange(longest))
        checker = Checker()
        checker.compare("y", expected, monitor.words)
        latencies = [out - start for start, out in zip(monitor.taken, monitor.given)]
        checker.compare("latency", [int(given.get("UNITS_LATENCY", given["LATENCY"]))] * len(expected), latencies)
        checker.finish()


if __name__ == "__main__":
    if len(sys.argv) > 1:
        os.environ["VEC_DIR"] = str(Path(sys.argv[1]).resolve())
    runner()
