"""Mean of the newest words: the words of fogbench's `moving_average`, to the bit.

    [filter.process]
    command = ["python3", "./mean.py"]
    parameters = { taps = 8 }
"""

from fogbench_filter import serve


class Mean:
    def __init__(self, bench):
        taps = bench.parameters.get("taps", 8)
        self.weight = 1.0 / taps
        self.newest_first = [0.0] * taps

    def step(self, word):
        self.newest_first = [word] + self.newest_first[:-1]
        # A loop, newest word first: the order of the bench, in which sums round alike.
        total = -0.0  # So that a sum of negative zeros is one, as in the bench.
        for word in self.newest_first:
            total += self.weight * word
        return total

    def __call__(self, words):
        return [self.step(float(word)) for word in words]


serve(Mean, version="1")
