"""The tracking scheme (21): uniform asymptotic stability for every bounded q̇_d.

With w = −(q̇_d − q̇), (21) closes a loop of the form (11) in which C(q, q̇) stands for C(q, w), q̇ = q̇_d + w;
Ṁ = C + Cᵀ holds for C(q, q̇) too, so V of (13) has the same eleven terms for its rate. Two of them have C:

    −ε hᵀCᵀw ≤ ε k_c (b + v_d) a b   and   ½ε² hᵀ(C + Cᵀ)h ≤ ε² k_c (b + v_d) a²,   v_d = sup ‖q̇_d(t)‖.

With a ≤ √nγ where b stands, the form is that of proofs/scalar.py with v_d in two places,

    θ'11 = ε (k − ε k_c v_d),   θ'12 = −½ ε (d + k_c v_d + ε c),   θ'22 = λmin(B) − ε c,

and for every v_d < ∞ some ε₀ makes it positive definite. The error system depends on time through q_d(t),
as q = q_d(t) − q̃. So the conclusion needs bounds of V and of its rate in which there is no t: 21.below,
21.above and 21.form. They hold whatever q_d(t) is, so stability is uniform in the initial time, and in q_d as
long as ‖q̇_d‖ ≤ v_d. Taken for granted: q_d has two continuous derivatives, and (21) knows M, C, g, B exactly.

The torque of (21) is not bounded, whatever h is: C(q, q̇)q̇_d grows with q̇. Only (6) is.
Strict Lyapunov functions for tracking are in the second reference. For every n and every function at once
it is in ``every_function.py``.

References: ``reyes2019family``, ``santibanez1997strict``.
"""

from dataclasses import replace
from fractions import Fraction

from lyapcheck.claims import (
    ArmBounds,
    FamilyBounds,
    Proof,
    all_of,
    any_matrix,
    any_vector,
    at_arm,
    companion,
    dot,
    every_n,
    expr,
    for_all,
    gamma,
    h,
    identity,
    lacking,
    largest_with,
    loops,
    property_of,
    rate_at_most,
    rate_definite,
    rho,
    scaled,
    secant_bound,
    total,
    var,
    zero_vector,
)

proof = Proof(
    "tracking",
    "The tracking scheme (21): uniform asymptotic stability for every bounded q̇_d",
    reference="reyes2019family",
)

FAMILY = companion("every_function.py")
"""The torque (21), V of (13) and the bound of its rate, for any function."""
x = var("x")
SPEED = Fraction(2)
"""v_d in rad/s for the conclusion with numbers."""
SHARE = Fraction(99, 100)
"""ε₀ as a share of the largest one for which Θ' ≻ 0, rounded to six digits."""

SAME_TERMS = [f"rate.{k}" for k in (1, 2, 3, 4, 6, 7, 8, 10, 11)]
proof.adopt("scalar.py", "V.positive", "V.unbounded", "h.bounds", *SAME_TERMS)


def sign_of(m):
    """h is odd and has the sign of its argument."""
    return {
        "odd": identity(h(m, -x), -h(m, x)),
        "positive_right_of_0": for_all(expr(0) < h(m, x), 0, open_low=True),
    }


def known_of(m, n):
    """γ, √nγ, ρ, L and G of h_m in decimals."""
    return FamilyBounds(n, gamma(m), rho(m), secant_bound(m))


proof.section("The loop that (21) closes")


@proof.claim(
    "21.loop",
    "w = −(q̇_d − q̇) obeys (11) with C(q, q̇) in place of C(q, w); the origin is an equilibrium",
    "(1), (21)",
    uses=["h.odd"],
)
def _(m):
    s = loops.letters()
    zero = zero_vector()
    origin = replace(s, w=zero, hw=zero, h=zero)
    z, *others = (any_vector(name) for name in ("z", "vd", "ad", "g"))
    return all_of(
        **sign_of(m),
        loop=every_n(lacking_torque(s, z, *others), dot(z, loops.force(s)) - dot(z, loops.inertia(s))),
        equilibrium=every_n(dot(z, loops.force(origin)), expr(0)),
        with_the_letters_of_the_theorem=property_of("the origin is an equilibrium", stable_of(m, "any")),
    )


