"""Global asymptotic stability from norms alone: Θ' in a = ‖h(q̃)‖ and b = ‖q̇‖, for any gains.

The paper bounds dV/dt by a form in ‖q̃‖ and ‖q̇‖ and loses the first term, −q̇ᵀK_v h(q̇), to a bound of the
wrong sign; what is left needs small K_v and is not true far from the origin. In a and b every bound holds,
the first term only helps, and the form is

    dV/dt ≤ −[a b] Θ' [a b]ᵀ,   θ'11 = ε k,   θ'22 = λmin(B) − ε c,   θ'12 = −½ ε (d + ε c),
    k = λmin(K_p),   d = λmax(B) + L λmax(K_v),   c = β_M (ρ + G) + √nγ k_c,   G = √nγ L/(√nγ + L).

The section "Every arm" concludes for all robots with Properties 2.1 to 2.7 and all positive gains, "This arm"
for the robot and the gains at hand, with numbers for β_M, k_c and ε₀.

That all positive gains do is classical by LaSalle's theorem, even without friction (``kelly_santibanez.py``).
What is shown here is that V of (13) is strict, with explicit constants; the second reference has strict
functions for such laws with linear damping. For m ≥ 2, h'(0) = 0, so near the goal convergence is not
exponential. For every n and every function at once it is in ``every_function.py``.

References: ``reyes2019family``, ``santibanez1997strict``, ``takegaki1981feedback``.
"""

from fractions import Fraction

from lyapcheck.claims import (
    ArmBounds,
    Constant,
    FamilyBounds,
    Proof,
    above,
    all_of,
    at_arm,
    companion,
    coriolis_matrix,
    decreasing,
    dh,
    diff,
    dot,
    expr,
    for_all,
    form,
    gamma,
    h,
    identity,
    implies,
    lacking,
    largest_with,
    loops,
    mass_matrix,
    nonnegative,
    norm_bound,
    pi,
    plus,
    positive,
    potential,
    property_of,
    rate,
    rate_at_most,
    rate_definite,
    rate_of,
    rho,
    secant_bound,
    sqrt,
    total,
    transpose,
    var,
    vector,
)

proof = Proof(
    "scalar",
    "A scalar certificate: dV/dt < 0 in ‖h(q̃)‖ and ‖q̇‖ for any gains",
    reference="reyes2019family",
)

FAMILY = companion("every_function.py")
"""The torque (6), V of (13) and the bound of its rate, for any function."""
AT_REST = companion("kelly_santibanez.py")
"""The same torque, and what it is at rest."""
x = var("x")
SHARE = Fraction(99, 100)
"""ε₀ as a share of the largest one for which Θ' ≻ 0, rounded to six digits."""


def known_of(m, n):
    """γ, √nγ, ρ, L and G of h_m in decimals."""
    return FamilyBounds(n, gamma(m), rho(m), secant_bound(m))


def function_of(m):
    """h, h' and U."""
    return h(m, x), dh(m, x), potential(m, x)


def form_of(known):
    """θ'11, θ'12, θ'22 in the constants of the loop."""
    names = ("eps", "kp", "b_min", "b_max", "kv_max", "beta", "kc")
    eps, k, b_min, b_max, kv_max, beta, kc = map(var, names)
    return theta(eps, k, b_min, known.drift(beta, kc), known.cross(b_max, kv_max))


def stable_of(m, eps0="some"):
    """The theorem for h_m, for some ε₀, each that is ``given`` with the condition, or ``any``."""
    return FAMILY.regulator(FAMILY.h_of(m), eps0)


def sign_of(m):
    """h is odd and has the sign of its argument."""
    return {
        "odd": identity(h(m, -x), -h(m, x)),
        "positive_right_of_0": for_all(expr(0) < h(m, x), 0, open_low=True),
    }


def slope_of(m, n):
    """h' is the derivative of h, and at most ρ in size."""
    known = known_of(m, n)
    return {
        "derivative": identity(diff(h(m, x), "x"), dh(m, x)),
        "from_above": for_all(dh(m, x) <= known.rho),
        "from_below": for_all(-known.rho <= dh(m, x)),
    }


proof.section("The torque of one joint")


