"""The paper's proof, claim by claim, in the order of the text.

Every claim says what the paper says and states it as data; what comes of it is computed.
Ids follow the numbers of the paper's equations.
"""

from fractions import Fraction
from functools import partial

from lyapcheck.claims import (
    ArmBounds,
    Constant,
    FamilyBounds,
    ForSmall,
    Proof,
    above,
    agrees,
    all_of,
    below,
    bounded,
    coriolis_at_rest,
    damping_below,
    dh,
    diagonal,
    diff,
    dot,
    every_n,
    expr,
    for_all,
    form,
    gamma,
    gravity_vector,
    h,
    identity,
    implies,
    lacking,
    loop_property,
    loops,
    mass_symmetric,
    nonnegative,
    norm_bound,
    pi,
    plus,
    positive,
    potential,
    rate,
    rate_less_twice_coriolis,
    rate_of_mass,
    reals,
    rho,
    scaled,
    secant_bound,
    sinh,
    sqrt,
    theorem,
    total,
    transpose,
    var,
    vector,
)

proof = Proof(
    "published",
    "A family of hyperbolic-type control schemes for robot manipulators, as published",
    reference="reyes2019family",
)

x = var("x")

# Section 2: the robot -------------------------------------------------------------------------------------

ROBOT = "Section 2: the robot"


@proof.claim("2.1", "M(q) is symmetric and positive definite for all q", place="Property 2.1", section=ROBOT)
def _(case):
    return all_of(symmetric=mass_symmetric(case.robot), positive=ArmBounds(case.robot).mass_above())


@proof.claim("2.2", "a constant β_M bounds ‖M(q)‖", place="Property 2.2, (2)", section=ROBOT)
def _(case):
    return ArmBounds(case.robot).mass_below()


@proof.claim("2.3", "C(q, 0) = 0", place="Property 2.3", section=ROBOT)
def _(case):
    return coriolis_at_rest(case.robot)


@proof.claim(
    "2.4", "Ṁ(q) = C(q,q̇)ᵀ + C(q,q̇), and both are symmetric", place="Property 2.4, (3)", section=ROBOT
)
def _(case):
    return rate_of_mass(case.robot)


@proof.claim(
    "2.5", "½ q̇ᵀ[Ṁ − 2C]q̇ = 0, and Ṁ − 2C is skew-symmetric", place="Property 2.5, (4)", section=ROBOT
)
def _(case):
    return rate_less_twice_coriolis(case.robot)


@proof.claim("2.6", "a constant k_c gives ‖C(q,x)y‖ ≤ k_c ‖x‖ ‖y‖", place="Property 2.6, (5)", section=ROBOT)
def _(case):
    return ArmBounds(case.robot).coriolis_below()


@proof.claim("2.7", "0 < λmin(B)‖q̇‖² ≤ q̇ᵀBq̇ ≤ λmax(B)‖q̇‖² for q̇ ≠ 0", place="Property 2.7", section=ROBOT)
def _(case):
    friction = [number.value for number in case.robot.viscous]
    names = [f"w{i + 1}" for i in range(case.n)]
    power = total(b * var(w) ** 2 for b, w in zip(friction, names, strict=True))
    size = total(var(w) ** 2 for w in names)
    return all_of(
        positive=Constant(expr(0) < min(friction)),
        from_below=implies(reals(*names), (), min(friction) * size <= power),
        from_above=implies(reals(*names), (), power <= max(friction) * size),
    )


@proof.claim("2.8", "|g_i(q)| ≤ k_gi, so ‖g(q)‖ is bounded", place="Property 2.8", section=ROBOT)
def _(case):
    robot = case.robot.fixed()
    printed = [None if number is None else number.value for number in robot.gravity_bound]
    gravity = gravity_vector(robot)
    return bounded(gravity) if None in printed else bounded(gravity, printed)


# Section 3: the family ------------------------------------------------------------------------------------

FAMILY = "Section 3: the family"
PRINTED_GAMMA = {1: "1", 2: "1.05", 3: "1.11"}


@proof.claim("6", "h_m is odd, continuous, bounded, and zero only at 0", place="(6), Fig. 1", section=FAMILY)
def _(case):
    m = case.m
    return all_of(
        odd=identity(h(m, -x), -h(m, x)),
        denominator_never_zero=for_all(expr(0) < 1 + sinh(x) ** (2 * m)),
        bounded_above=for_all(h(m, x) <= "3/2"),
        bounded_below=for_all(expr("-3/2") <= h(m, x)),
        positive_for_positive_x=for_all(expr(0) < h(m, x), 0, open_low=True),
    )


@proof.claim("7a", "‖h_m(x)‖ ≤ √n γ_m for all x in Rⁿ", place="(7), first line", section=FAMILY, uses=["6"])
def _(case):
    return norm_bound(h(case.m, x), case.n, sqrt(case.n) * gamma(case.m))


@proof.claim(
    "7b", "‖h_m(x)‖ ≤ √n γ_m ‖x‖ for all x in Rⁿ", place="(7), second line", section=FAMILY, uses=["6"]
)
def _(case):
    return norm_bound(h(case.m, x), case.n, sqrt(case.n) * gamma(case.m), power=1)


