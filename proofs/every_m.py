"""How γ_m, ρ_m and L_m of the hyperbolic family grow with m, for all m at once.

With u = sinh²x and p = u^m,  h² = (1 + 1/u) (p/(1 + p))²  and  h' = p (2m + (2m − 1 − p)/u)/(1 + p)². The
claims take m as a real variable. Together they give, with θ between 3/32 and 1/6,

    γ_m = √2 (1 − (1 + ln 4m)/(4m) + θ (ln 4m/m)²)                  for every m ≥ 2
    m − 1/2 + 9/(16m) − 3/(4m²) < ρ_m < m − 1/2 + 9/(16m)           for every m ≥ 12
    √2/asinh 1 (1 − 3 ln(4m)/(4m)) < L_m < √2/asinh 1               for every m ≥ 2

γ_m: from below it is the value of h where p = 4m. The peak is at the one positive root of p = 2m u + 2m − 1,
left of which p is smaller, so it lies right of (4m)^(1/m); there h² is (1 + 1/u)(1 − 1/(2m(1 + u)))².

ρ_m: from below it is the slope where p = e^(−3/(2m)). Where p ≥ 1 the slope is at most m − 1/2, rising or
falling. Left of that, with p = e^(−s), h' is (2m + e^(s/m) (2m − 1 − e^(−s)))/(4 cosh²(s/2)): for s ≤ m
polynomials enclose what is not algebraic, and for s ≥ m the slope is at most 4m e^(1−m). E.rho.form and
E.rho.far say so of every real m.

L_m: from below it is h/x where p = 3m/2, with asinh y ≤ asinh 1 + (y − 1)/√2 for y = sinh x ≥ 1. From above:
right of x = asinh 1 it is less than coth x/x, which falls; left of that h_m is at most h_2 (E.L.below).

As m grows, h_m(x) falls to 0 for |x| < asinh 1 = 50.5° and tends to coth x beyond: a dead zone.
"""

from fractions import Fraction

from lyapcheck.claims import (
    Constant,
    ForSmall,
    Proof,
    all_of,
    cosh,
    every_n,
    exp,
    expr,
    for_all,
    h,
    identity,
    implies,
    log,
    nonnegative,
    positive,
    rate,
    sinh,
    sqrt,
    var,
)

proof = Proof(
    "every_m", "The constants of the hyperbolic family for all m at once", reference="reyes2019family"
)

M = var("m")
ROOT2 = sqrt(2)
ASINH1 = log(1 + ROOT2)


def slope_in(m, p, u):
    """h_m' with u = sinh²x and p = u^m."""
    return p * (2 * m + (2 * m - 1 - p) / u) / (1 + p) ** 2


proof.section("h in u and p")
S, C, P = (var(name) for name in ("s", "c", "p"))


@proof.claim(
    "E.form.slope",
    "with s = sinh x, c = cosh x, p = s^(2m): h = pc/((1 + p)s) moves by p(2mc² − 1 − p)/((1 + p)²s²)",
)
def _():
    """ds/dx = c, dc/dx = s = (c² − 1)/s and dp/dx = 2mp c/s, for every real m."""
    moving = [(S, C), (C, (C**2 - 1) / S), (P, 2 * M * P * C / S), (M, expr(0))]
    right = P * (2 * M * C**2 - 1 - P) / ((1 + P) ** 2 * S**2)
    return every_n(rate(P * C / ((1 + P) * S)), right, rates=moving, positive=[S, C, P, M])


@proof.claim(
    "E.form.u", "p(2mc² − 1 − p)/((1 + p)²s²) is p(2m + (2m − 1 − p)/u)/(1 + p)² with s² = u, c² = 1 + u"
)
def _():
    u = var("u")
    left = P * (2 * M * (1 + u) - 1 - P) / ((1 + P) ** 2 * u)
    return identity(left, slope_in(M, P, u), positive("m", "p", "u"))


proof.section("γ")

FOUR_M = var("x")
"""4m: in this variable ln 4m is a plain logarithm."""

STEP = 4 * log(FOUR_M) / FOUR_M
U = exp(STEP)
"""(4m)^(1/m), where p = 4m."""


def leading(share):
    """1 − (1 + ln 4m)/(4m) and a share of (ln 4m/m)², squared."""
    return (1 - (1 + log(FOUR_M)) / FOUR_M + STEP**2 * share) ** 2


@proof.claim(
    "E.gamma.value",
    "h_m²/2 where sinh^(2m) x = 4m is more than (1 − (1 + ln 4m)/(4m) + 3/32 (ln 4m/m)²)², every real m ≥ 2",
)
def _():
    value = (1 + 1 / U) / 2 * (FOUR_M / (FOUR_M + 1)) ** 2
    return for_all(leading(Fraction(3, 32)) < value, 8)


@proof.claim(
    "E.gamma.left",
    "u^m < 2m u + 2m − 1 at u = (4m)^(1/m): the peak of h_m is right of it, every real m ≥ 2",
)
def _():
    return for_all(FOUR_M < FOUR_M / 2 * (U + 1) - 1, 8)


