"""The paper's proof, claim by claim, in the order of the text.

Every claim says what the paper says and states it as data; what comes of it is computed.
Ids follow the numbers of the paper's equations; e is q̃ and w is q̇.
``stands`` says whose sentence a claim is: quoted from the paper, implied by its argument, or ours.
Ours can be no error of the paper: further questions, and the repairs that reports print (R).

What the proposition says is classical by LaSalle's theorem (``kelly_santibanez.py``). Here it is about the
printed proof of it; where that breaks, ``scalar.py`` and ``every_function.py`` go round.
"""

from fractions import Fraction
from functools import partial

from lyapcheck.claims import (
    ArmBounds,
    Constant,
    Proof,
    Reals,
    above,
    agrees,
    all_of,
    any_vector,
    below,
    companion,
    constant_goal,
    coriolis_at_rest,
    coriolis_bounded,
    coriolis_matrix,
    damping_below,
    dh,
    diagonal,
    diff,
    every_n,
    expr,
    for_all,
    gamma,
    gravity_bounded,
    gravity_bounds,
    gravity_vector,
    h,
    identity,
    implies,
    lacking,
    loops,
    mass_bounded,
    mass_positive,
    mass_symmetric,
    norm_bound,
    pi,
    potential,
    property_of,
    rate,
    rate_less_twice_coriolis,
    rate_of_mass,
    rho,
    secant_bound,
    sinh,
    sqrt,
    strict,
    torque_limits,
    total,
    var,
    vector,
    zero_vector,
)

proof = Proof(
    "published",
    "A family of hyperbolic-type control schemes for robot manipulators",
    reference="reyes2019family",
    stands="quoted",
)

x = var("x")

proof.section("Section 1: the literature")

PD, PID = "takegaki_arimoto.py", "pid.py"
proof.add(
    "1.PD",
    "PD control with gravity compensation regulates an arm globally",
    companion(PD).theorem,
    "Section 1, [31]",
)
proof.add(
    "1.PID",
    "PID control is asymptotically stable in a region about the goal",
    companion(PID).theorem(),
    "Section 1, [13, 33]",
)


def not_decidable_here(reason):
    """The statement of a sentence that no computation decides."""

    def state():
        raise lacking(f"not decidable here: {reason}")

    return state


proof.add(
    "1.local",
    "for PID control, until now, stability is valid only in a local sense",
    not_decidable_here("what was known at a date is a question to libraries"),
    "Section 1, [13, 33]",
)
proof.add(
    "1.others",
    "what the other works cited show, of their own controllers",
    not_decidable_here("their texts are not part of this paper; proofs/ has some of them"),
    "Section 1, [1] to [34]",
)
proof.add(
    "1.first",
    "the family is the first in joint space that combines bounded hyperbolic functions so",
    not_decidable_here("what was known at a date is a question to libraries"),
    "Section 1",
)

proof.section("Section 2: the robot")


@proof.claim("2.1", "M(q) is symmetric and positive definite for all q", "Property 2.1")
def _(robot):
    return all_of(symmetric=mass_symmetric(robot.fixed()), positive=mass_positive(robot))


proof.add("2.2", "a constant β_M bounds ‖M(q)‖", mass_bounded, "Property 2.2, (2)")


@proof.claim("2.2.strict", "‖M(q)‖ < β_M strictly, as (2) is printed, for some β_M", "(2)")
def _(robot):
    """Below any bound lies every other."""
    N = Reals()
    (shown, more), (size,) = N.positive("shown more"), N.nonnegative("size")
    return all_of(bounded=mass_bounded(robot), larger=N.implies((size <= shown,), size < shown + more))


proof.add("2.3", "C(q, 0) = 0", coriolis_at_rest, "Property 2.3")
proof.add("2.4", "Ṁ(q) = C(q,q̇)ᵀ + C(q,q̇), and both are symmetric", rate_of_mass, "Property 2.4, (3)")
proof.add(
    "2.5", "½ q̇ᵀ[Ṁ − 2C]q̇ = 0, and Ṁ − 2C is skew-symmetric", rate_less_twice_coriolis, "Property 2.5, (4)"
)
proof.add("2.6", "a constant k_c gives ‖C(q,x)y‖ ≤ k_c ‖x‖ ‖y‖", coriolis_bounded, "Property 2.6, (5)")


@proof.claim("2.7", "0 < λmin(B)‖q̇‖² ≤ q̇ᵀBq̇ ≤ λmax(B)‖q̇‖² for q̇ ≠ 0", "Property 2.7")
def _(n, robot):
    B, R = [number.value for number in robot.viscous], Reals()
    w = R.real(" ".join(f"w{i + 1}" for i in range(n)))
    power = total(b_i * w_i**2 for b_i, w_i in zip(B, w, strict=True))
    square = total(w_i**2 for w_i in w)
    return all_of(
        positive=Constant(expr(0) < min(B)),
        from_below=R.implies((), min(B) * square <= power),
        from_above=R.implies((), power <= max(B) * square),
    )


@proof.claim("2.8", "|g_i(q)| ≤ k_gi, so ‖g(q)‖ is bounded", "Property 2.8")
def _(robot):
    return gravity_bounded(robot, None if None in robot.gravity_bound else gravity_bounds(robot))


proof.section("Section 3: the family")

PRINTED_GAMMA = {1: "1", 2: "1.05", 3: "1.11"}


@proof.claim("6", "h_m is odd, continuous, bounded, and zero only at 0", "(6), Fig. 1")
def _(m):
    return all_of(
        odd=identity(h(m, -x), -h(m, x)),
        denominator_never_zero=for_all(expr(0) < 1 + sinh(x) ** (2 * m)),
        bounded_above=for_all(h(m, x) <= "3/2"),
        bounded_below=for_all(expr("-3/2") <= h(m, x)),
        positive_for_positive_x=for_all(expr(0) < h(m, x), 0, open_low=True),
    )


@proof.claim("7g", "the printed γ_m (1, 1.05, 1.11 for m = 1, 2, 3) bounds h_m", "Table 2")
def _(m):
    if m not in PRINTED_GAMMA:
        raise lacking(f"the paper prints no γ for m = {m}; it does for m = 1, 2, 3")
    return for_all(h(m, x) <= PRINTED_GAMMA[m])


