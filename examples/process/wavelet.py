"""Wavelet shrinkage over the record, by the universal threshold. Needs numpy and PyWavelets.

    [filter.process]
    command = ["python3", "./wavelet.py"]
    mode = "record"
    parameters = { wavelet = "db4", levels = 5 }
"""

import numpy
import pywt

from fogbench_filter import serve


def shrink(words, bench):
    wavelet = bench.parameters.get("wavelet", "db4")
    levels = bench.parameters.get("levels", 5)
    levels = min(levels, pywt.dwt_max_level(len(words), wavelet))
    smooth, *details = pywt.wavedec(words, wavelet, level=levels)
    sigma = numpy.median(numpy.abs(details[-1])) / 0.6745
    threshold = sigma * numpy.sqrt(2.0 * numpy.log(max(len(words), 2)))
    details = [pywt.threshold(detail, threshold, "soft") for detail in details]
    return pywt.waverec([smooth, *details], wavelet)[: len(words)]


serve(shrink, version="1", stateless=True)