@proof.claim(
    "torque.joint",
    "k_p + k_v ≤ (τmax − k_g)/γ implies |τ_i| ≤ γ (k_p + k_v) + k_g ≤ τmax",
    "as (10p) of Section 4, whose √n one joint does not need",
    uses=["h.bound"],
)
def _(case):
    g, kp, kv, kg, limit, at_e, at_w, own, size = map(
        var, ("gamma", "kp", "kv", "kg", "limit", "abs_h_e", "abs_h_w", "abs_g", "tau")
    )
    given = (size <= kp * at_e + kv * at_w + own, at_e <= g, at_w <= g, own <= kg)
    signs = positive("gamma", "kp", "kv", "limit") + nonnegative("kg", "abs_h_e", "abs_h_w", "abs_g", "tau")
    return all_of(
        bound=implies(signs, given, size <= g * (kp + kv) + kg),
        rule=implies(signs, (*given, kp + kv <= (limit - kg) / g), size <= limit),
    )


proof.section("The function h")


@proof.claim("h.odd", "h is odd and x h(x) > 0 unless x = 0", "(6)")
def _(m):
    return all_of(
        **sign_of(m),
        zero_at_0=identity(h(m, 0), 0),
        product=for_all(expr(0) <= x * h(m, x)),
    )


@proof.claim("h.bound", "‖h(x)‖ ≤ √nγ", "(7), first line")
def _(m, n):
    known = known_of(m, n)
    return all_of(
        every_entry=for_all(h(m, x) <= known.gamma),
        every_entry_from_below=for_all(-known.gamma <= h(m, x)),
        norm=Constant(sqrt(n) * known.gamma <= known.reach),
    )


@proof.claim("h.slope", "‖h(x)‖ ≤ L‖x‖ with L = sup h(x)/x", "(7), second line")
def _(m, n):
    return norm_bound(h(m, x), n, known_of(m, n).L, power=1)


@proof.claim("h.steep", "|h'(x)| ≤ ρ, and h' is the derivative of h", "(8)")
def _(m, n):
    return all_of(**slope_of(m, n))


@proof.claim(
    "h.share",
    "‖h(q̃)‖/(1 + ‖q̃‖) ≤ G = √nγL/(√nγ + L)",
    "as min(Lr, √nγ)/(1 + r) is largest where both agree",
    uses=["h.bound", "h.slope"],
)
def _(m, n):
    known, a, r, reach, L = known_of(m, n), var("a"), var("r"), var("reach"), var("L")
    return all_of(
        for_any_bounds=implies(
            positive("reach", "L") + nonnegative("a", "r"),
            (a <= reach, a <= L * r),
            a / (1 + r) <= reach * L / (reach + L),
        ),
        with_these=Constant(expr(known.reach) * known.L / (known.reach + known.L) <= known.G),
    )


@proof.claim("h.bounds", "|h| ≤ γ, |h'| ≤ ρ and |h(x)| ≤ L|x|, and h is odd", "(7), (8)")
def _(m, n):
    return known_of(m, n).of_h(function_of(m))


proof.section("V = ½yᵀMy + Σ k_pi U(q̃_i), y = q̇ − εh(q̃)")


@proof.claim("V.positive", "V > 0 unless q̃ = q̇ = 0", "(13)", uses=["h.odd"])
def _(m):
    return property_of("V is positive definite", stable_of(m, "any"))


@proof.claim("V.unbounded", "V is radially unbounded", "(13)", uses=["h.bound"])
def _(m):
    return property_of("V is radially unbounded", stable_of(m, "any"))


@proof.claim(
    "V.smooth",
    "V is continuously differentiable, also at q̃ = 0, where ‖q̃‖ is not",
    "(13)",
    uses=["h.slope", "h.steep"],
)
def _(m):
    return property_of("V is continuously differentiable", stable_of(m, "any"))


@proof.claim("equilibrium", "the origin is the only equilibrium", "(11)", uses=["h.odd"])
def _(m):
    """Where q̇ = 0, h(q̃)ᵀMq̈ ≥ λmin(K_p)‖h(q̃)‖²."""
    return property_of(
        "the origin is the only equilibrium", AT_REST.regulator(AT_REST.h_of(m), friction="positive")[2]
    )


proof.section("dV/dt ≤ −[a b] Θ' [a b]ᵀ")