@proof.claim("7i", "γ_m < γ_{m+1}: the peak increases with m", "after (7); Section 4")
def _(m):
    return Constant(gamma(m) < gamma(m + 1))


@proof.claim("7p", "γ_m is the peak of h_m: above 1, to which h_m tends", "after (7)")
def _(m):
    return Constant(expr(1) < gamma(m))


@proof.claim("8", "the printed derivative is the derivative of h_m", "(8)")
def _(m):
    return identity(diff(h(m, x), "x"), dh(m, x))


NORMS = (
    # claim, f, its supremum, the power of ‖x‖
    ("7a", "‖h_m(x)‖ ≤ √n γ_m for all x in Rⁿ", "(7), first line", h, gamma, 0, "6"),
    ("7b", "‖h_m(x)‖ ≤ √n γ_m ‖x‖ for all x in Rⁿ", "(7), second line", h, gamma, 1, "6"),
    ("8a", "‖(h_m'(x_i))_i‖ ≤ √n ρ_m", "(8), first line", dh, rho, 0, "8"),
    ("8b", "‖(h_m'(x_i))_i‖ ≤ √n ρ_m ‖x‖", "(8), second line", dh, rho, 1, "8"),
)
for name, says, place, function, largest, power, rests_on in NORMS:

    @proof.claim(name, says, place, uses=[rests_on])
    def _(m, n, f=function, largest=largest, power=power):
        return norm_bound(f(m, x), n, sqrt(n) * largest(m), power)


proof.section("Section 3: torque bounds")

T = Reals()
γ, kp, kv, τ_max = T.positive("gamma kp kv limit")
k_g, norm_h_e, norm_h_w, norm_τ = T.nonnegative("kg norm_h_e norm_h_w tau")
abs_h_e, abs_h_w, abs_g = T.nonnegative("abs_h_e abs_h_w abs_g")


def bound_9(n):
    """‖τ‖ ≤ √n γ λmax(K_p) + √n γ λmax(K_v) + k_g."""
    return norm_τ <= sqrt(n) * γ * kp + sqrt(n) * γ * kv + k_g


@proof.claim("9", "‖τ‖ ≤ √n γ λmax(K_p) + √n γ λmax(K_v) + k_g", "(9)", uses=["7a", "2.8"])
def _(n):
    triangle = norm_τ <= kp * norm_h_e + kv * norm_h_w + k_g
    return T.implies((triangle, norm_h_e <= sqrt(n) * γ, norm_h_w <= sqrt(n) * γ), bound_9(n))


@proof.claim("9.hold", "‖g‖ ≤ ‖τmax‖, by (9), lets the motors hold the arm at rest at every q_d", "after (9)")
def _(n):
    """Joint by joint: the first joint stands for each."""
    N, joints = Reals(), range(1, n + 1)
    g, limit = (N.nonnegative(" ".join(f"{kind}{i}" for i in joints)) for kind in ("abs_g", "limit"))
    norms = total(g_i**2 for g_i in g) <= total(limit_i**2 for limit_i in limit)
    return N.implies((norms,), g[0] ** 2 <= limit[0] ** 2)


@proof.claim("9.hold.arm", "the motors of this arm can hold it at rest at every q_d", "after (9)")
def _(robot):
    rows = zip(robot.joints, gravity_bounds(robot), torque_limits(robot), strict=True)
    return all_of(**{joint: Constant(expr(gravity) <= limit) for joint, gravity, limit in rows})


@proof.claim("10", "λmax(K_p) + λmax(K_v) ≤ (‖τmax‖ − k_g)/(√n γ) implies ‖τ‖ ≤ ‖τmax‖", "(10)", uses=["9"])
def _(n):
    return T.implies((bound_9(n), kp + kv <= (τ_max - k_g) / (sqrt(n) * γ)), norm_τ <= τ_max)


@proof.claim("10j", "condition (10) keeps every joint's torque inside its own limit", "Remark I")
def _(m, n, robot):
    limits, gravity = torque_limits(robot), gravity_bounds(robot)
    norm, bound = (sqrt(total(expr(value) ** 2 for value in values)) for values in (limits, gravity))
    share = (norm - bound) / sqrt(n)
    parts = {}
    for i, joint in enumerate(robot.joints):
        if above(share + gravity[i]) <= limits[i]:
            parts[joint] = bounded_torque(share, gravity[i], limits[i])
        else:
            parts[joint] = actual_torque(m, robot.fixed(), i, share, limits[i])
    return all_of(**parts)


def actual_torque(m, robot, i, share, limit):
    """|τ_i| ≤ its limit at every state, for all gains with k_pi + k_vj ≤ (‖τmax‖ − k_g)/(√n γ)."""
    R, indices = Reals(), range(1, robot.n + 1)
    kp, kv = (R.positive(" ".join(f"{kind}{k}" for k in indices)) for kind in ("kp", "kv"))
    _, e, w = (R.real(" ".join(f"{name}{k}" for k in indices)) for name in "qew")
    torque = kp[i] * h(m, e[i]) - kv[i] * h(m, w[i]) + gravity_vector(robot)[i]
    condition_10 = [kp_i + kv_j <= share / gamma(m) for kp_i in kp for kv_j in kv]
    return implies(tuple(R.known.values()), tuple(condition_10), abs(torque) <= limit)


def bounded_torque(share, gravity, limit):
    """The same from |h| ≤ γ and |g_i| ≤ k_gi, for a joint whose limit is beyond what (10) allows."""
    R = Reals()
    γ, kp, kv, k_g, most, abs_h_e, abs_h_w, abs_g = R.nonnegative(
        "gamma kp kv kg share abs_h_e abs_h_w abs_g"
    )
    given = (abs_h_e <= γ, abs_h_w <= γ, abs_g <= k_g, (kp + kv) * γ <= most)
    return all_of(
        torque=R.implies(given, kp * abs_h_e + kv * abs_h_w + abs_g <= most + k_g),
        limit=Constant(share + gravity <= limit),
    )


