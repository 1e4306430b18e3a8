/* Mean of the newest words: the words of fogbench's `moving_average`, to the bit.
 *
 *     cc -O2 -ffp-contract=off -o mean mean.c
 *
 *     [filter.process]
 *     command = ["./mean"]
 *     parameters = { taps = 8 }
 */
#include "fogbench_filter.h"

#define TAPS_MAX 4096

struct mean {
    int taps;
    double newest_first[TAPS_MAX];
};

static int start(void *state, const char *greeting)
{
    struct mean *mean = state;
    mean->taps = (int)fogbench_number(greeting, "taps", 8);
    return mean->taps >= 1 && mean->taps <= TAPS_MAX ? 0 : 1;
}

static double step(void *state, double word)
{
    struct mean *mean = state;
    double weight = 1.0 / mean->taps;
    double total = -0.0; /* So that a sum of negative zeros is one, as in the bench. */
    int age;
    memmove(mean->newest_first + 1, mean->newest_first, (mean->taps - 1) * sizeof word);
    mean->newest_first[0] = word;
    for (age = 0; age < mean->taps; age++)
        total += weight * mean->newest_first[age];
    return total;
}

int main(void)
{
    static struct mean mean;
    return fogbench_serve("mean", "1", start, step, &mean);
}