@proof.claim("rate", "dV/dt along (11) is the sum of eleven terms", "(15)", uses=["V.smooth"])
def _():
    """For every n, with Ṁ = C + Cᵀ by Property 2.4; the rate of r = ‖q̃‖ is what the rate of r² says."""
    s = loops.letters()
    return all_of(
        terms=loops.along(s, loops.energy(s), total(loops.terms(s))),
        rate_of_the_norm=loops.along(s, s.r**2, rate(dot(s.e, s.e))),
    )


def bounds_of(known):
    """The bounds of the eleven terms in a = ‖h(q̃)‖ and b = ‖q̇‖."""
    a, b, eps, k, b_min, b_max, kv_max, beta, kc = map(
        var, ("a", "b", "eps", "kp", "b_min", "b_max", "kv_max", "beta", "kc")
    )
    return [
        expr(0),
        -b_min * b**2,
        eps * known.rho * beta * b**2,
        eps * known.G * beta * b**2,
        eps * known.reach * kc * b**2,
        -eps * k * a**2,
        eps * b_max * a * b,
        eps * known.L * kv_max * a * b,
        eps**2 * known.reach * kc * a * b,
        eps**2 * known.G * beta * a * b,
        eps**2 * known.rho * beta * a * b,
    ]


def minus_form(entries):
    """−[a b] Θ' [a b]ᵀ."""
    a, b, (corner, side, low) = var("a"), var("b"), entries
    return -(corner * a**2 + 2 * side * a * b + low * b**2)


def term(k, says, uses, norms, least=()):
    """A claim: term k of (15) is at most its bound for every n, by what is known of its letters."""
    words, place = f"term {k}: {says}", f"(15), term {k}"

    @proof.claim(f"rate.{k}", words, place=place, uses=["rate", *uses])
    def _(m, n):
        s, known = loops.short_letters(), known_of(m, n)
        sizes, forms = loops.known_norms(s, known), loops.known_least(s)
        given = [sizes[name] for name in norms], [forms[name] for name in least]
        return loops.term_at_most(s, k, bounds_of(known)[k - 1], *given)


term(1, "−q̇ᵀK_v h(q̇) ≤ 0", ["h.odd"], [], ["damping"])
term(2, "−q̇ᵀBq̇ ≤ −λmin(B) b²", [], ["w"], ["friction"])
term(3, "ε(h'∘q̇)ᵀMq̇ ≤ ερβ_M b²", ["h.steep"], ["dh", "M", "w"])
term(4, "−ε êᵀq̇/(1+r) hᵀMq̇ ≤ εGβ_M b²", ["h.share"], ["u", "share", "M", "w"])
term(5, "−ε hᵀCᵀq̇ ≤ ε√nγ k_c b²", ["h.bound"], ["reach", "C", "w"])
term(6, "−ε hᵀK_p h ≤ −ελmin(K_p) a²", [], ["h"], ["gain"])
term(7, "ε hᵀBq̇ ≤ ελmax(B) a b", [], ["h", "B", "w"])
term(8, "ε hᵀK_v h(q̇) ≤ εLλmax(K_v) a b", ["h.slope"], ["h", "K_v", "hw"])
term(9, "½ε² hᵀ(C+Cᵀ)h ≤ ε²√nγ k_c a b", ["h.bound"], ["h", "reach", "C"])
term(10, "ε² êᵀq̇/(1+r) hᵀMh ≤ ε²Gβ_M a b", ["h.share"], ["u", "w", "share", "h", "M"])
term(11, "−ε²(h'∘q̇)ᵀMh ≤ ε²ρβ_M a b", ["h.steep"], ["dh", "w", "h", "M"])


def theta(eps, k, b_min, c, d):
    """θ'11, θ'12, θ'22."""
    return eps * k, -eps / 2 * (d + eps * c), b_min - eps * c


@proof.claim(
    "rate.form",
    "dV/dt ≤ −[a b] Θ' [a b]ᵀ",
    "in place of (16)",
    uses=[f"rate.{k}" for k in range(1, 12)],
)
def _(m, n):
    """The bounds of the eleven terms add up to the form; and from V itself, with letters for n and h."""
    known = known_of(m, n)
    return all_of(
        sum=identity(total(bounds_of(known)), minus_form(form_of(known))),
        from_V_for_every_n=rate_at_most(stable_of(m)),
    )