@proof.claim(
    "10p",
    "k_pi + k_vi < (τmax_i − k_gi)/(√n γ) implies |τ_i| ≤ τmax_i",
    "Section 4, tuning rule",
    uses=["7a", "2.8"],
    stands="implied",
)
def _(n):
    triangle = norm_τ <= kp * abs_h_e + kv * abs_h_w + abs_g
    rule = kp + kv < (τ_max - k_g) / (sqrt(n) * γ)
    return T.implies((triangle, abs_h_e <= γ, abs_h_w <= γ, abs_g <= k_g, rule), norm_τ <= τ_max)


@proof.claim(
    "10p.gains",
    "the gains at hand meet the per-joint rule with the true γ",
    "Section 4, tuning rule",
    stands="implied",
)
def _(m, n, robot, gains):
    rows = zip(robot.joints, gains.kp, gains.kv, torque_limits(robot), gravity_bounds(robot), strict=True)
    return all_of(
        **{
            joint: Constant(expr(kp_i + kv_i) < (limit - gravity) / (sqrt(n) * gamma(m)))
            for joint, kp_i, kv_i, limit, gravity in rows
        }
    )


proof.section("Section 3: the Lyapunov function")

S = loops.letters()
w, e, h_e, h_w, U, M, C = S.w, S.e, S.h, S.hw, S.U, S.M, S.C
K_p, K_v, B, H = (diagonal(letter) for letter in (S.kp, S.kv, S.b, S.dh))
"""H = diag(h'(e))."""
r, ε0, ε_e, êw = S.r, S.eps0, S.eps, S.along
"""ε_e = ε₀/(1 + r)."""
Mdot = C + C.T


FAMILY, AT_REST = companion("every_function.py"), companion("kelly_santibanez.py")
"""The torque (6) for any function with V of (13), and what it is at rest."""


def V_of(m):
    """V of (13) along (6) with h_m, for any ε₀."""
    return FAMILY.regulator(FAMILY.h_of(m), "any")


@proof.claim("11", "the origin is the only equilibrium", "after (11)", uses=["2.3", "6"])
def _(m):
    """Where q̇ = 0, h(q̃)ᵀMq̈ ≥ λmin(K_p)‖h(q̃)‖²."""
    return property_of(
        "the origin is the only equilibrium", AT_REST.regulator(AT_REST.h_of(m), friction="positive")[2]
    )


V_12 = w @ M @ w / 2 + S.kp @ U - ε_e * h_e @ M @ w + ε_e**2 * h_e @ M @ h_e / 2
TERMS_14 = [
    w @ K_p @ h_e,
    -w @ K_v @ h_w,
    -w @ B @ w,
    -w @ C @ w,
    w @ Mdot @ w / 2,
    -w @ K_p @ h_e,
    ε_e * (H @ w) @ M @ w,
    -ε0 * êw / (1 + r) ** 2 * h_e @ M @ w,
    -ε_e * h_e @ Mdot @ w,
    -ε_e * h_e @ K_p @ h_e,
    ε_e * h_e @ B @ w,
    ε_e * h_e @ K_v @ h_w,
    ε_e * h_e @ C @ w,
    ε_e**2 * h_e @ Mdot @ h_e / 2,
    ε_e**2 * (2 * êw / (1 + r)) * h_e @ M @ h_e / 2,
    -(ε_e**2) * (H @ w) @ M @ h_e,
]
"""In printed order; Ṁ is written C + Cᵀ where the paper does."""


proof.add(
    "12",
    "V of (12) equals (13), for every n",
    every_n(V_12, loops.energy(S), symmetric=[M], positive=[r]),
    "(12), (13)",
)


@proof.claim("12p", "V > 0 away from the origin", "after (13)", uses=["2.1", "6", "12"])
def _(m):
    return property_of("V is positive definite", V_of(m))


@proof.claim("12u", "V is radially unbounded", "after (13)", uses=["2.1", "7a", "12"])
def _(m):
    return property_of("V is radially unbounded", V_of(m))


@proof.claim("12d", "V is differentiable at q̃ = 0, where ‖q̃‖ is not", "(12)", uses=["8"], stands="implied")
def _(m):
    return property_of("V is continuously differentiable", V_of(m))


@proof.claim("14", "(14) is dV/dt along (11), for every n", "(14)", uses=["2.4", "8", "12"])
def _(m):
    """The loop moves the letters; the rate of r = ‖q̃‖ is what the rate of r² says."""
    return all_of(
        potential=identity(diff(potential(m, x), "x"), h(m, x)),
        every_n=loops.along(S, V_12, total(TERMS_14)),
        rate_of_the_norm=loops.along(S, r**2, rate(e @ e)),
    )


@proof.claim(
    "15",
    "(14) becomes (15), for every n: terms 1 and 6, 4 and 5 cancel, 9 and 13 combine",
    "(15)",
    uses=["2.4", "2.5", "14"],
)
def _():
    """What cancels and combines in (14), and that (15) is left."""
    t = TERMS_14
    return all_of(
        terms_1_and_6=every_n(t[0] + t[5], expr(0)),
        terms_4_and_5=every_n(t[3] + t[4], expr(0)),
        terms_9_and_13=every_n(t[8] + t[12], -ε_e * h_e @ C.T @ w, positive=[r]),
        sum=every_n(total(t), total(loops.terms(S)), positive=[r]),
    )


FIRST = Reals()
μ, (y_w, y_h) = FIRST.positive("mu")[0], FIRST.real("w eps_h")


@proof.claim("13.first", "the first term of (13) is positive definite in q̃ and q̇", "after (13)")
def _():
    """In one joint: as ε₀ is any positive number, εh(q̃) is any real one."""
    return FIRST.implies((expr(0) < y_w**2 + y_h**2,), expr(0) < μ * (y_w - y_h) ** 2 / 2)


proof.section("Section 3: the bounds of (16)")

R = Reals()
γ, ρ, kp, kv, b, β, k_c, ε0, share = R.positive("gamma rho kp kv b beta kc eps0 share")
(more,) = R.nonnegative("more")
ε, b_max, norm_e, norm_w = map(var, ("eps", "b_max", "norm_e", "norm_w"))
RANGES = {"eps": ε0 * share, "b_max": b + more}
"""ε = share·ε₀ with 0 < share ≤ 1, and λmax(B) = λmin(B) + more."""


