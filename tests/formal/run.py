"""Proves properties of the exported Verilog, and shows that each fails on a planted bug.

    python3 tests/formal/run.py [PART…]

YOSYS and SMTBMC name the programs; the solvers are yices and z3. A missing one is a failure.
"""

import importlib
import sys
import tempfile
import time
from pathlib import Path

sys.dont_write_bytecode = True

PARTS = ["stream", "memory_ports", "control", "reset", "samples"]


def main():
    for part in sys.argv[1:] or PARTS:
        start = time.monotonic()
        with tempfile.TemporaryDirectory() as scratch:
            importlib.import_module(part).run(Path(scratch) / part)
        print(f"  {time.monotonic() - start:.0f} s")


if __name__ == "__main__":
    main()
