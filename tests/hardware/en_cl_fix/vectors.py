#!/usr/bin/env python3
"""Words of en_cl_fix (Enclustra, MIT licence): what it stores for sums, products and resized words.

    PYTHONPATH=en_cl_fix/bittrue/models/python python3 tests/en_cl_fix/vectors.py > tests/en_cl_fix/vectors.csv

from a checkout of enclustra/en_cl_fix; needs numpy. The file here was made with version 2.3.0 (6a4f907). Integer bits are counted with the sign, as
fogbench counts them; en_cl_fix counts them without.
"""

import random

import en_cl_fix_pkg as fix

ROUNDINGS = {
    "truncate": fix.FixRound.Trunc_s,
    "half-up": fix.FixRound.NonSymPos_s,
    "nearest-even": fix.FixRound.ConvEven_s,
}
OVERFLOWS = {"saturate": fix.FixSaturate.Sat_s, "wrap": fix.FixSaturate.None_s}
VECTORS = 60


def main():
    draw = random.Random(16)
    print("operation,a,a_integer_bits,a_fraction_bits,b,b_integer_bits,b_fraction_bits,"
          "rounding,overflow,integer_bits,fraction_bits,code")
    for operation in ("resize", "add", "multiply"):
        for rounding in ROUNDINGS:
            for overflow in OVERFLOWS:
                for _ in range(VECTORS):
                    print(line(draw, operation, rounding, overflow))


def line(draw, operation, rounding, overflow):
    first, second = formats(draw), formats(draw)
    a, b = code(draw, first), code(draw, second)
    # Near the width of the operands, so that a good part overflows and most of it is rounded.
    shift = first[0] + (second[0] if operation == "multiply" else 0)
    width = draw.randint(2, 48)
    integer_bits = max(1, min(width, shift + draw.randint(-3, 1)))
    into = (integer_bits, width - integer_bits)
    stored = result(operation, a, first, b, second, into, ROUNDINGS[rounding], OVERFLOWS[overflow])
    fields = [operation, a, *first, b, *second, rounding, overflow, *into, stored]
    return ",".join(map(str, fields))


def formats(draw):
    width = draw.choice([2, 3, 5, 8, 12, 18, 25, 36, 48])
    integer_bits = draw.randint(1, min(width, 12))
    return integer_bits, width - integer_bits


def code(draw, form):
    width = sum(form)
    # A code with few bits set lies half way between the words of a shorter format more often than a random one.
    coarse = draw.choice([0, 0, 0, width // 2, width - 2])
    value = draw.randint(-(1 << (width - 1)), (1 << (width - 1)) - 1)
    return value >> coarse << coarse


def value(number, form):
    """A code as en_cl_fix takes it: an integer beyond 53 bits, else the number itself."""
    return number if fix.cl_fix_is_wide(form) else fix.cl_fix_from_integer(number, form)


def result(operation, a, first, b, second, into, rounding, overflow):
    a_form, b_form, form = (fix.FixFormat(1, integer - 1, fraction) for integer, fraction in (first, second, into))
    a, b = value(a, a_form), value(b, b_form)
    if operation == "resize":
        stored = fix.cl_fix_resize(a, a_form, form, rounding, overflow)
    elif operation == "add":
        stored = fix.cl_fix_add(a, a_form, b, b_form, form, rounding, overflow)
    else:
        stored = fix.cl_fix_mult(a, a_form, b, b_form, form, rounding, overflow)
    return int(fix.cl_fix_to_integer(stored, form))


main()