def bounds_16(n):
    """The eleven bounds of (16), in printed order."""
    return [
        sqrt(n) * γ * kv * norm_w**2,
        -b * norm_w**2,
        ε * sqrt(n) * ρ * β * norm_w**2,
        ε * sqrt(n) * γ * β * norm_w**2,
        ε * sqrt(n) * γ * k_c * norm_w**2,
        -ε * n * γ**2 * kp * norm_e**2,
        ε * sqrt(n) * γ * b_max * norm_e * norm_w,
        ε * n * ρ * γ * kv * norm_e * norm_w,
        ε * ε0 * n * γ**2 * k_c * norm_e * norm_w,
        ε * ε0 * n * γ**2 * β * norm_e * norm_w,
        ε * ε0 * n * γ * ρ * β * norm_e * norm_w,
    ]


def bracket_17(n):
    """√nγλmax(B) + nργλmax(K_v), and the part with ε₀: nγ(γk_c + β_M(γ+ρ))."""
    return sqrt(n) * γ * b_max + n * ρ * γ * kv, n * γ * (γ * k_c + β * (γ + ρ))


def theta(n):
    """θ11, θ12, θ22 of (16)."""
    flat, steep = bracket_17(n)
    low = b - sqrt(n) * (γ * kv + ε * (β * (ρ + γ) + γ * k_c))
    return ε * n * γ**2 * kp, -ε / 2 * (flat + ε0 * steep), low


def minus_form(n):
    """−[‖q̃‖ ‖q̇‖] Θ [‖q̃‖ ‖q̇‖]ᵀ."""
    corner, side, low = theta(n)
    return -(corner * norm_e**2 + 2 * side * norm_e * norm_w + low * norm_w**2)


def with_numbers(m, expression):
    """γ_m and ρ_m for γ and ρ."""
    return expression.at(gamma=gamma(m), rho=rho(m))


Z = loops.short_letters()
"""With letters of their own for ε, s = 1/(1 + ‖q̃‖) and u = q̃/‖q̃‖."""


def secant_of(m):
    """A decimal number above L = sup h(x)/x."""
    return above(secant_bound(m))


def norms(m, n):
    """What (7), (8), L and Properties 2.2, 2.6 and 2.7 say of the letters, and ε ≤ ε₀, 1/(1 + ‖q̃‖) ≤ 1."""
    L = secant_of(m)
    return {
        "eps": (Z.eps, ε0),
        "s": (Z.s, 1),
        "u": (Z.u, 1),
        "w": (w, norm_w),
        "7a": (h_e, sqrt(n) * gamma(m)),
        "7b": (h_e, sqrt(n) * gamma(m) * norm_e),
        "L": (h_e, L * norm_e),
        "Lw": (h_w, L * norm_w),
        "8a": (H, sqrt(n) * rho(m)),
        "M": (M, β),
        "C": (C, k_c * norm_w),
        "K_v": (K_v, kv),
        "B": (B, b_max),
    }


LEAST = {1: (w @ K_v @ h_w, 0), 2: (w @ B @ w, b * norm_w**2)}
"""K_v ≻ 0 and h has the sign of its argument; λmin(B) of Property 2.7."""


def term_at_most(m, n, k, *known):
    """Term k of (15) is at most its bound in (16), for every n, by norms that are known."""
    least = [LEAST[k]] if k in LEAST else []
    right = with_numbers(m, bounds_16(n)[k - 1])
    return loops.term_at_most(Z, k, right, [norms(m, n)[name] for name in known], least)


def term_6(m, n):
    """The bound on term 6, for any gains: k_pi = λmin(K_p) + c_i with c_i ≥ 0."""
    R, indices = Reals(), range(1, n + 1)
    ε0, kp_min = R.positive("eps0 kp_min")
    c, e = R.nonnegative(" ".join(f"c{i}" for i in indices)), R.real(" ".join(f"e{i}" for i in indices))
    square = total(e_i**2 for e_i in e)
    ε = ε0 / (1 + sqrt(square))
    left = -ε * total((kp_min + c_i) * h(m, e_i) ** 2 for c_i, e_i in zip(c, e, strict=True))
    return R.implies((), left <= -ε * n * gamma(m) ** 2 * kp_min * square)


TERMS = (
    # term, as printed, the norms that bound its letters, what it rests on beside (15)
    (1, "−q̇ᵀK_v h(q̇) ≤ √n γ λmax(K_v)‖q̇‖²", "w", ["6"]),
    (2, "−q̇ᵀBq̇ ≤ −λmin(B)‖q̇‖²", "w", ["2.7"]),
    (3, "ε(h'∘q̇)ᵀMq̇ ≤ ε√n ρ β_M ‖q̇‖²", "8a M w", ["2.2", "8a"]),
    (4, "−ε₀ q̃ᵀq̇/(‖q̃‖(1+‖q̃‖)²) hᵀMq̇ ≤ ε√n γ β_M ‖q̇‖²", "s u 7a M w", ["2.2", "7a"]),
    (5, "−ε hᵀCᵀq̇ ≤ ε√n γ k_c ‖q̇‖²", "7a C w", ["2.6", "7a"]),
    (6, "−ε hᵀK_p h ≤ −ε n γ² λmin(K_p)‖q̃‖²", "", []),
    (7, "ε hᵀBq̇ ≤ ε√n γ λmax(B)‖q̃‖‖q̇‖", "7b B w", ["2.7", "7b"]),
    (8, "ε hᵀK_v h(q̇) ≤ ε n ρ γ λmax(K_v)‖q̃‖‖q̇‖", "L Lw K_v", ["6"]),
    (9, "½ε² hᵀ(C+Cᵀ)h ≤ ε ε₀ n γ² k_c ‖q̃‖‖q̇‖", "eps 7a 7b C", ["2.6", "7a", "7b"]),
    (
        10,
        "ε² q̃ᵀq̇/(‖q̃‖(1+‖q̃‖)) hᵀMh ≤ ε ε₀ n γ² β_M ‖q̃‖‖q̇‖",
        "eps s u w 7a 7b M",
        ["2.2", "7a", "7b"],
    ),
    (11, "−ε²(h'∘q̇)ᵀMh ≤ ε ε₀ n γ ρ β_M ‖q̃‖‖q̇‖", "eps 8a w 7b M", ["2.2", "7b", "8a"]),
)

