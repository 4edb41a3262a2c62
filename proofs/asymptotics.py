"""How γ_m, ρ_m and L_m of the hyperbolic family grow with m: bounds for each m that tighten as m → ∞.

With u = sinh²x and p = u^m the family is  h² = ((1 + u)/u) (p/(1 + p))²,  and the peak of h is where
p = 2m u + 2m − 1. There u > 1 and ln u = ln p/m = ln(4m)/m + O(1/m²): the peak moves to x = asinh 1, where
√((1 + u)/u) → √2, and p/(1 + p) → 1. In the variable t = ln p the derivative near x = asinh 1 is
(4m − 2 − 3t − m t²)/4 + O(1/m), largest at t = −3/(2m). Hence, for m → ∞,

    γ_m = √2 (1 − (1 + ln 4m)/(4m) + O((ln m/m)²)),    ρ_m = m − 1/2 + 9/(16m) + O(1/m²),
    L_m = √2/asinh 1 (1 − κ (1 + ln(m/κ))/m + O((ln m/m)²)),    κ = (1 + √2/asinh 1)/4.

Each claim is decided for the m that is asked for: ``lyapcheck check asymptotics.py --m 1:1000``. What is
known of all m at once is in ``every_m.py``.
"""

from fractions import Fraction

from lyapcheck.claims import Constant, Proof, all_of, dh, expr, gamma, identity, log, rho, secant_bound, sqrt

proof = Proof(
    "asymptotics", "The constants of the hyperbolic family for large m", reference="reyes2019family"
)

ROOT2 = sqrt(2)
ASINH1 = log(1 + ROOT2)


def shrinking(m):
    """ln(4m)/m."""
    return log(4 * m) / m


def first_order(m):
    """1 − (1 + ln 4m)/(4m)."""
    return 1 - (1 + log(4 * m)) / (4 * m)


proof.section("Limits")


@proof.claim("A.slope", "h_m'(0) is 1 for m = 1 and 0 for m ≥ 2")
def _(m):
    return identity(dh(m, 0), 1 if m == 1 else 0)


@proof.claim("A.gamma", "γ_m < √2: the peaks stay below the limit")
def _(m):
    return Constant(gamma(m) < ROOT2)


@proof.claim("A.rho", "m − 1/2 < ρ_m ≤ m: the steepest slope grows like m")
def _(m):
    steepest = rho(m)
    return all_of(above=Constant(expr(m - Fraction(1, 2)) < steepest), below=Constant(steepest <= m))


@proof.claim("A.L", "L_m < √2/asinh 1: the steepest secant stays below the limit")
def _(m):
    return Constant(secant_bound(m) < ROOT2 / ASINH1)


proof.section("Rates")


@proof.claim(
    "A.gamma.rate",
    "3/32 (ln 4m/m)² < γ_m/√2 − (1 − (1 + ln 4m)/(4m)) < 1/6 (ln 4m/m)²",
    uses=["A.gamma"],
)
def _(m):
    rest = gamma(m) / ROOT2 - first_order(m)
    square = shrinking(m) ** 2
    return all_of(
        above=Constant(square * Fraction(3, 32) < rest), below=Constant(rest < square * Fraction(1, 6))
    )


@proof.claim(
    "A.rho.rate",
    "−3/(4m²) < ρ_m − (m − 1/2 + 9/(16m)) < 0",
    uses=["A.rho"],
)
def _(m):
    rest = rho(m) - (m - Fraction(1, 2) + Fraction(9, 16 * m))
    return all_of(above=Constant(expr(Fraction(-3, 4 * m * m)) < rest), below=Constant(rest < 0))


@proof.claim(
    "A.L.rate",
    "1/5 (ln 4m/m)² < L_m asinh 1/√2 − (1 − κ (1 + ln(m/κ))/m) < 1/3 (ln 4m/m)²,  κ = (1 + √2/asinh 1)/4",
    uses=["A.L"],
)
def _(m):
    kappa = (1 + ROOT2 / ASINH1) / 4
    rest = secant_bound(m) * ASINH1 / ROOT2 - (1 - kappa * (1 + log(m / kappa)) / m)
    square = shrinking(m) ** 2
    return all_of(
        above=Constant(square * Fraction(1, 5) < rest), below=Constant(rest < square * Fraction(1, 3))
    )