proof.section("Every arm")
STEPS = ("equilibrium", "V.smooth", "V.positive", "V.unbounded", "h.bounds", "rate.form")
"""Steps of the theorem by themselves; its own certificate has them all, for every n."""


def condition(eps0, k, b_min, c, d):
    """The condition on ε₀: det Θ'/ε > 0 at ε = ε₀, that is ¼ε₀(d + ε₀c)² < k(λmin(B) − ε₀c)."""
    return eps0 * (d + eps0 * c) ** 2 / 4 < k * (b_min - eps0 * c)


@proof.claim(
    "arms.theta",
    "¼ε₀(d + ε₀c)² < λmin(K_p)(λmin(B) − ε₀c) makes Θ' positive definite for every ε in (0, ε₀]",
    "in place of (18)",
)
def _(m):
    return rate_definite(stable_of(m, "given"))


@proof.claim(
    "arms.stable",
    "where ε₀ meets the condition, the origin is globally asymptotically stable",
    "Proposition",
    uses=[*STEPS, "arms.theta"],
)
def _(m):
    """For every robot with Properties 2.1–2.7 and the constants λmin(B), λmax(B), β_M, k_c, and any gains."""
    return stable_of(m, "given")


@proof.claim(
    "arms.small",
    "some ε₀ > 0 makes Θ' positive definite for every ε in (0, ε₀]",
    "in place of (19)",
)
def _(m):
    return rate_definite(stable_of(m))


@proof.claim(
    "arms.all",
    "for all positive gains the origin is globally asymptotically stable: no bound of K_v is needed",
    "the Proposition, without (19)",
    uses=[*STEPS, "arms.small"],
)
def _(m):
    """For every robot with Properties 2.1–2.7, friction included; ε₀ is not part of the controller."""
    return stable_of(m)


proof.section("This arm")


def form_numbers(m, n, robot, gains):
    """λmin(K_p), λmin(B), c and d for the robot and gains at hand."""
    known, arm = known_of(m, n), ArmBounds(robot)
    c = known.drift(arm.beta, arm.kc)
    return min(gains.kp), arm.b_min, c, known.cross(arm.b_max, max(gains.kv))


def eps0_of(m, n, robot, gains):
    """ε₀: a share of the largest one that meets the condition.

    Raises:
        Lacking: there is none, as where a joint has no friction.
    """
    k, b, c, d = form_numbers(m, n, robot, gains)
    largest = largest_with(lambda eps: eps * (d + eps * c) ** 2 / 4 < k * (b - eps * c))
    if largest is None:
        raise lacking("no ε₀ > 0 meets the condition; λmin(B) and λmin(K_p) must be positive")
    return SHARE * largest


@proof.claim(
    "arm.properties",
    "M is symmetric, and Ṁ = C + Cᵀ",
    "Properties 2.1, 2.4",
)
def _(n, robot):
    robot = robot.fixed()
    u, v, w = (vector(name, n) for name in "uvw")
    mass, turning = mass_matrix(robot), coriolis_matrix(robot, w)
    return all_of(
        symmetric=identity(form(u, mass, v), form(v, mass, u)),
        rate=identity(form(u, rate_of(mass, w), v), form(u, plus(turning, transpose(turning)), v)),
    )


@proof.claim("arm.M", "M(q) is positive definite, and ‖M(q)‖ ≤ β_M", "Properties 2.1, 2.2")
def _(robot):
    arm = ArmBounds(robot)
    return all_of(positive_definite=arm.mass_above(), bounded=arm.mass_below())


@proof.claim("arm.C", "‖C(q,x)y‖ ≤ k_c‖x‖‖y‖", "Property 2.6")
def _(robot):
    return ArmBounds(robot).coriolis_below()


@proof.claim(
    "arm.theta",
    "Θ' is positive definite for every ε in (0, ε₀], at these numbers",
    "in place of (18)",
)
def _(m, n, robot, gains):
    k, b, c, d = form_numbers(m, n, robot, gains)
    eps0 = eps0_of(m, n, robot, gains)
    return all_of(
        corner=Constant(expr(0) < k),
        determinant=for_all(condition(x * eps0, expr(k), expr(b), expr(c), expr(d)), 0, 1),
    )