for k, says, known, rests_on in TERMS:

    @proof.claim(f"16.{k}", says, f"(16), term {k}", uses=[*rests_on, "15"], stands="implied")
    def _(m, n, k=k, known=known):
        """Of term 8 by L = sup h(x)/x, as L² ≤ nργ; the norm of diag(h') is at most that of the vector h'."""
        if k == 6:
            return term_6(m, n)
        term = term_at_most(m, n, k, *known.split())
        if k == 1:
            return all_of(every_summand_is_nonnegative=for_all(expr(0) <= x * h(m, x)), term=term)
        if k == 8:
            return all_of(slope=norm_bound(h(m, x), n, secant_of(m), power=1), term=term)
        return term


@proof.claim(
    "16",
    "dV/dt ≤ −[‖q̃‖ ‖q̇‖] Θ [‖q̃‖ ‖q̇‖]ᵀ",
    "(16)",
    uses=["15", *(f"16.{k}" for k, *_ in TERMS)],
)
def _(m, n):
    """At rest all terms but the sixth vanish; elsewhere the bounds add up to the quadratic form."""
    gain = with_numbers(m, n * γ**2 * kp * norm_e**2)
    rate_16 = with_numbers(m, minus_form(n))
    return all_of(
        at_rest=term_6(m, n),
        the_bounds_add_up=identity(total(bounds_16(n)).at(**RANGES), minus_form(n).at(**RANGES)),
        rate_of_V=loops.rate_at_most(
            Z, rate_16, norms(m, n).values(), [*LEAST.values(), (h_e @ K_p @ h_e, gain)]
        ),
    )


proof.section("Section 3: the conditions on ε₀")


def parts_17(n):
    """N = nγ²λmin(K_p), β_M(ρ+γ) + γk_c, and λmin(B) − √nγλmax(K_v)."""
    return n * γ**2 * kp, β * (ρ + γ) + γ * k_c, b - sqrt(n) * γ * kv


def line_17(n, with_eps0):
    """A line of (17): line 1 has the ε₀ term in its last bracket, line 2 has not."""
    (flat, steep), (whole, inner, slack) = bracket_17(n), parts_17(n)
    last = flat + ε0 * steep if with_eps0 else flat
    return (ε * (whole * inner + last**2 / 4)).at(**RANGES) < whole * slack


def det_positive(n):
    """det Θ > 0."""
    corner, side, low = (entry.at(**RANGES) for entry in theta(n))
    return side**2 < corner * low


LINE_1, LINE_2 = (partial(line_17, with_eps0=yes) for yes in (True, False))
IMPLICATIONS = (
    ("17a", "the first line of (17) implies det Θ > 0", "quoted", LINE_1, det_positive),
    ("17b", "det Θ > 0 implies the first line of (17)", "ours", det_positive, LINE_1),
    ("17c", "the second line of (17) implies the first", "implied", LINE_2, LINE_1),
    ("17d", "the first line of (17) implies the second", "quoted", LINE_1, LINE_2),
    ("18", "every ε₀ in (18) makes Θ positive definite", "implied", LINE_2, det_positive),
)
"""(18) is the second line of (17), solved for ε; Θ ≻ 0 needs det Θ > 0."""

for name, says, stands, given, conclusion in IMPLICATIONS:

    @proof.claim(name, says, f"({name[:2]})", stands=stands)
    def _(n, given=given, conclusion=conclusion):
        return implies(tuple(R.known.values()), (share <= 1, given(n)), conclusion(n))


def end_18(n):
    """The end of the range of ε₀ in (18)."""
    (flat, _), (whole, inner, slack) = bracket_17(n), parts_17(n)
    return whole * slack / (whole * inner + flat**2 / 4)


def condition_19(n, **numbers):
    """λmax(K_v) < λmin(B)/(√n γ)."""
    return kv.at(**numbers) < (b / (sqrt(n) * γ)).at(**numbers)


@proof.claim(
    "12.any",
    "ε₀ is any positive number: given (19), each makes Θ positive definite",
    "(12)",
    stands="implied",
)
def _(n):
    return implies(tuple(R.known.values()), (share <= 1, condition_19(n)), det_positive(n))


@proof.claim("18e", "given (19), some ε₀ > 0 makes Θ positive definite", "(18), (19)")
def _(n):
    corner = theta(n)[0].at(**RANGES)
    return all_of(
        corner=R.for_small("eps0", expr(0) < corner, (condition_19(n),), "share"),
        determinant=R.for_small("eps0", det_positive(n), (condition_19(n),), "share"),
    )


@proof.claim("19", "(18) is non-empty ⇔ λmax(K_v) < λmin(B)/(√n γ)", "(19)")
def _(n):
    not_empty, everything = expr(0) < end_18(n).at(**RANGES), tuple(R.known.values())
    return all_of(
        sufficient=implies(everything, (condition_19(n),), not_empty),
        necessary=implies(everything, (not_empty,), condition_19(n)),
    )


@proof.claim(
    "19n",
    "(19) is necessary: gains that break it admit no ε₀ > 0 with dV/dt < 0",
    "after (19)",
    stands="ours",
)
def _(m, n, robot, gains):
    """For the gains at hand and all gains with another multiple of their K_v."""
    least = min(number.value for number in robot.viscous)
    return damping_below(robot.fixed(), gains, least / (sqrt(n) * gamma(m)))


def numbers_at_hand(m, robot, gains):
    """The constants of Θ for the robot and gains at hand; ε₀ and ε are left to the claim."""
    arm = ArmBounds(robot)
    known = {"kp": min(gains.kp), "kv": max(gains.kv), "b": arm.b_min, "b_max": arm.b_max}
    return known | {"beta": arm.beta, "kc": arm.kc, "gamma": gamma(m), "rho": rho(m)}


