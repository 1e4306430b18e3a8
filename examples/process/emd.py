"""Empirical mode decomposition without its fastest modes. Needs numpy and EMD-signal.

    [filter.process]
    command = ["python3", "./emd.py"]
    mode = "record"
    parameters = { drop = 1 }
"""

from PyEMD import EMD

from fogbench_filter import serve


def slow_modes(words, bench):
    drop = bench.parameters.get("drop", 1)
    modes = EMD().emd(words)
    fast = modes[: min(drop, len(modes) - 1)]
    return words - fast.sum(axis=0)


serve(slow_modes, version="1", stateless=True)