@proof.claim(
    "7g", "the printed γ_m (1, 1.05, 1.11 for m = 1, 2, 3) bounds h_m", place="Table 2", section=FAMILY
)
def _(case):
    if case.m not in PRINTED_GAMMA:
        raise lacking(f"the paper prints no γ for m = {case.m}; it does for m = 1, 2, 3")
    return for_all(h(case.m, x) <= PRINTED_GAMMA[case.m])


@proof.claim("7i", "γ_m < γ_{m+1}: the peak increases with m", place="after (7); Section 4", section=FAMILY)
def _(case):
    return Constant(gamma(case.m) < gamma(case.m + 1))


@proof.claim("8", "the printed derivative is the derivative of h_m", place="(8)", section=FAMILY)
def _(case):
    return identity(diff(h(case.m, x), "x"), dh(case.m, x))


@proof.claim("8a", "‖(h_m'(x_i))_i‖ ≤ √n ρ_m", place="(8), first line", section=FAMILY, uses=["8"])
def _(case):
    return norm_bound(dh(case.m, x), case.n, sqrt(case.n) * rho(case.m))


@proof.claim("8b", "‖(h_m'(x_i))_i‖ ≤ √n ρ_m ‖x‖", place="(8), second line", section=FAMILY, uses=["8"])
def _(case):
    return norm_bound(dh(case.m, x), case.n, sqrt(case.n) * rho(case.m), power=1)


# Section 3: torque bounds ---------------------------------------------------------------------------------

TORQUE = "Section 3: torque bounds"
g, kp, kv, kg, limit, size = (var(name) for name in ("gamma", "kp", "kv", "kg", "limit", "tau"))


@proof.claim(
    "9",
    "‖τ‖ ≤ √n γ λmax(K_p) + √n γ λmax(K_v) + k_g",
    place="(9)",
    section=TORQUE,
    uses=["7a", "2.8"],
)
def _(case):
    root = sqrt(case.n)
    ph, vh = var("norm_h_e"), var("norm_h_w")
    triangle = size <= kp * ph + kv * vh + kg
    return implies(
        positive("gamma", "kp", "kv") + nonnegative("kg", "norm_h_e", "norm_h_w", "tau"),
        (triangle, ph <= root * g, vh <= root * g),
        size <= root * g * kp + root * g * kv + kg,
    )


@proof.claim(
    "10",
    "λmax(K_p) + λmax(K_v) ≤ (‖τmax‖ − k_g)/(√n γ) implies ‖τ‖ ≤ ‖τmax‖",
    place="(10)",
    section=TORQUE,
    uses=["9"],
)
def _(case):
    root = sqrt(case.n)
    return implies(
        positive("gamma", "kp", "kv", "limit") + nonnegative("kg", "tau"),
        (size <= root * g * kp + root * g * kv + kg, kp + kv <= (limit - kg) / (root * g)),
        size <= limit,
    )


@proof.claim(
    "10j",
    "condition (10) keeps every joint's torque inside its own limit",
    place="after (10); Remark I",
    section=TORQUE,
)
def _(case):
    numbers = (*case.robot.torque_limit, *case.robot.gravity_bound)
    if None in numbers:
        raise lacking("needs a torque limit and a gravity bound for every joint; add them to the arm file")
    limits = [number.value for number in case.robot.torque_limit]
    gravity = [number.value for number in case.robot.gravity_bound]
    norm, bound = (sqrt(total(expr(value) ** 2 for value in values)) for values in (limits, gravity))
    share = (norm - bound) / sqrt(case.n)
    parts = {}
    for i, joint in enumerate(case.robot.joints):
        inside = above(share + gravity[i]) <= limits[i]
        parts[joint] = bounded_torque(case, i, share) if inside else actual_torque(case, i, share)
    return all_of(**parts)


def actual_torque(case, i, share):
    """|τ_i| ≤ its limit at every state, for all gains with k_pi + k_vj ≤ (‖τmax‖ − k_g)/(√n γ)."""
    n, m = case.n, case.m
    kp, kv, budget = vector("kp", n), vector("kv", n), share / gamma(m)
    gains = positive(*(f"{kind}{k + 1}" for kind in ("kp", "kv") for k in range(n)))
    state = reals(*(f"{name}{k + 1}" for name in "qew" for k in range(n)))
    drive = kp[i] * h(m, var(f"e{i + 1}")) - kv[i] * h(m, var(f"w{i + 1}"))
    torque = drive + gravity_vector(case.robot.fixed())[i]
    given = tuple(p + v <= budget for p in kp for v in kv)
    return implies(gains + state, given, abs(torque) <= case.robot.torque_limit[i].value)


def bounded_torque(case, i, share):
    """The same from |h| ≤ γ and |g_i| ≤ k_gi, for a joint whose limit is beyond what (10) allows."""
    ph, vh, own, most = (var(name) for name in ("abs_h_e", "abs_h_w", "abs_g", "share"))
    names = ("gamma", "kp", "kv", "kg", "share", "abs_h_e", "abs_h_w", "abs_g")
    given = (ph <= g, vh <= g, own <= kg, (kp + kv) * g <= most)
    robot = case.robot
    return all_of(
        torque=implies(nonnegative(*names), given, kp * ph + kv * vh + own <= most + kg),
        limit=Constant(share + robot.gravity_bound[i].value <= robot.torque_limit[i].value),
    )


