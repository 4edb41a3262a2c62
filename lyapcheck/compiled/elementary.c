/* Elementary functions as straight lines, so that a compiler can put many arguments into one vector.
   Each is within a few units in the last place on the range named; no option like -ffast-math is needed. */

#include <math.h>
#include <stdint.h>
#include <string.h>

#define INLINE static inline __attribute__((always_inline))
#define WHOLE 0x1.8p52 /* adding it rounds to a whole number, found in the low bits */

/* The largest |q| for which sine and cosine are as accurate as promised: the multiples of the parts of pi/2
   below are exact up to 2^20 of them. */
#define LARGEST_ANGLE 1e5
/* Beyond it squares of states would come near the ends of the doubles. */
#define LARGEST_STATE 1e15

INLINE int64_t bits_of(double x) { int64_t bits; memcpy(&bits, &x, 8); return bits; }
INLINE double double_of(int64_t bits) { double x; memcpy(&x, &bits, 8); return x; }

/* t = e^-a and u = 1 - e^-a, the latter without cancellation, for a >= 0; beyond 700 as at 700. */
INLINE void exp_negative(double a, double *t, double *u)
{
    const double bounded = a < 700.0 ? a : 700.0;
    const double shifted = bounded * 0x1.71547652b82fep+0 + WHOLE;
    const double k = shifted - WHOLE;
    const double g = (k * 0x1.62e42fefa3800p-1 - bounded) + k * 0x1.ef35793c76730p-45;
    double p = 1.0 / 6227020800.0;
    p = p * g + 1.0 / 479001600.0;
    p = p * g + 1.0 / 39916800.0;
    p = p * g + 1.0 / 3628800.0;
    p = p * g + 1.0 / 362880.0;
    p = p * g + 1.0 / 40320.0;
    p = p * g + 1.0 / 5040.0;
    p = p * g + 1.0 / 720.0;
    p = p * g + 1.0 / 120.0;
    p = p * g + 1.0 / 24.0;
    p = p * g + 1.0 / 6.0;
    p = p * g + 0.5;
    const double excess = g + g * g * p;
    const int64_t whole = bits_of(shifted) - bits_of(WHOLE);
    const double power = double_of((int64_t)((uint64_t)(1023 - whole) << 52));
    *t = power + power * excess;
    *u = (1.0 - power) - power * excess;
}

/* ln(1 + p) = 2 artanh(p/(2 + p)) for -0.2 <= p <= 1. */
INLINE double log_one_plus(double p)
{
    const double z = p / (2.0 + p), s = z * z;
    double sum = 1.0 / 35.0;
    sum = sum * s + 1.0 / 33.0;
    sum = sum * s + 1.0 / 31.0;
    sum = sum * s + 1.0 / 29.0;
    sum = sum * s + 1.0 / 27.0;
    sum = sum * s + 1.0 / 25.0;
    sum = sum * s + 1.0 / 23.0;
    sum = sum * s + 1.0 / 21.0;
    sum = sum * s + 1.0 / 19.0;
    sum = sum * s + 1.0 / 17.0;
    sum = sum * s + 1.0 / 15.0;
    sum = sum * s + 1.0 / 13.0;
    sum = sum * s + 1.0 / 11.0;
    sum = sum * s + 1.0 / 9.0;
    sum = sum * s + 1.0 / 7.0;
    sum = sum * s + 1.0 / 5.0;
    sum = sum * s + 1.0 / 3.0;
    return 2.0 * z + 2.0 * z * (s * sum);
}

/* Sine and cosine for |x| <= LARGEST_ANGLE: the nearest multiple of pi/2 is taken away in three parts. */
INLINE void sine_cosine(double x, double *sine, double *cosine)
{
    const double shifted = x * 0x1.45f306dc9c883p-1 + WHOLE;
    const double k = shifted - WHOLE;
    const double r = ((x - k * 0x1.921fb54400000p+0) - k * 0x1.0b4611a600000p-34) - k * 0x1.3198a2e037073p-69;
    const double z = r * r;
    double s = 1.0 / 355687428096000.0, c = 1.0 / 20922789888000.0;
    s = s * z - 1.0 / 1307674368000.0;
    s = s * z + 1.0 / 6227020800.0;
    s = s * z - 1.0 / 39916800.0;
    s = s * z + 1.0 / 362880.0;
    s = s * z - 1.0 / 5040.0;
    s = s * z + 1.0 / 120.0;
    s = s * z - 1.0 / 6.0;
    s = r + r * z * s;
    c = c * z - 1.0 / 87178291200.0;
    c = c * z + 1.0 / 479001600.0;
    c = c * z - 1.0 / 3628800.0;
    c = c * z + 1.0 / 40320.0;
    c = c * z - 1.0 / 720.0;
    c = c * z + 1.0 / 24.0;
    c = (1.0 - 0.5 * z) + z * z * c;
    const int64_t quadrant = bits_of(shifted);
    const int64_t swap = -(quadrant & 1), sine_sign = (quadrant & 2) << 62, cosine_sign = ((quadrant + 1) & 2) << 62;
    const int64_t sb = bits_of(s), cb = bits_of(c), differ = (sb ^ cb) & swap;
    *sine = double_of(sb ^ differ ^ sine_sign);
    *cosine = double_of(cb ^ differ ^ cosine_sign);
}

INLINE double sine(double x) { double s, c; sine_cosine(x, &s, &c); return s; }
INLINE double cosine(double x) { double s, c; sine_cosine(x, &s, &c); return c; }
INLINE double exp_of_negative(double a) { double t, u; exp_negative(a, &t, &u); return t; }
INLINE double one_minus_exp(double a) { double t, u; exp_negative(a, &t, &u); return u; }
INLINE double smaller(double a, double b) { return a < b ? a : b; }
INLINE double larger(double a, double b) { return a > b ? a : b; }
