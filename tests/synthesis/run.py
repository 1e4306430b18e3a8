"""Synthesises rows of the table of docs/hardware.md and holds them against it.

    python3 tests/synthesis/run.py FOGBENCH            the rows marked `ci`, one seed, within 15 %
    python3 tests/synthesis/run.py FOGBENCH --measure  all rows, five seeds: writes table.csv anew

YOSYS and NEXTPNR name the programs, as in the exported synth.sh, NEXTPNR that for ecp5 and NEXTPNR_ICE40 that
for ice40. ROW=n chooses one row, SEEDS=n the number of seeds.
"""

import csv
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

TABLE = Path(__file__).with_name("table.csv")
# What is compared, and by how much it may differ.
COUNTED = ("luts", "flip_flops", "dsps", "lut_rams", "block_rams")
ALLOWED = 0.15


def export(program, row, folder):
    """Exports the filter of a row with the script that synthesises it."""
    stimulus = folder / "stimulus.txt"
    stimulus.write_text("".join(f"{k % 7 - 3}\n" for k in range(20)))
    subprocess.run(
        [program, "export", "rtl", folder / "rtl", "--stimulus", stimulus, "--kind", "rls",
         "--taps", row["taps"], "--forgetting-factor", "0.97", "--number-format", row["format"],
         "--adder-latency", row["adder"], "--multiplier-latency", row["multiplier"],
         "--divider-latency", row["divider"], "--synth", row["device"], "--trace-samples", "0"],
        check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return folder / "rtl"


def synthesise(rtl, seed, device):
    """Runs the script of the export; returns resources.json."""
    environment = dict(os.environ, SEED=str(seed))
    if device == "ice40":
        environment["NEXTPNR"] = os.environ.get("NEXTPNR_ICE40", "nextpnr-ice40")
    subprocess.run(["sh", rtl / "synth.sh"], check=True, env=environment, stdout=subprocess.DEVNULL)
    return json.loads((rtl / "resources.json").read_text())


def check(row, found):
    """Complaints about a row that is not as the table says."""
    wanted = {name: float(row[name]) for name in COUNTED}
    if row["fmax_mhz"]:
        wanted["fmax_mhz"] = float(row["fmax_mhz"])
    for name, want in wanted.items():
        if found[name] is None or abs(found[name] - want) > ALLOWED * want:
            yield f"{name} {found[name]}, in the table {want}"


def main():
    program = Path(sys.argv[1]).resolve()
    measures = "--measure" in sys.argv
    with TABLE.open() as file:
        rows = list(csv.DictReader(file))
    chosen = os.environ.get("ROW")
    failed = False
    for number, row in enumerate(rows):
        if chosen is not None and int(chosen) != number or not measures and row["ci"] != "1":
            continue
        with tempfile.TemporaryDirectory() as folder:
            rtl = export(program, row, Path(folder))
            seeds = range(1, int(os.environ.get("SEEDS", 5 if measures else 1)) + 1)
            results = []
            for seed in seeds:
                results.append(synthesise(rtl, seed, row["device"]))
                # Without a router, or without a place, all seeds are alike.
                if results[-1]["fmax_mhz"] is None:
                    break
        name = f"{row['taps']} taps, {row['format']}, {row['device']}"
        rates = [result["fmax_mhz"] for result in results if result["fmax_mhz"] is not None]
        print(f"{name}: {results[0]} {rates}", flush=True)
        if measures:
            row.update({key: results[0][key] for key in COUNTED})
            row["fits"] = int(all(result["fits"] for result in results))
            row["seeds"] = len(rates)
            row["fmax_mhz"] = f"{statistics.median(rates):.1f}" if rates else ""
            with TABLE.open("w", newline="") as file:
                writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)
        else:
            for complaint in check(row, results[0]):
                print(f"{name}: {complaint}", file=sys.stderr)
                failed = True
    sys.exit(failed)


if __name__ == "__main__":
    main()