@proof.claim(
    "E.gamma.peak",
    "h_m rises where p < 2m u + 2m − 1 and falls beyond; there p/(1 + p) is 1 − 1/(2m(1 + u)), every real m",
    uses=["E.form.u"],
)
def _():
    u, top = var("u"), 2 * M * var("u") + 2 * M - 1
    free = positive("m", "u", "p")
    return all_of(
        rises=implies(free, (top > P,), slope_in(M, P, u) > 0),
        falls=implies(free, (top < P,), slope_in(M, P, u) < 0),
        value=identity((top / (1 + top)) ** 2, (1 - 1 / (2 * M * (1 + u))) ** 2, positive("m", "u")),
    )


@proof.claim(
    "E.gamma.falls",
    "(1 + 1/u) (1 − 1/(2m(1 + u)))², which h_m² is at its peak, falls in u > 1, every real m ≥ 1",
)
def _():
    u = var("u")
    factor = 1 - 1 / (2 * M * (1 + u))
    slope = -(factor**2) / u**2 + (1 + 1 / u) * 2 * factor / (2 * M * (1 + u) ** 2)
    return implies(positive("m", "u"), (expr(1) <= M, expr(1) < u), slope < 0)


@proof.claim(
    "E.gamma.bound",
    "half of that at u = (4m)^(1/m) is less than (1 − (1 + ln 4m)/(4m) + 1/6 (ln 4m/m)²)², every real m ≥ 2",
    uses=["E.gamma.left", "E.gamma.falls"],
)
def _():
    value = (1 + 1 / U) / 2 * (1 - 2 / (FOUR_M * (1 + U))) ** 2
    return for_all(value < leading(Fraction(1, 6)), 8)


proof.section("ρ")

UPPER = M - Fraction(1, 2) + Fraction(9, 16) / M
"""m − 1/2 + 9/(16m)."""


@proof.claim(
    "E.rho.value",
    "h_m' where sinh^(2m) x = e^(−3/(2m)) is more than m − 1/2 + 9/(16m) − 3/(4m²), every real m ≥ 1",
)
def _():
    p, q = exp(Fraction(-3, 2) / M), exp(Fraction(3, 2) / M**2)
    slope = p * (2 * M + q * (2 * M - 1 - p)) / (1 + p) ** 2
    return for_all(UPPER - Fraction(3, 4) / M**2 < slope, 1)


@proof.claim("E.rho.right", "|h_m'| ≤ m − 1/2 where sinh^(2m) x ≥ 1, every real m ≥ 2")
def _():
    m, p, u = 2 + var("k"), 1 + var("over"), 1 + var("d")
    slope = p * (2 * m + (2 * m - 1 - p) / u) / (1 + p) ** 2
    free = nonnegative("k", "over", "d")
    limit = m - Fraction(1, 2)
    return all_of(rising=implies(free, (), slope <= limit), falling=implies(free, (), -slope <= limit))


@proof.claim(
    "E.rho.enclosed",
    "e^v ≤ 1 + v + v² on [0, 1], 1 − e^(−s) ≤ s and cosh²(s/2) ≥ 1 + s²/4 + s⁴/48 for s ≥ 0",
)
def _():
    x = var("x")
    return all_of(
        grows=for_all(exp(x) <= 1 + x + x**2, 0, 1),
        falls=for_all(1 - exp(-x) <= x, 0),
        spreads=for_all(1 + x**2 / 4 + x**4 / 48 <= cosh(x / 2) ** 2, 0),
    )


def below_upper(s, m):
    """That 2m + (1 + s/m + s²/m²)(2m − 2 + s) < 4 (1 + s²/4 + s⁴/48) (m − 1/2 + 9/(16m))."""
    top = 2 * m + (1 + s / m + s**2 / m**2) * (2 * m - 2 + s)
    return top < 4 * (1 + s**2 / 4 + s**4 / 48) * (m - Fraction(1, 2) + Fraction(9, 16) / m)


@proof.claim(
    "E.rho.bound",
    "2m + (1 + s/m + s²/m²)(2m − 2 + s) < 4 (1 + s²/4 + s⁴/48)(m − 1/2 + 9/(16m)), s ≥ 0, every real m ≥ 12",
    uses=["E.rho.enclosed"],
)
def _():
    """Right and left of 2ms = 3, where both sides nearly meet; m = 12 + k."""
    m, z = 12 + var("k"), var("z")
    free = nonnegative("k", "z")
    return all_of(
        right=implies(free, (), below_upper((Fraction(3, 2) + z) / m, m)),
        left=implies(free, (), below_upper(Fraction(3, 2) / (1 + z) / m, m)),
    )


@proof.claim(
    "E.rho.form",
    "with y = e^(s/2), p = y^(−2) and q = 1/u: h_m' is (2m + q(2m − 1 − p))/(4 cosh²(s/2))",
    uses=["E.form.u"],
)
def _():
    y, q = var("y"), var("q")
    p, cosh_half = 1 / y**2, (y + 1 / y) / 2
    slope = (2 * M + q * (2 * M - 1 - p)) / (4 * cosh_half**2)
    return identity(slope, slope_in(M, p, 1 / q), positive("m", "y", "q"))