@proof.claim(
    "arm.stable",
    "the origin is globally asymptotically stable: this robot, these gains, with this ε₀ in V",
    "Proposition",
    uses=[*STEPS, "arm.properties", "arm.M", "arm.C", "arm.theta"],
)
def _(m, n, robot, gains):
    eps0 = eps0_of(m, n, robot, gains)
    return at_arm(stable_of(m, "given"), robot, Kp=gains.kp, Kv=gains.kv, eps0=eps0)


@proof.claim(
    "arm.states",
    "dV/dt < 0 at every state but the origin, by the checker of states",
    "(15)",
)
def _(m, n, robot, gains):
    """The same ε₀ without any of the steps above: the checker has its own bounds of M, C, h and h'."""
    return decreasing(robot, gains, eps0_of(m, n, robot, gains))


@proof.claim("arm.ranges", "dV/dt < 0 for every arm within the ranges, with half of ε₀", "(15)")
def _(m, n, robot, gains):
    """For all values of the numbers of the arm that are assumed within a range."""
    return decreasing(robot, gains, eps0_of(m, n, robot, gains) / 2, ranges=True)


proof.section("The integral of ‖h(q̃)‖²")


@proof.claim(
    "arm.integral",
    "from rest, 45° off in each joint and 90° in the last: ∫‖h(q̃)‖² dt ≤ 2V(0)(1 + R)/(ε₀λmin(K_p))",
    "beside the index (20)",
    uses=["rate.form", "V.positive", "arm.properties", "arm.M", "arm.C"],
)
def _(m, n, robot, gains):
    """By dV/dt ≤ −½ελmin(K_p)‖h‖² for half of ε₀; V(t) ≤ V(0) gives k_pi U(q̃_i) ≤ V(0), and so ‖q̃‖ ≤ R.

    The parts are decided, with numbers; that they give the integral is what stands here. It is far from
    sharp: the index printed for m = 1 is 5 s·(25.4°)² = 0.98 rad²s.
    """
    k, b, c, d = form_numbers(m, n, robot, gains)
    eps0 = eps0_of(m, n, robot, gains) / 2
    at_rest = expr(eps0) ** 2 / 2 * ArmBounds(robot).beta * known_of(m, n).reach ** 2
    start = zip(gains.kp, [pi / 4] * (n - 1) + [pi / 2], strict=True)
    energy = at_rest + total(k_i * potential(m, e_i) for k_i, e_i in start)
    most = above(energy)
    far = {joint: most / k_i + 1 for joint, k_i in zip(robot.joints, gains.kp, strict=True)}
    R = above(sqrt(total(expr(r_i) ** 2 for r_i in far.values())))
    integral = 2 * expr(most) * (1 + R) / (expr(eps0) * k)
    stays = zip(far.items(), gains.kp, strict=True)
    return all_of(
        half_of_the_form_is_left=half_of_the_form(),
        at_these_numbers=for_all(x * eps0 / 2 * (d + x * eps0 * c) ** 2 <= k * (b - x * eps0 * c), 0, 1),
        energy_at_the_start=Constant(energy <= most),
        **{f"{joint}_stays": Constant(expr(most) <= k_i * potential(m, r_i)) for (joint, r_i), k_i in stays},
        norm=Constant(sqrt(total(expr(r_i) ** 2 for r_i in far.values())) <= R),
        integral=Constant(integral <= above(integral)),
    )


def half_of_the_form():
    """½εka² is at most the form where ½ε(d + εc)² ≤ k(λmin(B) − εc); a square is never negative."""
    a, b, eps, k, b_min, c, d = map(var, ("a", "b", "eps", "kp", "b_min", "c", "d"))
    whole = eps * k * a**2 - eps * (d + eps * c) * a * b + (b_min - eps * c) * b**2
    square, given = (k * a - (d + eps * c) * b) ** 2, eps * (d + eps * c) ** 2 / 2 <= k * (b_min - eps * c)
    ranges = nonnegative("a", "b") + positive("eps", "kp", "b_min", "c", "d")
    return implies(ranges, (expr(0) <= square, given), eps * k * a**2 / 2 <= whole)
