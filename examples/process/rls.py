"""Recursive least squares that predicts each word from those before it: the words of fogbench's `rls` with
`pipeline = "textbook"`, to the bit. Plain loops in the order of the bench.

    [filter.process]
    command = ["python3", "./rls.py"]
    parameters = { taps = 4, forgetting_factor = 1.0 }
"""

from fogbench_filter import serve


def dot(left, right):
    total = -0.0  # So that a sum of negative zeros is one, as in the bench.
    for one, other in zip(left, right):
        total += one * other
    return total


class Rls:
    def __init__(self, bench):
        taps = bench.parameters.get("taps", 4)
        self.forgetting = bench.parameters.get("forgetting_factor", 1.0)
        start = bench.parameters.get("initial_inverse_correlation", 7.716e-4)
        self.past = [0.0] * taps  # Newest word first.
        self.weights = [0.0] * taps
        self.inverse = [[start if i == j else 0.0 for j in range(taps)] for i in range(taps)]

    def step(self, word):
        past, inverse = self.past, self.inverse
        prediction = dot(self.weights, past)
        spread = [dot(row, past) for row in inverse]
        denominator = self.forgetting + dot(past, spread)
        step = (word - prediction) / denominator
        self.weights = [weight + step * value for weight, value in zip(self.weights, spread)]
        for i in range(len(past)):
            gain = spread[i] / denominator
            for j in range(i, len(past)):
                inverse[i][j] = (inverse[i][j] - gain * spread[j]) * (1.0 / self.forgetting)
                inverse[j][i] = inverse[i][j]
        self.past = [word] + past[:-1]
        return prediction

    def __call__(self, words):
        return [self.step(float(word)) for word in words]


serve(Rls, version="1")