@proof.claim(
    "E.rho.far",
    "|h_m'| ≤ 4m p q where q ≥ 1; for s ≥ m at most 4m e^(1−m), less than m − 1/2 for every real m ≥ 3",
    uses=["E.rho.form"],
)
def _():
    """p q = e^(−s(m − 1)/m) with s = m + more."""
    k, p, q, more = var("k"), var("p"), 1 + var("over"), var("more")
    m = 1 + k
    slope = p * (2 * m + q * (2 * m - 1 - p)) / (1 + p) ** 2
    free = nonnegative("k", "p", "over")
    return all_of(
        rising=implies(free, (), slope <= 4 * m * p * q),
        falling=implies(free, (), -slope <= 4 * m * p * q),
        exponent=implies(nonnegative("k", "more"), (), -(m + more) * (m - 1) / m <= 1 - m),
        small=for_all(4 * M * exp(1 - M) < M - Fraction(1, 2), 3),
    )


proof.section("L")

TURN = Fraction("0.8023")
"""More than 1/(√2 asinh 1)."""


@proof.claim(
    "E.L.tangent",
    "asinh y has a slope of at most 1/√2 for y ≥ 1, and 1/(√2 asinh 1) < 0.8023",
)
def _():
    x = var("x")
    return all_of(
        slope_squared=for_all(1 / (1 + x**2) <= Fraction(1, 2), 1),
        relative=Constant(1 / (ROOT2 * ASINH1) < TURN),
    )


@proof.claim(
    "E.L.value",
    "h_m(x)/x where sinh^(2m) x = 3m/2 is more than √2/asinh 1 (1 − 3 ln(4m)/(4m)), every real m ≥ 2",
    uses=["E.L.tangent"],
)
def _():
    """Both sides times asinh 1/√2; y = sinh x = (3m/2)^(1/(2m))."""
    p = var("x")
    m = p * Fraction(2, 3)
    y = exp(log(p) / (2 * m))
    value = sqrt((1 + 1 / y**2) / 2) * p / (1 + p)
    return for_all((1 - Fraction(3, 4) * log(4 * m) / m) * (1 + TURN * (y - 1)) < value, 3)


@proof.claim(
    "E.L.below",
    "p/(1 + p), the share of coth x that h_m is, is less than 1, and rises with p",
)
def _():
    """So h_m < coth x; and h_m ≤ h_2 where u < 1 and m ≥ 2, as p = u^m ≤ u²."""
    less, p = var("less"), var("p")
    return all_of(
        share=implies(positive("p"), (), p / (1 + p) < 1),
        rises=implies(positive("p", "less"), (less < p,), less / (1 + less) < p / (1 + p)),
    )


@proof.claim(
    "E.L.bound",
    "coth x/x falls for x > 0, from √2/asinh 1 at asinh 1; h_2(x) ≤ 9/10 x, less than x √2/asinh 1",
    uses=["E.L.below"],
)
def _():
    x = var("x")
    return all_of(
        falls=for_all(-(x + sinh(x) * cosh(x)) / (x * sinh(x)) ** 2 < 0, 0, open_low=True),
        there=identity(sqrt(1 + 1 / expr(1)), ROOT2),
        left=for_all(h(2, x) <= Fraction(9, 10) * x, 0),
        limit=Constant(expr(Fraction(9, 10)) < ROOT2 / ASINH1),
    )


proof.section("The limit")


@proof.claim("E.limit.inside", "h_m → 0 where sinh²x = u < 1, as p = u^m → 0: a dead zone up to asinh 1")
def _():
    u, d = var("u"), var("d")
    return ForSmall("p", positive("u", "d"), (), (1 + u) * P**2 < d * u * (1 + P) ** 2)


@proof.claim(
    "E.limit.falls",
    "h_m(x) falls as m grows where u < 1: ∂h_m/∂m = coth x · p ln u/(1 + p)² < 0, as ∂p/∂m = p ln u",
)
def _():
    log_u, coth = var("log_u"), var("coth")
    moving = [(M, expr(1)), (P, P * log_u), (coth, expr(0)), (log_u, expr(0))]
    moves = every_n(
        rate(coth * P / (1 + P)), coth * P * log_u / (1 + P) ** 2, rates=moving, positive=[P, coth]
    )
    down = -coth * P * var("minus_log_u") / (1 + P) ** 2
    return all_of(moves=moves, falls=implies(positive("p", "coth", "minus_log_u"), (), down < 0))


@proof.claim("E.limit.outside", "h_m² → 1 + 1/u = coth²x where u > 1, as 1/p → 0")
def _():
    d, rest = var("d"), var("rest")
    return ForSmall("rest", positive("d"), (), 1 - (1 / (1 + rest)) ** 2 < d)