@proof.claim(
    "18.gains",
    "for the gains at hand, with bounds of β_M and k_c, every ε₀ in (18) makes Θ positive definite",
    "(18)",
    stands="implied",
)
def _(m, n, robot, gains):
    """At q̃ = 0, where ε = ε₀ is largest, for ε₀ = x times the end of (18), 0 < x < 1."""
    here = numbers_at_hand(m, robot, gains)
    parts = (*bracket_17(n), *parts_17(n), x * end_18(n))
    flat, steep, whole, inner, slack, ε0 = (part.at(**here) for part in parts)
    if below(slack) <= 0:
        raise lacking("(18) is empty for these gains, as (19) does not hold; take a smaller K_v")
    low = slack - sqrt(n) * ε0 * inner
    return for_all(ε0 / 4 * (flat + ε0 * steep) ** 2 < whole * low, 0, 1, open_low=True, open_high=True)


@proof.claim("19.gains", "the gains at hand meet (19) with the true γ", "(19)", stands="implied")
def _(m, n, robot, gains):
    return Constant(condition_19(n, **numbers_at_hand(m, robot, gains)))


@proof.claim(
    "P",
    "the origin is globally asymptotically stable",
    "Proposition",
    uses=["11", "12d", "12p", "12u", "h.bounds", "16", "18e"],
)
def _(m):
    """By Θ of (16): h_reach is √nγ; with decimals for γ_m and ρ_m."""
    family, goal = companion("every_function.py"), constant_goal("positive")
    loop, V, lower, (h_e, _, K_p, K_v) = family.closed_loop(goal, family.h_of(m))
    B, β, k_c, reach, a, b = goal.B, goal.beta, goal.kc, h_e.reach, *map(family.norm, (goal.e, goal.w))
    ε0, ε, steep = goal.eps0, goal.eps0 * goal.s, reach * above(rho(m)) / above(gamma(m))
    side = reach * (B.max + steep * K_v.max + ε0 * (reach * k_c + β * (reach + steep)))
    low = B.min - reach * K_v.max - ε * (β * (steep + reach) + reach * k_c)
    form = ε * reach**2 * K_p.min * a**2 - ε * side * a * b + low * b**2
    return strict(loop, V, rate=form, where=[reach * K_v.max < B.min], small=True, **lower)


proof.add(
    "P.strict",
    "dV/dt is negative definite because V > 0 and dV/dt < 0 are satisfied",
    not_decidable_here(
        "the sentence gives what it concludes as its reason; dV/dt < 0 is claim 16, and scalar.py proves it"
    ),
    "after (19)",
)

proof.section("Section 4: Tables 1 and 2")

JOINTS = ("base", "shoulder", "elbow")
TABLE_1 = {"base": "50", "shoulder": "150", "elbow": "15"}
GRAVITY = {"base": "0", "shoulder": "40.28", "elbow": "1.81"}
VISCOUS_MIN = "0.406"
TABLE_2 = {
    # torque limits, K_p, K_v
    "m1": (("50", "150", "15"), ("28", "60", "5"), ("0.233",) * 3),
    "m2": (("50", "150", "150"), ("27", "50", "5"), ("0.223",) * 3),
    "m3": (("50", "150", "15"), ("25", "50", "5"), ("0.223",) * 3),
    "pd": (("50", "150", "50"), ("0.8", "2.5", "0.133"), ("0.4", "0.75", "0.01")),
}
PD_ALPHA = ("0.5", "0.3", "0.06")
INITIAL_ERROR = ("45", "45", "90")  # degrees

for name, (torque, *_) in TABLE_2.items():
    for joint, value in zip(JOINTS, torque, strict=True):
        proof.add(
            f"T1.torque.{name}.{joint}",
            f"Table 2 ({name}) repeats Table 1's torque limit of the {joint}: {value} N·m",
            identity(value, TABLE_1[joint]),
            "Tables 1 and 2",
            stands="implied",
        )


def meets_10p(name, bound):
    """(10p) on every joint of the paper's arm, with a given γ."""
    _, *both = TABLE_2[name]
    limits = {j: (expr(TABLE_1[j]) - GRAVITY[j]) / (sqrt(3) * bound) for j in JOINTS}
    rows = zip(JOINTS, *both, strict=True)
    return all_of(**{j: Constant(expr(kp_i) + kv_i < limits[j]) for j, kp_i, kv_i in rows})


for m in (1, 2, 3):
    largest = max(TABLE_2[f"m{m}"][2], key=Fraction)
    for source, bound in (("printed", expr(PRINTED_GAMMA[m])), ("true", gamma(m))):
        proof.add(
            f"T2.10p.m{m}.{source}",
            f"the gains of m{m} meet the per-joint rule with the {source} γ_{m}",
            meets_10p(f"m{m}", bound),
            "Section 4, Table 2",
            stands="implied",
        )
        proof.add(
            f"T2.19.m{m}.{source}",
            f"λmax(K_v) = {largest} of m{m} meets (19) with the {source} γ_{m}",
            Constant(expr(largest) < expr(VISCOUS_MIN) / (sqrt(3) * bound)),
            "(19), Table 2",
            stands="implied",
        )

_, PD_KP, PD_KV = TABLE_2["pd"]
for joint, k, error in zip(JOINTS, PD_KP, INITIAL_ERROR, strict=True):
    proof.add(
        f"T2.pd.{joint}",
        f"the PD gain of the {joint} meets k_p = {k} < (τmax − k_g)/{error}°",
        Constant(expr(k) < (expr(TABLE_1[joint]) - GRAVITY[joint]) / error),
        "Section 4, Table 2",
    )

for joint, k, v, alpha in zip(JOINTS, PD_KP, PD_KV, PD_ALPHA, strict=True):
    proof.add(
        f"T2.pdkv.{joint}",
        f"the PD damping of the {joint} is k_v = α k_p: {v} = {alpha}·{k}",
        agrees(var("alpha") * var("kp"), v, alpha=alpha, kp=k),
        "Table 2",
    )

proof.section("Section 4: norms, percentages and figures")

STEADY = {
    "m1": ("-0.5774", "0.1272", "-0.051", "0.5934"),
    "m2": ("-0.1849", "0.4876", "0.1867", "0.5539"),
    "m3": ("-0.3717", "0.3009", "0.2024", "0.5193"),
    "pd": ("-0.2566", "-0.7238", "-0.8646", "1.1564"),
}
for name, (*errors, norm) in STEADY.items():
    proof.add(
        f"S4.norm.{name}",
        f"the steady-state error of {name} has norm {norm}°",
        agrees(
            sqrt(total(e_i**2 for e_i in vector("e", 3))),
            norm,
            **{f"e{i}": value for i, value in enumerate(errors, 1)},
        ),
        "Section 4",
    )

