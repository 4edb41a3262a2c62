"""What a user would write for a table of γ_m, ρ_m and L_m: mpmath's findroot, no certificate.

Usage: python table_mpmath.py FIRST LAST DIGITS
"""

import sys

from mpmath import asinh, cosh, findroot, mp, mpf, nstr, sinh, sqrt


def h(m, x):
    s = sinh(x) ** (2 * m)
    return s / sinh(x) * cosh(x) / (1 + s)


def dh(m, x):
    u = sinh(x) ** 2
    return ((2 * m - 1) * u ** (m - 1) + 2 * m * u**m - u ** (2 * m - 1)) / (1 + u**m) ** 2


def ddh_sign(m, u):
    left = (2 * m - 1) * (m - 1) + 2 * m**2 * u + u ** (2 * m)
    return left - (2 * m - 1) * (m + 2) * u**m - 2 * m**2 * u ** (m + 1)


def bracketed(f, low, high):
    return findroot(f, (mpf(low), mpf(high)), solver="anderson", verify=False, maxsteps=200)


def row(m):
    if m == 1:
        return m, mpf(1), mpf(1), mpf(1)
    peak = bracketed(lambda u: m * mp.log(u) - mp.log(2 * m * u + 2 * m - 1), 1, 8)
    steepest = bracketed(lambda u: ddh_sign(m, u), "1e-6", peak)
    x_peak, x_steepest = asinh(sqrt(peak)), asinh(sqrt(steepest))
    tangent = bracketed(lambda x: x * dh(m, x) - h(m, x), x_steepest, x_peak)
    return m, h(m, x_peak), dh(m, x_steepest), h(m, tangent) / tangent


if __name__ == "__main__":
    first, last, digits = map(int, sys.argv[1:4])
    mp.dps = digits + 10
    for m in range(first, last + 1):
        print(m, *(nstr(value, digits) for value in row(m)[1:]))