@proof.claim(
    "10p",
    "k_pi + k_vi < (τmax_i − k_gi)/(√n γ) implies |τ_i| ≤ τmax_i",
    place="Section 4, tuning rule",
    section=TORQUE,
    uses=["7a", "2.8"],
)
def _(case):
    ph, vh, own = var("abs_h_e"), var("abs_h_w"), var("abs_g")
    return implies(
        positive("gamma", "kp", "kv", "limit") + nonnegative("kg", "abs_h_e", "abs_h_w", "abs_g", "tau"),
        (
            size <= kp * ph + kv * vh + own,
            ph <= g,
            vh <= g,
            own <= kg,
            kp + kv < (limit - kg) / (sqrt(case.n) * g),
        ),
        size <= limit,
    )


@proof.claim(
    "10p.gains",
    "the gains at hand meet the per-joint rule with the true γ",
    place="Section 4, tuning rule",
    section=TORQUE,
)
def _(case):
    robot, gains = case.robot, case.gains
    if None in (*robot.torque_limit, *robot.gravity_bound):
        raise lacking("needs a torque limit and a gravity bound for every joint; add them to the arm file")
    if len(gains.kp) != robot.n:
        raise lacking(f"the gains are for {len(gains.kp)} joints, {robot.name} has {robot.n}")
    rows = zip(robot.joints, gains.kp, gains.kv, robot.torque_limit, robot.gravity_bound, strict=True)
    parts = {}
    for joint, kp_i, kv_i, most, gravity in rows:
        budget = (most.value - gravity.value) / (sqrt(case.n) * gamma(case.m))
        parts[joint] = Constant(expr(kp_i + kv_i) < budget)
    return all_of(**parts)


# Section 3: equilibrium and Lyapunov function -------------------------------------------------------------

LYAPUNOV = "Section 3: the Lyapunov function"


@proof.claim(
    "11", "the origin is the only equilibrium", place="after (11)", section=LYAPUNOV, uses=["2.3", "6"]
)
def _(case):
    return loop_property("the origin is the only equilibrium", function_of(case))


def function_of(case):
    """h, h' and U."""
    return h(case.m, x), dh(case.m, x), potential(case.m, x)


def lyapunov_12(s):
    """V as (12) prints it."""
    kinetic = form(s.w, s.M, s.w) / 2
    cross = s.eps * form(s.h, s.M, s.w)
    return kinetic + dot(s.kp, s.U) - cross + s.eps**2 * form(s.h, s.M, s.h) / 2


def terms_14(s):
    """The sixteen terms of (14), in printed order; Ṁ is written C + Cᵀ where the paper does."""
    w, h_e, dw, mass, c, eps, along = s.w, s.h, scaled(s.dh, s.w), s.M, s.C, s.eps, s.along
    rate = plus(c, transpose(c))
    proportional = dot(w, scaled(s.kp, h_e))
    return [
        proportional,
        -dot(w, scaled(s.kv, s.hw)),
        -dot(w, scaled(s.b, w)),
        -form(w, c, w),
        form(w, rate, w) / 2,
        -proportional,
        eps * form(dw, mass, w),
        -s.eps0 * along / (1 + s.r) ** 2 * form(h_e, mass, w),
        -eps * form(h_e, rate, w),
        -eps * dot(h_e, scaled(s.kp, h_e)),
        eps * dot(h_e, scaled(s.b, w)),
        eps * dot(h_e, scaled(s.kv, s.hw)),
        eps * form(h_e, c, w),
        eps**2 * form(h_e, rate, h_e) / 2,
        eps**2 * (2 * along / (1 + s.r)) * form(h_e, mass, h_e) / 2,
        -(eps**2) * form(dw, mass, h_e),
    ]


@proof.claim("12", "V of (12) equals (13), for every n", place="(12), (13)", section=LYAPUNOV)
def _(case):
    s = loops.letters()
    return every_n(lyapunov_12(s), loops.energy(s), symmetric=[s.M], positive=[s.r])


@proof.claim(
    "12p", "V > 0 away from the origin", place="after (13)", section=LYAPUNOV, uses=["2.1", "6", "12"]
)
def _(case):
    """V in the form (13), which is (12) by claim 12."""
    return loop_property("V is positive definite", function_of(case))


@proof.claim("12u", "V is radially unbounded", place="after (13)", section=LYAPUNOV, uses=["2.1", "7a", "12"])
def _(case):
    return loop_property("V is radially unbounded", function_of(case))


@proof.claim(
    "12d", "V is differentiable at q̃ = 0, where ‖q̃‖ is not", place="(12)", section=LYAPUNOV, uses=["8"]
)
def _(case):
    return loop_property("V is continuously differentiable", function_of(case))


