"""The slowest of the modes of a variational mode decomposition. Needs numpy and vmdpy.

    [filter.process]
    command = ["python3", "./vmd.py"]
    mode = "record"
    parameters = { modes = 3 }
"""

import numpy
from vmdpy import VMD

from fogbench_filter import serve


def slowest_mode(words, bench):
    count = bench.parameters.get("modes", 3)
    # An odd record loses its last word.
    even = numpy.append(words, words[-1:]) if len(words) % 2 else words
    mean = even.mean()
    modes, _, centres = VMD(even - mean, 2000.0, 0.0, count, 0, 1, 1e-6)
    return mean + modes[numpy.argmin(centres[-1])][: len(words)]


serve(slowest_mode, version="1", stateless=True)