SETTLING = ("1.4", "0.994", "0.997", "0.929", "0.892", "0.923", "0.867", "1.14", "0.959", "0.952")
proof.add(
    "S4.period",
    "the sampling period, 2.5 ms, is less than 10 % of every settling time that is printed",
    all_of(**{f"of_{k}": Constant(expr("0.0025") < expr(s) / 10) for k, s in enumerate(SETTLING, 1)}),
    "Section 4",
)

L2 = {"m1": "25.4006", "m2": "24.6892", "m3": "23.4006", "pd": "27.8546"}
ratio = var("L2") / var("L2_pd")


def near(value, printed, by):
    """A number is a printed one, or at most so far from it."""
    return all_of(above=Constant(expr(printed) - by <= value), below=Constant(value <= expr(printed) + by))


for name, percent in (("m1", "8"), ("m3", "16")):
    proof.add(
        f"S4.percent.{name}",
        f"{name} improves the L2 index of the PD by roughly {percent} %, that is to one part in a hundred",
        near(100 * (1 - expr(L2[name]) / L2["pd"]), percent, 1),
        "Section 4",
    )
proof.add(
    "S4.percent.m2",
    "m2 improves the L2 index of the PD by 11.36 %",
    agrees(100 * (1 - ratio), "11.36", L2=L2["m2"], L2_pd=L2["pd"]),
    "Section 4",
)
proof.add(
    "S4.ratio.m3",
    "the L2 index of m3 is 84 % of that of the PD",
    agrees(100 * ratio, "84", L2=L2["m3"], L2_pd=L2["pd"]),
    "Section 4",
)

FIGURES = (
    # figure, gains, joint, torque at the start
    ("4", "m1", "base", "30.82"),
    ("4", "m1", "shoulder", "78.69"),
    ("4", "m1", "elbow", "9.17"),
    ("6", "m2", "shoulder", "126.33"),
    ("6", "m2", "elbow", "10.12"),
    ("8", "m3", "shoulder", "122.16"),
    ("10", "pd", "base", "40"),
    ("10", "pd", "shoulder", "120"),
    ("10", "pd", "elbow", "12"),
)
READING = "2"
"""N·m by which a torque may be misread in a plot."""


def response(name, joint):
    """h_m of the first error, or the error itself in degrees."""
    degrees = expr(INITIAL_ERROR[JOINTS.index(joint)])
    return degrees if name == "pd" else h(int(name[1]), degrees * pi / 180)


for figure, name, joint, torque in FIGURES:
    gain = TABLE_2[name][1][JOINTS.index(joint)]
    proof.add(
        f"F.{figure}.{joint}",
        f"Fig. {figure} starts at the torque that Table 2 gives for the {joint}: {torque} N·m, "
        f"read to ± {READING} N·m",
        near(gain * response(name, joint), torque, READING),
        f"Fig. {figure}",
        stands="implied",
    )
for figure, gains in (("4", ("47", "120", "10")),):
    fits = [(gain, *row[1:]) for row in FIGURES if row[0] == figure for gain in [gains[JOINTS.index(row[2])]]]
    proof.add(
        f"F.{figure}.fit",
        f"gains of {', '.join(gains)} give the torques of Fig. {figure} to ± 0.005 N·m",
        all_of(**{joint: agrees(var("kp") * response(name, joint), at, kp=k) for k, name, joint, at in fits}),
        f"Fig. {figure}",
        stands="ours",
    )
proof.add(
    "F.reach",
    f"Figs. 6 and 8 show torques beyond k_p γ + k_v γ + k_g of Table 2, and {READING} N·m more",
    all_of(
        **{
            f"figure_{f}_{joint}": Constant(
                (expr(TABLE_2[name][1][k]) + TABLE_2[name][2][k]) * gamma(int(name[1]))
                + GRAVITY[joint]
                + READING
                < expr(at)
            )
            for f, name, joint, at in FIGURES
            if f in ("6", "8")
            for k in [JOINTS.index(joint)]
        }
    ),
    "Figs. 6 and 8",
    stands="ours",
)
proof.add(
    "F.limits",
    "the torques that the figures show at the start are inside the limits of Table 1",
    all_of(**{f"figure_{f}_{joint}": Constant(expr(at) <= TABLE_1[joint]) for f, _, joint, at in FIGURES}),
    "Section 4; Remark I",
)
proof.add(
    "F.limits.later",
    "all torques stay inside the limits of Table 1 until the end of each run",
    not_decidable_here("the runs are printed as pictures only; 10p.gains decides it for all motions of (11)"),
    "Section 4; Remark I",
)

proof.section("Section 5: conclusions")


def proportional_torques(m):
    """|k_pi h_m(q̃_i)| in N·m for each joint at the printed final errors, with the printed gains."""
    _, kp, _ = TABLE_2[f"m{m}"]
    rows = zip(kp, STEADY[f"m{m}"], strict=False)
    return [expr(k) * h(m, abs(Fraction(e_i)) * pi / 180) for k, e_i in rows]


def for_each_joint(holds):
    """What holds of a joint's number and of m, from 1 to 2 and from 2 to 3."""
    steps = [(i, k) for i in range(len(JOINTS)) for k in (1, 2)]
    return all_of(**{f"{JOINTS[i]}_from_{k}_to_{k + 1}": Constant(holds(i, k)) for i, k in steps})


def final_error(m, i):
    """|q̃_i| as printed, in degrees."""
    return expr(abs(Fraction(STEADY[f"m{m}"][i])))