def lacking_torque(s, z, speed, acceleration, weight):
    """zᵀ of (21) minus the left side of (1) at q̇ = q̇_d + w, q̈ = q̈_d + ẇ, with h(ė) = −h(w) as h is odd."""
    velocity = speed + s.w
    applied = scaled(s.kp, s.h) - scaled(s.kv, s.hw) + s.M @ acceleration + s.C @ speed + weight
    applied += scaled(s.b, speed)
    needed = s.M @ (acceleration + s.a) + s.C @ velocity + weight + scaled(s.b, velocity)
    return dot(z, applied) - dot(z, needed)


proof.section("dV/dt ≤ −[a b] Θ' [a b]ᵀ, with ‖q̇_d‖ ≤ v_d")


def bounds_of(known):
    """The bounds of the eleven terms; those of the fifth and the ninth have v_d in them."""
    names = ("a", "b", "eps", "kp", "b_min", "b_max", "kv_max", "beta", "kc", "vd")
    a, b, eps, k, b_min, b_max, kv_max, beta, kc, vd = map(var, names)
    return [
        expr(0),
        -b_min * b**2,
        eps * known.rho * beta * b**2,
        eps * known.G * beta * b**2,
        eps * kc * vd * a * b + eps * known.reach * kc * b**2,
        -eps * k * a**2,
        eps * b_max * a * b,
        eps * known.L * kv_max * a * b,
        eps**2 * kc * vd * a**2 + eps**2 * known.reach * kc * a * b,
        eps**2 * known.G * beta * a * b,
        eps**2 * known.rho * beta * a * b,
    ]


def term(m, n, k, *names):
    """Term k of (15) with C(q, q̇) = C(q, w) + D, D = C(q, q̇_d), ‖D‖ ≤ k_c v_d, is at most its bound."""
    s, known, desired = loops.short_letters(), known_of(m, n), any_matrix("D")
    sizes = loops.known_norms(s, known) | {"D": (desired, var("kc") * var("vd"))}
    turning = replace(s, C=s.C + desired)
    return loops.term_at_most(turning, k, bounds_of(known)[k - 1], [sizes[name] for name in names])


@proof.claim(
    "21.5",
    "term 5: −ε hᵀC(q,q̇)ᵀw ≤ ε k_c v_d a b + ε√nγ k_c b²",
    "(15), term 5",
    uses=["rate", "h.bound"],
)
def _(m, n):
    return term(m, n, 5, "h", "reach", "C", "D", "w")


@proof.claim(
    "21.9",
    "term 9: ½ε² hᵀ(C + Cᵀ)h ≤ ε² k_c v_d a² + ε²√nγ k_c a b",
    "(15), term 9",
    uses=["rate", "h.bound"],
)
def _(m, n):
    return term(m, n, 9, "h", "reach", "C", "D")


def theta(eps, k, b_min, c, d, turn):
    """θ'11, θ'12, θ'22; ``turn`` is k_c v_d."""
    return eps * (k - eps * turn), -eps / 2 * (d + turn + eps * c), b_min - eps * c


def form_of(known):
    """The same in the constants of the loop."""
    names = ("eps", "kp", "b_min", "b_max", "kv_max", "beta", "kc", "vd")
    eps, k, b_min, b_max, kv_max, beta, kc, vd = map(var, names)
    return theta(eps, k, b_min, known.drift(beta, kc), known.cross(b_max, kv_max), kc * vd)


def stable_of(m, eps0="some"):
    """The theorem for h_m, for some ε₀, each that is ``given`` with the condition, or ``any``."""
    return FAMILY.tracking(FAMILY.h_of(m), eps0)


@proof.claim(
    "21.form",
    "dV/dt ≤ −[a b] Θ' [a b]ᵀ, in which there is no t",
    "in place of (16)",
    uses=["21.loop", "21.5", "21.9", *SAME_TERMS],
)
def _(m, n):
    """The bounds of the eleven terms add up to the form; and from V itself, with letters for n and h."""
    known, a, b = known_of(m, n), var("a"), var("b")
    corner, side, low = form_of(known)
    return all_of(
        sum=identity(total(bounds_of(known)), -(corner * a**2 + 2 * side * a * b + low * b**2)),
        from_V_for_every_n=rate_at_most(stable_of(m)),
    )


proof.section("Uniform asymptotic stability, for every arm")