@proof.claim(
    "14", "(14) is dV/dt along (11), for every n", place="(14)", section=LYAPUNOV, uses=["2.4", "8", "12"]
)
def _(case):
    """The loop moves the letters; the rate of r = ‖q̃‖ is what the rate of r² says."""
    s = loops.letters()
    return all_of(
        potential=identity(diff(potential(case.m, x), "x"), h(case.m, x)),
        every_n=loops.along(s, lyapunov_12(s), total(terms_14(s))),
        rate_of_the_norm=loops.along(s, s.r**2, rate(dot(s.e, s.e))),
    )


@proof.claim(
    "15",
    "(14) becomes (15), for every n: terms 1 and 6, 4 and 5 cancel, 9 and 13 combine",
    place="(15)",
    section=LYAPUNOV,
    uses=["2.4", "2.5", "14"],
)
def _(case):
    """What cancels and combines in (14), and that (15) is left."""
    s = loops.letters()
    t = terms_14(s)
    equal = partial(every_n, positive=[s.r])
    return all_of(
        terms_1_and_6=every_n(t[0] + t[5], expr(0)),
        terms_4_and_5=every_n(t[3] + t[4], expr(0)),
        terms_9_and_13=equal(t[8] + t[12], -s.eps * form(s.h, transpose(s.C), s.w)),
        sum=equal(total(t), total(loops.terms(s))),
    )


# Section 3: the bounds of (16) ----------------------------------------------------------------------------

BOUNDS = "Section 3: the bounds of (16)"
LETTERS = loops.short_letters()
NORM_E, NORM_W = var("norm_e"), var("norm_w")


def constants(n):
    """The constants of Θ as positive reals; λmax(B) = b + more, and ε = share·ε₀ with 0 < share ≤ 1."""
    c = {name: var(name) for name in ("gamma", "rho", "kp", "kv", "b", "beta", "kc", "eps0", "share")}
    return c | {"n": n, "root": sqrt(n), "b_max": c["b"] + var("more"), "eps": c["eps0"] * c["share"]}


def constants_of(case):
    """The same with the numbers γ_m and ρ_m, and letters for λmax(B) and ε."""
    family = {"gamma": gamma(case.m), "rho": rho(case.m)}
    return constants(case.n) | family | {"b_max": var("b_max"), "eps": var("eps")}


def bounds_16(c):
    """The eleven bounds of (16), in printed order."""
    n, root, gam, rh, eps, eps0 = (c[name] for name in ("n", "root", "gamma", "rho", "eps", "eps0"))
    kv, beta, kc, a, b = c["kv"], c["beta"], c["kc"], NORM_E, NORM_W
    return [
        root * gam * kv * b**2,
        -c["b"] * b**2,
        eps * root * rh * beta * b**2,
        eps * root * gam * beta * b**2,
        eps * root * gam * kc * b**2,
        -eps * n * gam**2 * c["kp"] * a**2,
        eps * root * gam * c["b_max"] * a * b,
        eps * n * rh * gam * kv * a * b,
        eps * eps0 * n * gam**2 * kc * a * b,
        eps * eps0 * n * gam**2 * beta * a * b,
        eps * eps0 * n * gam * rh * beta * a * b,
    ]


def secant_of(case):
    """A decimal number above L = sup h(x)/x."""
    return above(secant_bound(case.m))


def norms(case):
    """What (7), (8), L and Properties 2.2, 2.6 and 2.7 say of the letters, and ε ≤ ε₀, 1/(1 + ‖q̃‖) ≤ 1."""
    s, c = LETTERS, constants_of(case)
    reach, steep = c["root"] * c["gamma"], c["root"] * c["rho"]
    return {
        "eps": (s.eps, c["eps0"]),
        "s": (s.s, 1),
        "u": (s.u, 1),
        "w": (s.w, NORM_W),
        "7a": (s.h, reach),
        "7b": (s.h, reach * NORM_E),
        "L": (s.h, secant_of(case) * NORM_E),
        "Lw": (s.hw, secant_of(case) * NORM_W),
        "8a": (diagonal(s.dh), steep),
        "M": (s.M, c["beta"]),
        "C": (s.C, c["kc"] * NORM_W),
        "K_v": (diagonal(s.kv), c["kv"]),
        "B": (diagonal(s.b), c["b_max"]),
    }


def least_of_1_and_2(case):
    """K_v ≻ 0 and h has the sign of its argument; λmin(B) of Property 2.7."""
    s = LETTERS
    return {
        1: (dot(s.w, scaled(s.kv, s.hw)), 0),
        2: (dot(s.w, scaled(s.b, s.w)), constants_of(case)["b"] * NORM_W**2),
    }


def term_at_most(case, k, *known):
    """Term k of (15) is at most its bound in (16), for every n, by norms that are known."""
    every = norms(case)
    return loops.term_at_most(
        LETTERS, k, bounds_16(constants_of(case))[k - 1], [every[name] for name in known]
    )


def negative_term_at_most(case, k):
    """The same for terms 1 and 2, which are negative."""
    right, least = bounds_16(constants_of(case))[k - 1], least_of_1_and_2(case)[k]
    return loops.term_at_most(LETTERS, k, right, [norms(case)["w"]], [least])


@proof.claim(
    "16.1", "−q̇ᵀK_v h(q̇) ≤ √n γ λmax(K_v)‖q̇‖²", place="(16), term 1", section=BOUNDS, uses=["6", "15"]
)
def _(case):
    return all_of(
        every_summand_is_nonnegative=for_all(expr(0) <= x * h(case.m, x)), term=negative_term_at_most(case, 1)
    )


