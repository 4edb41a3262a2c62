"""Where h_m, h_m' and h_m(x)/x of the hyperbolic family are extreme, enclosed by changes of sign.

With u = sinh²x and p = u^m everything but L is algebraic:

    h² = p² (1 + u) / (u (1 + p)²),     h' = p (2m - 1 + 2m u - p) / (u (1 + p)²).

Each root is approached by Newton's method in balls, where nothing is promised, and then bracketed: a
continuous function that provably has opposite signs at both ends of an interval has a root inside, and an
argument by counting says that it is the only one meant.

References: ``reyes2019family`` (6), (7), (8).
"""

from __future__ import annotations

from collections.abc import Callable
from math import asinh, cosh, log, sinh, sqrt

from flint import arb, ctx, fmpz_poly

Equation = Callable[[arb], tuple[arb, arb]]
"""The value and the derivative of a function at a point."""


def peak_of_h(m: int) -> arb:
    """The u = sinh²x at which h_m is largest, for m >= 2.

    h' has the sign of 2m - 1 + 2m u - u^m, whose coefficients change sign once: by Descartes' rule it has
    exactly one positive root, and h rises before it and falls after it.
    """
    u = 2.0
    for _ in range(60):
        u = (2 * m * u + 2 * m - 1) ** (1 / m)

    def rise(v: arb) -> tuple[arb, arb]:
        p = power(v, m)
        return 2 * m - 1 + 2 * m * v - p, 2 * m - m * p / v

    return bracketed_root(rise, u, m)


def peaks_of_dh(m: int) -> tuple[arb, arb]:
    """The two u = sinh²x at which h_m' is largest and smallest, for m >= 2.

    h'' has, for x > 0, the sign of

        P(u) = (2m-1)(m-1) + 2m² u - (2m-1)(m+2) u^m - 2m² u^(m+1) + u^(2m),

    whose coefficients change sign twice: at most two positive roots (Descartes). Both are found, so h' rises
    from 0 to its maximum, falls through 0 to its minimum, and rises back to 0.
    """

    def curvature(v: arb) -> tuple[arb, arb]:
        p = power(v, m)
        a, b = (2 * m - 1) * (m - 1) + 2 * m * m * v, (2 * m - 1) * (m + 2) + 2 * m * m * v
        return a - b * p + p * p, 2 * m * m * (1 - p) + m * p / v * (2 * p - b)

    guesses = (_curvature_guess(m, largest) for largest in (False, True))
    low, high = (bracketed_root(curvature, guess, m) for guess in guesses)
    if not low < high:
        raise ArithmeticError(f"the two roots of P for m = {m} were not told apart")
    return low, high


def _curvature_guess(m: int, largest: bool) -> float:
    """A double near a root of P: P = 0 is a quadratic in u^m with coefficients that hardly vary with u."""
    u = 1.0
    for _ in range(60):
        a, b = (2 * m - 1) * (m - 1) + 2 * m * m * u, (2 * m - 1) * (m + 2) + 2 * m * m * u
        p_large = (b + sqrt(b * b - 4 * a)) / 2
        u = (p_large if largest else a / p_large) ** (1 / m)
    return u


def peaks_of_d2h(m: int) -> tuple[arb, ...]:
    """The u = sinh²x > 0 at which h_m'' may have an extreme, and perhaps others.

    With P of `peaks_of_dh` and p = u^m the third derivative has for x > 0 the sign of the polynomial

        (1 + p)((1 + 2u) P + 2(1 + u)((m-2) P + u P')) - 6m (1 + u) p P,

    all of whose roots flint isolates; those that are not shown to be off the positive axis are handed back.
    """
    u, k = fmpz_poly([0, 1]), 2 * m - 1
    p, one = u**m, 1 + u
    P = k * (m - 1) + 2 * m * m * u * (1 - p) - k * (m + 2) * p + p * p
    rise = (1 + p) * ((1 + 2 * u) * P + 2 * one * ((m - 2) * P + u * P.derivative())) - 6 * m * one * p * P
    roots = (root for root, _ in rise.complex_roots())
    return tuple(sorted((x.real for x in roots if x.imag.contains(0) and not x.real <= 0), key=float))


def peak_of_secant(m: int) -> arb:
    """The x > 0 at which h_m(x)/x is largest, for m >= 2.

    The derivative of h/x has the sign of F(x) = x h' - h, and F' = x h''. By the roots of P, h is convex up
    to x_ρ and concave from there to x_γ: so F rises from F(0) = 0 and then falls to F(x_γ) = -h(x_γ) < 0,
    with exactly one zero in (0, x_γ). Beyond x_γ, where h falls, h/x falls too: that zero is the peak of h/x.
    In u, p and s = sinh x, c = cosh x, F has the sign of x (2m - 1 + 2m u - p) - (1 + p) s c.
    """

    def excess(x: arb) -> tuple[arb, arb]:
        s, c = x.sinh_cosh()
        u = s * s
        p = power(u, m)
        n = 2 * m - 1 + 2 * m * u - p
        slope = n + 2 * m * x * (2 * s * c - p * c / s) - 2 * m * p * c * c - (1 + p) * (2 * u + 1)
        return x * n - (1 + p) * s * c, slope

    return bracketed_root(excess, _secant_guess(m), m)


def _secant_guess(m: int) -> float:
    """A double near the peak of h/x, by bisection of F over (x_ρ, x_γ)."""
    low, high = (asinh(sqrt(float(u.mid()))) for u in (peaks_of_dh(m)[0], peak_of_h(m)))
    for _ in range(60):
        x = (low + high) / 2
        rises = _secant_rises(m, x)
        low, high = (x, high) if rises else (low, x)
    return (low + high) / 2


def _secant_rises(m: int, x: float) -> bool:
    s, c = sinh(x), cosh(x)
    p = s ** (2 * m)
    return x * (2 * m - 1 + 2 * m * s * s - p) > (1 + p) * s * c


def bracketed_root(equation: Equation, guess: float, m: int) -> arb:
    """An enclosure, tight at the current precision, of the simple root of a function near a guess.

    Soundness: the ball holds a root because the function changes sign between two points inside it; that no
    other root is meant is for the caller to argue.
    """
    spare = 20 + 4 * int(log(m, 2))
    wanted = ctx.prec
    with ctx.workprec(wanted + spare):
        x = arb(guess)
        for _ in range(4 + wanted.bit_length()):
            value, slope = equation(x)
            x = (x - value / slope).mid()
        for slack in range(0, spare + wanted - 30, 8):
            radius = x * arb(2) ** (slack - wanted)
            left, right = (x - radius).lower(), (x + radius).upper()
            if _opposite(equation(left)[0], equation(right)[0]):
                return left.union(right)
    raise ArithmeticError(f"no change of sign found near {guess} for m = {m}")


def _opposite(left: arb, right: arb) -> bool:
    return bool((left < 0 and right > 0) or (left > 0 and right < 0))


def power(base: arb, exponent: int) -> arb:
    """``base ** exponent`` by repeated multiplication: finite for balls around zero, as flint's is not."""
    result = arb(1)
    while exponent:
        if exponent & 1:
            result = result * base
        exponent >>= 1
        base = base * base if exponent else base
    return result
