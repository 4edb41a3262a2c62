"""PD control with adapted gravity, τ = K_p q̃ − K_v q̇ + Y(q)π̂: the arm reaches the goal, whatever it carries.

g(q) = Y(q)π is linear in unknown parameters π of the links and of what they hold. Their error is Gf = π̂ −
π, with df/dt = −Yᵀ(q̇ − ε q̃) and ε = a/(1 + ‖q̃‖), so that τ = K_p q̃ − K_v q̇ + g(q) + Y G f. V is the
energy with a cross term and ½fᵀGf: no parameter is left in dV/dt, and q̃ tends to 0. Parameters may stay
wrong. The scheme follows Tomei (1991), whose text was not at hand: his multiplier may be another."""

from lyapcheck.claims import Proof, constant_goal, converges, norm, strict, transpose

proof = Proof("adaptive_pd", "PD control with adapted gravity", reference="tomei1991adaptive")


def regulator(adapt=1, where=True, learn=False, theorem=converges):
    """The theorem."""
    goal = constant_goal()
    e, w, M = goal.e, goal.w, goal.M
    K_p, K_v = goal.gains("Kp Kv")
    (G,) = goal.gains("G", size="p")
    (a,) = goal.constants("a")
    Y = goal.known("Y", columns="p")
    ε = a * goal.s
    f = goal.state("f", -adapt * transpose(Y) @ (w - ε * e), size="p")
    r, b, c, β = norm(e), norm(w), norm(f), goal.beta
    loop = goal.under(K_p @ e - K_v @ w + goal.gravity + Y @ (G @ f))
    V = w @ M @ w / 2 + e @ K_p @ e / 2 - ε * e @ M @ w + f @ G @ f / 2
    d = K_v.min - a * (2 * β + goal.kc)
    rate = ε * K_p.min * r**2 - ε * (K_v.max + goal.B.max) * r * b + d * b**2
    conditions = [
        a**2 * β**2 < goal.mu * K_p.min,
        a * (2 * β + goal.kc) < K_v.min,
        a * (K_v.max + goal.B.max) ** 2 / 4 < K_p.min * d,
    ]
    more = {"to_zero": [e, w]} if theorem is converges else {}
    more |= {} if theorem is strict else {"below": (β * (b + a * r) ** 2 + K_p.max * r**2 + G.max * c**2) / 2}
    return theorem(
        loop,
        V,
        where=conditions if where else [],
        above=goal.mu / 2 * b**2 + K_p.min / 2 * r**2 - a * β * r * b + G.min / 2 * c**2,
        rate=rate + G.min * c**2 if learn else rate,
        **more,
    )


proof.add_theorem(
    "P",
    "for small a, q̃ → 0 and q̇ → 0 from everywhere, and parameters stay bounded, with any regressor",
    regulator(),
)

proof.section("What would be too much")
proof.add("any a", "the same for every a: the cross term may be too large", regulator(where=False))
proof.add("turned", "the same with parameters that move the other way", regulator(adapt=-1))
proof.add("learned", "the parameters tend to the right ones as well", regulator(learn=True))
proof.add("asymptotic", "the origin is asymptotically stable by the same V", regulator(theorem=strict))