@proof.claim("16.2", "−q̇ᵀBq̇ ≤ −λmin(B)‖q̇‖²", place="(16), term 2", section=BOUNDS, uses=["2.7", "15"])
def _(case):
    return negative_term_at_most(case, 2)


@proof.claim(
    "16.3", "ε(h'∘q̇)ᵀMq̇ ≤ ε√n ρ β_M ‖q̇‖²", place="(16), term 3", section=BOUNDS, uses=["2.2", "8a", "15"]
)
def _(case):
    """The norm of diag(h') is at most that of the vector h'."""
    return term_at_most(case, 3, "8a", "M", "w")


@proof.claim(
    "16.4",
    "−ε₀ q̃ᵀq̇/(‖q̃‖(1+‖q̃‖)²) hᵀMq̇ ≤ ε√n γ β_M ‖q̇‖²",
    place="(16), term 4",
    section=BOUNDS,
    uses=["2.2", "7a", "15"],
)
def _(case):
    return term_at_most(case, 4, "s", "u", "7a", "M", "w")


@proof.claim(
    "16.5", "−ε hᵀCᵀq̇ ≤ ε√n γ k_c ‖q̇‖²", place="(16), term 5", section=BOUNDS, uses=["2.6", "7a", "15"]
)
def _(case):
    return term_at_most(case, 5, "7a", "C", "w")


def term_6(case):
    """The bound on term 6, for any gains: k_pi = λmin(K_p) + c_i with c_i ≥ 0."""
    e, over = vector("e", case.n), vector("c", case.n)
    size = total(e_i**2 for e_i in e)
    eps, least = var("eps0") / (1 + sqrt(size)), var("kp_min")
    left = -eps * total((least + c) * h(case.m, e_i) ** 2 for c, e_i in zip(over, e, strict=True))
    right = -eps * case.n * gamma(case.m) ** 2 * least * size
    indices = range(1, case.n + 1)
    variables = positive("eps0", "kp_min") + nonnegative(*(f"c{i}" for i in indices))
    return implies(variables + reals(*(f"e{i}" for i in indices)), (), left <= right)


@proof.claim("16.6", "−ε hᵀK_p h ≤ −ε n γ² λmin(K_p)‖q̃‖²", place="(16), term 6", section=BOUNDS, uses=["15"])
def _(case):
    return term_6(case)


@proof.claim(
    "16.7", "ε hᵀBq̇ ≤ ε√n γ λmax(B)‖q̃‖‖q̇‖", place="(16), term 7", section=BOUNDS, uses=["2.7", "7b", "15"]
)
def _(case):
    return term_at_most(case, 7, "7b", "B", "w")


@proof.claim(
    "16.8", "ε hᵀK_v h(q̇) ≤ ε n ρ γ λmax(K_v)‖q̃‖‖q̇‖", place="(16), term 8", section=BOUNDS, uses=["6", "15"]
)
def _(case):
    """By L = sup h(x)/x, as L² ≤ nργ."""
    return all_of(
        slope=norm_bound(h(case.m, x), case.n, secant_of(case), power=1),
        term=term_at_most(case, 8, "L", "Lw", "K_v"),
    )


@proof.claim(
    "16.9",
    "½ε² hᵀ(C+Cᵀ)h ≤ ε ε₀ n γ² k_c ‖q̃‖‖q̇‖",
    place="(16), term 9",
    section=BOUNDS,
    uses=["2.6", "7a", "7b", "15"],
)
def _(case):
    return term_at_most(case, 9, "eps", "7a", "7b", "C")


@proof.claim(
    "16.10",
    "ε² q̃ᵀq̇/(‖q̃‖(1+‖q̃‖)) hᵀMh ≤ ε ε₀ n γ² β_M ‖q̃‖‖q̇‖",
    place="(16), term 10",
    section=BOUNDS,
    uses=["2.2", "7a", "7b", "15"],
)
def _(case):
    return term_at_most(case, 10, "eps", "s", "u", "w", "7a", "7b", "M")


@proof.claim(
    "16.11",
    "−ε²(h'∘q̇)ᵀMh ≤ ε ε₀ n γ ρ β_M ‖q̃‖‖q̇‖",
    place="(16), term 11",
    section=BOUNDS,
    uses=["2.2", "7b", "8a", "15"],
)
def _(case):
    return term_at_most(case, 11, "eps", "8a", "w", "7b", "M")


SIXTEEN = [f"16.{k}" for k in range(1, 12)]


@proof.claim(
    "16",
    "dV/dt ≤ −[‖q̃‖ ‖q̇‖] Θ [‖q̃‖ ‖q̇‖]ᵀ",
    place="(16)",
    section=BOUNDS,
    uses=["15", *SIXTEEN],
)
def _(case):
    """At rest all terms but the sixth vanish; elsewhere the bounds add up to the quadratic form."""
    c, of_case, s = constants(case.n), constants_of(case), LETTERS
    gain = of_case["n"] * of_case["gamma"] ** 2 * of_case["kp"] * NORM_E**2
    least = [*least_of_1_and_2(case).values(), (dot(s.h, scaled(s.kp, s.h)), gain)]
    return all_of(
        at_rest=term_6(case),
        the_bounds_add_up=identity(total(bounds_16(c)), minus_form(theta(c))),
        rate_of_V=loops.rate_at_most(s, minus_form(theta(of_case)), norms(case).values(), least),
    )


