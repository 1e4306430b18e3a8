"""Wavelet shrinkage that looks at no word ahead: Haar details of each level against a threshold that follows their
noise, the median of the magnitudes of the newest 64.

    [filter.process]
    command = ["python3", "./haar_causal.py"]
    parameters = { levels = 5 }
"""

from statistics import median

from fogbench_filter import serve

MEMORY = 64
# Standard deviation of a normal distribution over the median of its magnitudes.
SIGMA_PER_MEDIAN = 1.4826


class Shrinkage:
    def __init__(self, bench):
        levels = bench.parameters.get("levels", 5)
        self.levels = [Level(2**level) for level in range(levels)]

    def step(self, word):
        smooth, kept = word, 0.0
        for level in self.levels:
            smooth, detail = level.step(smooth)
            kept += detail
        return smooth + kept

    def __call__(self, words):
        return [self.step(float(word)) for word in words]


class Level:
    """Half the sum and half the difference of a word and the one so many before it."""

    def __init__(self, apart):
        self.past = [None] * apart
        self.magnitudes = []

    def step(self, word):
        before = self.past.pop(0)
        self.past.append(word)
        before = word if before is None else before
        smooth, detail = 0.5 * (word + before), 0.5 * (word - before)
        self.magnitudes = (self.magnitudes + [abs(detail)])[-MEMORY:]
        threshold = 3.0 * SIGMA_PER_MEDIAN * median(self.magnitudes)
        return smooth, detail if abs(detail) > threshold else 0.0


serve(Shrinkage, version="1")
