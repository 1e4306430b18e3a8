// The units for synthesis against the processor, on random words: WIDTH and FLUSH are given by the
// compiler, the number of pairs by the command line. Ends non-zero at the first difference.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "Vunit_all.h"

#if WIDTH == 64
using Real = double;
using Word = uint64_t;
constexpr int FRACTION = 52;
constexpr Word NOT_A_NUMBER = 0x7ff8000000000000;
#else
using Real = float;
using Word = uint32_t;
constexpr int FRACTION = 23;
constexpr Word NOT_A_NUMBER = 0x7fc00000;
#endif
constexpr Word HIGH = (Word(1) << (WIDTH - 1 - FRACTION)) - 1;

static uint64_t state = 88172645463325252;

static uint64_t draw() {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state * 2685821657736338717u;
}

static uint64_t below(uint64_t bound) { return (draw() >> 8) % bound; }

static Word with(Word word, uint64_t exponent) {
    return (word & ~(HIGH << FRACTION)) | ((Word(exponent) & HIGH) << FRACTION);
}

static Real value(Word word) {
    Real number;
    std::memcpy(&number, &word, sizeof number);
    return FLUSH && std::fpclassify(number) == FP_SUBNORMAL ? std::copysign(Real(0), number) : number;
}

static Word bits(Real number) {
    if (FLUSH && std::fpclassify(number) == FP_SUBNORMAL) number = std::copysign(Real(0), number);
    Word word;
    std::memcpy(&word, &number, sizeof word);
    return std::isnan(number) ? NOT_A_NUMBER : word;
}

static void compare(const char *name, Word a, Word b, Word want, Word got) {
    if (want == got) return;
    std::printf("MISMATCH %s of %llx, %llx: expected %llx got %llx\n", name, (unsigned long long)a,
                (unsigned long long)b, (unsigned long long)want, (unsigned long long)got);
    std::exit(1);
}

int main(int, char **arguments) {
    Vunit_all units;
    const long pairs = std::atol(arguments[1]);
    for (long k = 0; k < pairs; ++k) {
        Word a = Word(draw()), b = Word(draw());
        switch (k % 4) {
        case 1: b = with(b, (a >> FRACTION) + below(5) - 2); break;     // exponents nearby
        case 2:                                                         // the lower end
            a = with(a, below(60));
            b = with(b, below(2) ? below(60) : (HIGH >> 1) - 30 + below(60));
            break;
        case 3: b = a ^ Word(below(16)) ^ (Word(below(2)) << (WIDTH - 1)); break;  // nearly equal
        default: break;
        }
        units.a = a;
        units.b = b;
        units.eval();
        const volatile Real x = value(a), y = value(b);
        compare("the sum", a, b, bits(x + y), units.sum);
        compare("the difference", a, b, bits(x - y), units.difference);
        compare("the product", a, b, bits(x * y), units.product);
        compare("the quotient", a, b, bits(x / y), units.quotient);
    }
    std::printf("PASS %ld pairs of %d bits\n", pairs, WIDTH);
}