def minus_form(entries):
    """−[‖q̃‖ ‖q̇‖] Θ [‖q̃‖ ‖q̇‖]ᵀ."""
    corner, side, low = entries
    return -(corner * NORM_E**2 + 2 * side * NORM_E * NORM_W + low * NORM_W**2)


# Section 3: the conditions on ε₀ --------------------------------------------------------------------------

CONDITIONS = "Section 3: the conditions on ε₀"
PARAMETERS = positive("gamma", "rho", "kp", "kv", "b", "beta", "kc", "eps0", "share") + nonnegative("more")


def bracket(c):
    """√nγλmax(B) + nργλmax(K_v), and the part with ε₀: nγ(γk_c + β_M(γ+ρ))."""
    flat = c["root"] * c["gamma"] * c["b_max"] + c["n"] * c["rho"] * c["gamma"] * c["kv"]
    return flat, c["n"] * c["gamma"] * (c["gamma"] * c["kc"] + c["beta"] * (c["gamma"] + c["rho"]))


def theta(c):
    """θ11, θ12, θ22 of (16)."""
    flat, steep = bracket(c)
    inner = c["beta"] * (c["rho"] + c["gamma"]) + c["gamma"] * c["kc"]
    corner = c["eps"] * c["n"] * c["gamma"] ** 2 * c["kp"]
    low = c["b"] - c["root"] * (c["gamma"] * c["kv"] + c["eps"] * inner)
    return corner, -c["eps"] / 2 * (flat + c["eps0"] * steep), low


def line_17(c, with_eps0):
    """A line of (17): line 1 has the ε₀ term in its last bracket, line 2 has not."""
    flat, steep = bracket(c)
    whole = c["n"] * c["gamma"] ** 2 * c["kp"]
    inner = c["beta"] * (c["rho"] + c["gamma"]) + c["gamma"] * c["kc"]
    last = flat + c["eps0"] * steep if with_eps0 else flat
    return c["eps"] * (whole * inner + last**2 / 4) < whole * (c["b"] - c["root"] * c["gamma"] * c["kv"])


def determinant_positive(c):
    """det Θ > 0."""
    corner, side, low = theta(c)
    return side**2 < corner * low


SHARE = var("share") <= 1


@proof.claim("17a", "the first line of (17) implies det Θ > 0", place="(17)", section=CONDITIONS)
def _(case):
    c = constants(case.n)
    return implies(PARAMETERS, (SHARE, line_17(c, True)), determinant_positive(c))


@proof.claim("17b", "det Θ > 0 implies the first line of (17)", place="(17)", section=CONDITIONS)
def _(case):
    c = constants(case.n)
    return implies(PARAMETERS, (SHARE, determinant_positive(c)), line_17(c, True))


@proof.claim("17c", "the second line of (17) implies the first", place="(17)", section=CONDITIONS)
def _(case):
    c = constants(case.n)
    return implies(PARAMETERS, (SHARE, line_17(c, False)), line_17(c, True))


@proof.claim("17d", "the first line of (17) implies the second", place="(17)", section=CONDITIONS)
def _(case):
    c = constants(case.n)
    return implies(PARAMETERS, (SHARE, line_17(c, True)), line_17(c, False))


@proof.claim("18", "every ε₀ in (18) makes Θ positive definite", place="(18)", section=CONDITIONS)
def _(case):
    """(18) is the second line of (17), solved for ε; Θ ≻ 0 needs det Θ > 0."""
    c = constants(case.n)
    return implies(PARAMETERS, (SHARE, line_17(c, False)), determinant_positive(c))


def condition_19(c):
    """λmax(K_v) < λmin(B)/(√n γ)."""
    return c["kv"] < c["b"] / (c["root"] * c["gamma"])


@proof.claim(
    "18e", "given (19), some ε₀ > 0 makes Θ positive definite", place="(18), (19)", section=CONDITIONS
)
def _(case):
    c = constants(case.n)
    others = tuple(v for v in PARAMETERS if v.name not in ("eps0", "share"))
    given = (condition_19(c),)
    corner, _, _ = theta(c)
    return all_of(
        corner=ForSmall("eps0", others, given, expr(0) < corner, ("share",)),
        determinant=ForSmall("eps0", others, given, determinant_positive(c), ("share",)),
    )


@proof.claim("19", "(18) is non-empty ⇔ λmax(K_v) < λmin(B)/(√n γ)", place="(19)", section=CONDITIONS)
def _(case):
    c = constants(case.n)
    flat, _ = bracket(c)
    whole = c["n"] * c["gamma"] ** 2 * c["kp"]
    inner = c["beta"] * (c["rho"] + c["gamma"]) + c["gamma"] * c["kc"]
    upper = whole * (c["b"] - c["root"] * c["gamma"] * c["kv"]) / (whole * inner + flat**2 / 4)
    return all_of(
        sufficient=implies(PARAMETERS, (condition_19(c),), expr(0) < upper),
        necessary=implies(PARAMETERS, (expr(0) < upper,), condition_19(c)),
    )


