"""Recursive least squares behind empirical mode decomposition: the fastest modes are left out, and of what is left each
word is predicted from those before it. Needs numpy and EMD-signal.

    [filter.process]
    command = ["python3", "./emd_rls.py"]
    mode = "record"
    parameters = { drop = 1, taps = 4, forgetting_factor = 0.999 }
"""

import numpy
from PyEMD import EMD

from fogbench_filter import serve


def predicted(words, bench):
    drop = bench.parameters.get("drop", 1)
    modes = EMD().emd(words)
    slow = words - modes[: min(drop, len(modes) - 1)].sum(axis=0)
    return least_squares(slow, bench.parameters)


def least_squares(words, parameters):
    taps = parameters.get("taps", 4)
    forgetting = parameters.get("forgetting_factor", 0.999)
    past = numpy.zeros(taps)  # Newest word first.
    weights = numpy.zeros(taps)
    inverse = numpy.eye(taps)
    answers = numpy.empty(len(words))
    for index, word in enumerate(words):
        answers[index] = weights @ past
        spread = inverse @ past
        gain = spread / (forgetting + past @ spread)
        weights = weights + gain * (word - answers[index])
        inverse = (inverse - numpy.outer(gain, spread)) / forgetting
        inverse = 0.5 * (inverse + inverse.T)
        past = numpy.concatenate(([word], past[:-1]))
    return answers


serve(predicted, version="1", stateless=True)
