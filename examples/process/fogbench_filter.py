"""A Python function or class as a filter of fogbench: protocol 1, in one file to copy.

    from fogbench_filter import serve

    class Mean:
        def __init__(self, bench):
            self.window = [0.0] * bench.parameters.get("window", 8)

        def __call__(self, words):
            ...
            return filtered             # as many words

    serve(Mean)

A class is made once, with what the bench says of the run, and called with each block; a function is called
with each block and what the bench says: `serve(lambda words, bench: 0.5 * words)`. Blocks are numpy arrays of
binary64 where numpy is installed, else lists of floats. `print` goes to stderr: stdout is for words.
"""

import json
import os
import struct
import sys
from types import SimpleNamespace

try:
    import numpy
except ImportError:
    numpy = None

PROTOCOL = 1


def serve(kind, name=None, version="0", stateless=False):
    """Speaks protocol 1 for a class or a function, until there are no more words.

    `stateless` promises that the answer to a block depends on that block alone, so that one start of the
    program may be given several records.
    """
    with _streams() as (words_in, words_out):
        bench = _greeting(words_in)
        call = kind(bench) if isinstance(kind, type) else lambda words: kind(words, bench)
        introduction = {
            "fogbench_filter": PROTOCOL,
            "name": name or getattr(kind, "__name__", "filter"),
            "version": version,
        }
        if stateless:
            introduction["stateless"] = True
        words_out.write(json.dumps(introduction).encode() + b"\n")
        words_out.flush()
        while True:
            (count,) = struct.unpack("<I", _exactly(words_in, 4))
            if count == 0:
                return
            answer = _bytes(call(_block(_exactly(words_in, 8 * count), count)))
            if len(answer) != 8 * count:
                raise ValueError(f"{len(answer) // 8} words answer {count}: expected as many")
            words_out.write(struct.pack("<I", count) + answer)
            words_out.flush()


class _streams:
    """The binary ends of stdin and stdout; what is printed meanwhile goes to stderr, from C as well."""

    def __enter__(self):
        sys.stdout.flush()
        self.out = os.fdopen(os.dup(1), "wb")
        os.dup2(2, 1)
        return sys.stdin.buffer, self.out

    def __exit__(self, *_):
        self.out.close()


def _greeting(words_in):
    greeting = json.loads(words_in.readline())
    if greeting.get("fogbench_filter") != PROTOCOL:
        raise ValueError(f"this is a filter of protocol {PROTOCOL}: {greeting}")
    return SimpleNamespace(**greeting)


def _exactly(stream, count):
    data = stream.read(count)
    if len(data) != count:
        raise EOFError(f"{len(data)} of {count} bytes came from the bench")
    return data


def _block(data, count):
    if numpy is None:
        return list(struct.unpack(f"<{count}d", data))
    return numpy.frombuffer(data, dtype="<f8").copy()


def _bytes(words):
    if numpy is None:
        return struct.pack(f"<{len(words)}d", *words)
    return numpy.ascontiguousarray(words, dtype="<f8").tobytes()