@proof.claim(
    "19n",
    "(19) is necessary: gains that break it admit no ε₀ > 0 with dV/dt < 0",
    place="after (19)",
    section=CONDITIONS,
)
def _(case):
    """For the gains at hand and all gains with another multiple of their K_v."""
    least = min(number.value for number in case.robot.viscous)
    return damping_below(case.robot.fixed(), case.gains, least / (sqrt(case.n) * gamma(case.m)))


def numbers_at_hand(case):
    """The constants of Θ for the robot and gains at hand; ε₀ and ε are left to the claim."""
    if len(case.gains.kp) != case.robot.n:
        raise lacking(f"the gains are for {len(case.gains.kp)} joints, {case.robot.name} has {case.robot.n}")
    arm, n = ArmBounds(case.robot), case.n
    known = {"kp": min(case.gains.kp), "kv": max(case.gains.kv), "b": arm.b_min, "b_max": arm.b_max}
    known |= {"beta": arm.beta, "kc": arm.kc, "n": n, "root": sqrt(n)}
    return {name: expr(value) for name, value in known.items()} | {
        "gamma": gamma(case.m),
        "rho": rho(case.m),
    }


@proof.claim(
    "18.gains",
    "for the gains at hand, with bounds of β_M and k_c, every ε₀ in (18) makes Θ positive definite",
    place="(18)",
    section=CONDITIONS,
)
def _(case):
    """At q̃ = 0, where ε = ε₀ is largest, for ε₀ = x times the end of (18), 0 < x < 1."""
    c = numbers_at_hand(case)
    flat, steep = bracket(c)
    whole = c["n"] * c["gamma"] ** 2 * c["kp"]
    inner = c["beta"] * (c["rho"] + c["gamma"]) + c["gamma"] * c["kc"]
    slack = c["b"] - c["root"] * c["gamma"] * c["kv"]
    if below(slack) <= 0:
        raise lacking("(18) is empty for these gains, as (19) does not hold; take a smaller K_v")
    eps0 = x * whole * slack / (whole * inner + flat**2 / 4)
    low = slack - c["root"] * eps0 * inner
    return for_all(eps0 / 4 * (flat + eps0 * steep) ** 2 < whole * low, 0, 1, open_low=True, open_high=True)


@proof.claim("19.gains", "the gains at hand meet (19) with the true γ", place="(19)", section=CONDITIONS)
def _(case):
    return Constant(condition_19(numbers_at_hand(case)))


@proof.claim(
    "P",
    "the origin is globally asymptotically stable",
    place="Proposition",
    section=CONDITIONS,
    uses=["11", "12d", "12p", "12u", "h.bounds", "16", "18e"],
)
def _(case):
    """By Θ of (16), with decimals for γ_m and ρ_m."""
    known = FamilyBounds(case.n, gamma(case.m), rho(case.m), secant_bound(case.m))
    names = {"gamma": known.gamma, "rho": known.rho, "n": case.n, "root": sqrt(case.n)}
    names |= {name: var(name) for name in ("eps", "eps0", "kp", "b_max", "beta", "kc")}
    form = theta(names | {"kv": var("kv_max"), "b": var("b_min")})
    return theorem(
        "Lyapunov's direct method",
        known.loop(function_of(case), form),
        only_equilibrium="11",
        differentiable="12d",
        positive_definite="12p",
        radially_unbounded="12u",
        bounds_of_h="h.bounds",
        rate_bounded_by_a_form="16",
        form_negative_definite="18e",
    )


# Section 4: tables, figures and percentages ---------------------------------------------------------------

TABLES = "Section 4: Tables 1 and 2"
ARITHMETIC = "Section 4: norms, percentages and figures"
JOINTS = ("base", "shoulder", "elbow")
TABLE_1 = {"base": "50", "shoulder": "150", "elbow": "15"}
GRAVITY = {"base": "0", "shoulder": "40.28", "elbow": "1.81"}
VISCOUS_MIN = "0.406"
SETS = {"m1": 1, "m2": 2, "m3": 3}
TABLE_2_TORQUE = {
    "m1": ("50", "150", "15"),
    "m2": ("50", "150", "150"),
    "m3": ("50", "150", "15"),
    "pd": ("50", "150", "50"),
}
TABLE_2_KP = {"m1": ("28", "60", "5"), "m2": ("27", "50", "5"), "m3": ("25", "50", "5")}
TABLE_2_KV = {"m1": ("0.233",) * 3, "m2": ("0.223",) * 3, "m3": ("0.223",) * 3}
PD_KP = ("0.8", "2.5", "0.133")
PD_KV = ("0.4", "0.75", "0.01")
PD_ALPHA = ("0.5", "0.3", "0.06")
INITIAL_ERROR = ("45", "45", "90")  # degrees