FINAL = {m: expr(STEADY[f"m{m}"][3]) for m in (1, 2, 3)}
CONCLUSIONS = (
    (
        "norm",
        "the norm of the steady-state error falls as m grows: 0.5934, 0.5539, 0.5193",
        all_of(from_1_to_2=Constant(FINAL[2] < FINAL[1]), from_2_to_3=Constant(FINAL[3] < FINAL[2])),
    ),
    (
        "joints",
        "so does that of each joint",
        for_each_joint(lambda i, m: final_error(m + 1, i) < final_error(m, i)),
    ),
    (
        "stiffness",
        "as the controllers become stiffer at the goal: K_p h_m(q̃) at the printed final errors grows with m",
        for_each_joint(lambda i, m: proportional_torques(m)[i] < proportional_torques(m + 1)[i]),
    ),
    (
        "grows",
        "at any error up to 45° the same gains give a larger torque for a larger m: h_m(q̃) ≤ h_{m+1}(q̃)",
        lambda m: for_all(h(m, x) <= h(m + 1, x), 0, above(pi / 4)),
    ),
    (
        "flat",
        "the proportional torque at the printed final errors is above 0.28 N·m at the base for m = 1, and at "
        "every joint below 3.1·10⁻⁵ N·m for m = 2 and 3·10⁻¹⁰ N·m for m = 3: less than any dry friction",
        all_of(
            base=Constant(expr("0.28") < proportional_torques(1)[0]),
            **{
                f"m{m}_{joint}": Constant(torque < most)
                for m, most in ((2, "31/1000000"), (3, "3/10000000000"))
                for joint, torque in zip(JOINTS, proportional_torques(m), strict=True)
            },
        ),
    ),
)
for name, says, statement in CONCLUSIONS:
    whose = "quoted" if name == "norm" else "ours"
    proof.add(f"S5.{name}", says, statement, "Section 5", stands=whose)

# Remark II: tracking --------------------------------------------------------------------------------------

proof.adopt("scalar.py", "h.bounds", section="Section 3: the family")
proof.adopt("tracking.py", "21", section="Remark II: tracking by (21)", stands="quoted")
proof.section("Remark II: tracking by (21)")


@proof.claim("21.rest", "if q_d is constant, (21) becomes (6), for every n", "Remark II, (21)")
def _(m):
    """Against any vector z: q̇_d = 0, q̈_d = 0 and dq̃/dt = −q̇, whose h is −h(q̇) by entries."""
    z, still = any_vector("z"), zero_vector()
    h_rate = -h_w
    torque_21 = K_p @ h_e + K_v @ h_rate + M @ still + C @ still + any_vector("g") + B @ still
    return all_of(
        odd=identity(h(m, -x), -h(m, x)),
        every_n=every_n(z @ torque_21, z @ (K_p @ h_e - K_v @ h_w + any_vector("g"))),
    )


@proof.claim(
    "21.torque",
    "the torque C(q, q̇)q̇_d in (21) has a bound: for q = 1 rad and q̇_d = 1 rad/s in every joint it stays "
    "inside the motor's limit, whatever q̇ is",
    "Remark II, (21)",
    stands="ours",
)
def _(n, robot):
    """Where every q̇_i is x thousand rad/s."""
    C_q, here = coriolis_matrix(robot.fixed(), [1000 * x] * n), {f"q{i}": 1 for i in range(1, n + 1)}
    rows = zip(robot.joints, C_q, torque_limits(robot), strict=True)
    return all_of(**{joint: for_all(total(row).at(**here) <= limit) for joint, row, limit in rows})


proof.section("Repairs", stands="ours")

proof.add("R.7b", "‖h_m(x)‖ ≤ L_m‖x‖", lambda m, n: norm_bound(h(m, x), n, secant_of(m), power=1), "(7)")
ROUNDED_UP = {1: "1", 2: "1.054", 3: "1.115"}


@proof.claim("R.7g", "γ_m rounded up (1, 1.054, 1.115 for m = 1, 2, 3) bounds h_m", "Table 2")
def _(m):
    if m not in ROUNDED_UP:
        raise lacking(f"the repair names no γ for m = {m}; it does for m = 1, 2, 3")
    return for_all(h(m, x) <= ROUNDED_UP[m])


@proof.claim("R.8b", "‖(h_m'(x_i))_i‖ ≤ √n ρ_m ‖x‖ for m ≥ 2 and n ≥ 2", "(8), second line")
def _(m, n):
    if m < 2 or n < 2:
        raise lacking("the repair is for m ≥ 2 and n ≥ 2; 8b says what becomes of the others")
    return norm_bound(dh(m, x), n, sqrt(n) * rho(m), 1)


@proof.claim(
    "R.9.hold", "k_gi ≤ τmax_i in each joint: its motor can hold the arm at rest at every q_d", "(9)"
)
def _():
    return T.implies((abs_g <= k_g, k_g <= τ_max), abs_g <= τ_max)


@proof.claim("R.16.6", "−ε hᵀK_p h ≤ −ε λmin(K_p)‖h‖², for every n", "(16), term 6")
def _():
    size = var("a")
    return loops.term_at_most(Z, 6, -Z.eps * kp * size**2, [(h_e, size)], [(h_e @ K_p @ h_e, kp * size**2)])


@proof.claim("R.17a", "with √n N[β_M(ρ+γ) + γk_c], the first line of (17) says det Θ > 0", "(17)")
def _(n):
    (flat, steep), (whole, inner, slack) = bracket_17(n), parts_17(n)
    line = (ε * (sqrt(n) * whole * inner + (flat + ε0 * steep) ** 2 / 4)).at(**RANGES) < whole * slack
    known = tuple(R.known.values())
    return all_of(
        sufficient=implies(known, (share <= 1, line), det_positive(n)),
        necessary=implies(known, (share <= 1, det_positive(n)), line),
    )


@proof.claim(
    "R.17c", "with 1 for ε₀ in the last bracket, it does so for every ε₀ ≤ 1", "(17), (18)", uses=["R.17a"]
)
def _():
    """The line with 1 gives that of R.17a, whatever its positive parts are."""
    N = Reals()
    whole, flat, steep, right, size, start = N.positive("whole flat steep right size start")

    def line(factor):
        return size * (whole + (flat + factor * steep) ** 2 / 4) < right

    return N.implies((start <= 1, line(1)), line(start))


for m, least in ((2, "0.222"), (3, "0.210")):
    proof.add(
        f"R.19.m{m}",
        f"k_v = {least} meets (19) with the true γ_{m}",
        Constant(expr(least) < expr(VISCOUS_MIN) / (sqrt(3) * gamma(m))),
        "(19), Table 2",
    )
proof.add("R.S5", "h_1 has the slope 1 at the goal", identity(dh(1, 0), 1), "Section 5")
