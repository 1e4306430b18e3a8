"""Kalman filter for a rate that walks, which adapts both of its noises: that of a word follows the Allan variance of
the newest words at one word's averaging time, taken recursively, that of the walk follows the innovations.

    [filter.process]
    command = ["python3", "./kalman_adaptive.py"]
    parameters = { memory = 400, walk_share = 0.02 }
"""

from fogbench_filter import serve

# A filter that reckons with less would never move again.
WALK_SHARE_MIN = 1e-4


class AdaptiveKalman:
    def __init__(self, bench):
        self.memory = bench.parameters.get("memory", 400)
        # The variance of the walk's step over that of a word, at most: beyond it the filter would follow the noise.
        self.share = bench.parameters.get("walk_share", 0.02)
        self.before = None
        self.rate = self.covariance = 0.0
        self.noise = self.innovations = 0.0
        self.words = 0

    def step(self, word):
        if self.before is None:
            self.before = self.rate = word
            return word
        # The mean of all words until the memory is full.
        self.words = min(self.words + 1, self.memory)
        # Half the mean square of neighbouring differences is the Allan variance at one word.
        self.noise += (0.5 * (word - self.before) ** 2 - self.noise) / self.words
        self.before = word
        innovation = word - self.rate
        self.innovations += (innovation**2 - self.innovations) / self.words
        # What the innovations scatter beyond noise and covariance is the walk's.
        walk = self.innovations - self.noise - self.covariance
        walk = min(max(walk, WALK_SHARE_MIN * self.noise), self.share * self.noise)
        predicted = self.covariance + walk
        total = predicted + self.noise
        gain = predicted / total if total > 0.0 else 1.0
        self.rate += gain * innovation
        self.covariance = (1.0 - gain) * predicted
        return self.rate

    def __call__(self, words):
        return [self.step(float(word)) for word in words]


serve(AdaptiveKalman, version="1")