for name, printed in TABLE_2_TORQUE.items():
    for joint, value in zip(JOINTS, printed, strict=True):
        proof.add(
            f"T1.torque.{name}.{joint}",
            f"Table 2 ({name}) repeats Table 1's torque limit of the {joint}: {value} N·m",
            identity(value, TABLE_1[joint]),
            place="Tables 1 and 2",
            section=TABLES,
        )


def meets_10p(name, bound):
    """(10p) on every joint of the paper's arm, with a given γ."""
    rows = zip(JOINTS, TABLE_2_KP[name], TABLE_2_KV[name], strict=True)
    limits = {j: (expr(TABLE_1[j]) - GRAVITY[j]) / (sqrt(3) * bound) for j in JOINTS}
    return all_of(**{j: Constant(expr(kp_i) + kv_i < limits[j]) for j, kp_i, kv_i in rows})


for name, m in SETS.items():
    for source, bound in (("printed", expr(PRINTED_GAMMA[m])), ("true", gamma(m))):
        largest = max(TABLE_2_KV[name], key=Fraction)
        proof.add(
            f"T2.10p.{name}.{source}",
            f"the gains of {name} meet the per-joint rule with the {source} γ_{m}",
            meets_10p(name, bound),
            place="Section 4, Table 2",
            section=TABLES,
        )
        proof.add(
            f"T2.19.{name}.{source}",
            f"λmax(K_v) = {largest} of {name} meets (19) with the {source} γ_{m}",
            Constant(expr(largest) < expr(VISCOUS_MIN) / (sqrt(3) * bound)),
            place="(19), Table 2",
            section=TABLES,
        )

for joint, k, error in zip(JOINTS, PD_KP, INITIAL_ERROR, strict=True):
    proof.add(
        f"T2.pd.{joint}",
        f"the PD gain of the {joint} meets k_p = {k} < (τmax − k_g)/{error}°",
        Constant(expr(k) < (expr(TABLE_1[joint]) - GRAVITY[joint]) / error),
        place="Section 4, Table 2",
        section=TABLES,
    )

for joint, k, v, share in zip(JOINTS, PD_KP, PD_KV, PD_ALPHA, strict=True):
    proof.add(
        f"T2.pdkv.{joint}",
        f"the PD damping of the {joint} is k_v = α k_p: {v} = {share}·{k}",
        agrees(var("alpha") * var("kp"), v, alpha=share, kp=k),
        place="Table 2",
        section=TABLES,
    )

STEADY = {
    "m1": (("-0.5774", "0.1272", "-0.051"), "0.5934"),
    "m2": (("-0.1849", "0.4876", "0.1867"), "0.5539"),
    "m3": (("-0.3717", "0.3009", "0.2024"), "0.5193"),
    "pd": (("-0.2566", "-0.7238", "-0.8646"), "1.1564"),
}
for name, (components, norm) in STEADY.items():
    proof.add(
        f"S4.norm.{name}",
        f"the steady-state error of {name} has norm {norm}°",
        agrees(
            sqrt(total(var(f"e{i}") ** 2 for i in (1, 2, 3))),
            norm,
            **{f"e{i + 1}": value for i, value in enumerate(components)},
        ),
        place="Section 4",
        section=ARITHMETIC,
    )

L2 = {"m1": "25.4006", "m2": "24.6892", "m3": "23.4006", "pd": "27.8546"}
ratio = var("L2") / var("L2_pd")
for name, percent in (("m1", "8"), ("m2", "11.36"), ("m3", "16")):
    proof.add(
        f"S4.percent.{name}",
        f"{name} improves the L2 index of the PD by {percent} %",
        agrees(100 * (1 - ratio), percent, L2=L2[name], L2_pd=L2["pd"]),
        place="Section 4",
        section=ARITHMETIC,
    )
proof.add(
    "S4.ratio.m3",
    "the L2 index of m3 is 84 % of that of the PD",
    agrees(100 * ratio, "84", L2=L2["m3"], L2_pd=L2["pd"]),
    place="Section 4",
    section=ARITHMETIC,
)

FIGURES = (
    ("4", 1, "base", "30.82"),
    ("4", 1, "shoulder", "78.69"),
    ("4", 1, "elbow", "9.17"),
    ("6", 2, "shoulder", "126.33"),
    ("6", 2, "elbow", "10.12"),
    ("8", 3, "shoulder", "122.16"),
    ("10", None, "base", "40"),
    ("10", None, "shoulder", "120"),
    ("10", None, "elbow", "12"),
)
for figure, m, joint, torque in FIGURES:
    index = JOINTS.index(joint)
    degrees = expr(INITIAL_ERROR[index])
    gain = PD_KP[index] if m is None else TABLE_2_KP[f"m{m}"][index]
    response = degrees if m is None else h(m, degrees * pi / 180)
    proof.add(
        f"F.{figure}.{joint}",
        f"Fig. {figure} starts at the torque that Table 2 gives for the {joint}: {torque} N·m",
        agrees(var("kp") * response, torque, solve_for="kp", kp=gain),
        place=f"Fig. {figure}",
        section=ARITHMETIC,
    )

# Remark II: tracking --------------------------------------------------------------------------------------

proof.adopt("scalar.py", "h.bounds", section=FAMILY)
proof.adopt("tracking.py", "21", section="Remark II: tracking by (21)")