@proof.claim(
    "21.below",
    "V ≥ ½λmin(M)‖y‖² + λmin(K_p) Σ U(q̃_i), positive definite and without t",
    "(13)",
    uses=["V.positive"],
)
def _(m):
    """λmin(M) is one number μ > 0 for all q(t): M is positive definite on the compact torus of angles."""
    return property_of("V is positive definite", stable_of(m, "any"))


@proof.claim(
    "21.above",
    "V ≤ ½β_M(‖w‖ + ε‖h‖)² + ‖k_p‖ Σ U(q̃_i), without t and 0 at the origin",
    "(13)",
    uses=["V.positive"],
)
def _(m):
    return property_of("V is decrescent", stable_of(m, "any"))


@proof.claim(
    "21.small",
    "for every v_d some ε₀ > 0 makes Θ' positive definite for every ε in (0, ε₀]",
    "in place of (18)",
)
def _(m):
    return rate_definite(stable_of(m))


STEPS = ("21.loop", "V.smooth", "V.positive", "21.below", "21.above", "V.unbounded", "h.bounds", "21.form")
"""Steps of the theorem by themselves; its own certificate has them all, for every n."""


@proof.claim(
    "21",
    "(21) makes the origin globally uniformly asymptotically stable, whatever v_d = sup‖q̇_d‖ < ∞ is",
    "Remark II, (21)",
    uses=[*STEPS, "21.small"],
)
def _(m):
    """For every robot with Properties 2.1–2.7 and all positive gains; ε₀ is not part of the controller."""
    return stable_of(m)


proof.section("This arm, with a number for v_d")
proof.adopt("scalar.py", "arm.properties", "arm.M", "arm.C")


def form_numbers(m, n, robot, gains):
    """λmin(K_p), λmin(B), c, d and k_c v_d for the robot and gains at hand."""
    known, arm = known_of(m, n), ArmBounds(robot)
    c, d = known.drift(arm.beta, arm.kc), known.cross(arm.b_max, max(gains.kv))
    return min(gains.kp), arm.b_min, c, d, arm.kc * SPEED


def eps0_of(m, n, robot, gains):
    """ε₀: a share of the largest one for which Θ' ≻ 0; both entries and det Θ'/ε fall with ε up to there.

    Raises:
        Lacking: there is none, as where a joint has no friction.
    """
    k, b, c, d, turn = form_numbers(m, n, robot, gains)

    def positive_definite(eps):
        corner, side, low = theta(eps, k, b, c, d, turn)
        return corner > 0 and low > 0 and side**2 < corner * low

    largest = largest_with(positive_definite)
    if largest is None:
        raise lacking("no ε₀ > 0 makes Θ' positive definite; λmin(B) and λmin(K_p) must be positive")
    return SHARE * largest


@proof.claim("arm.inertia", "M(q) − μI is positive definite for a number μ > 0", "Property 2.1")
def _(robot):
    """μ is half of the least eigenvalue at a few postures, rounded down to a power of two."""
    arm = ArmBounds(robot)
    return arm.mass_above(arm.guessed_floor())


@proof.claim(
    "arm.21.theta",
    f"Θ' is positive definite for every ε in (0, ε₀], at these numbers and v_d = {SPEED} rad/s",
    "in place of (18)",
)
def _(m, n, robot, gains):
    eps = var("x") * eps0_of(m, n, robot, gains)
    k, b, c, d, turn = map(expr, form_numbers(m, n, robot, gains))
    return all_of(
        corner=for_all(expr(0) < k - eps * turn, 0, 1),
        determinant=for_all(eps / 4 * (d + turn + eps * c) ** 2 < (k - eps * turn) * (b - eps * c), 0, 1),
    )


@proof.claim(
    "arm.21",
    f"for ‖q̇_d‖ ≤ {SPEED} rad/s the origin is globally uniformly asymptotically stable, with this ε₀ in V",
    "Remark II, (21)",
    uses=[
        *STEPS,
        "arm.properties",
        "arm.inertia",
        "arm.M",
        "arm.C",
        "arm.21.theta",
    ],
)
def _(m, n, robot, gains):
    eps0 = eps0_of(m, n, robot, gains)
    return at_arm(stable_of(m, "given"), robot, Kp=gains.kp, Kv=gains.kv, eps0=eps0, vd=SPEED)
