"""Slotine and Li's adaptive tracking: τ = Y π̂ + K s with s = dq̃/dt + Λq̃, and parameters that follow Yᵀs.

Y π = M(q̈_d + Λ dq̃/dt) + (C + B)(q̇_d + Λq̃) + g is linear in the unknown parameters π, one a column of Y.
With Gf = π̂ − π the torque is that of slotine_li.py and Y G f, and df/dt = Yᵀs.
V = ½sᵀMs + ½fᵀGf does not see the line s = 0. With q̃ᵀΛ(K + B)q̃ added it sees every state: the origin is
stable, all motions are bounded, and q̃ and dq̃/dt tend to 0. Parameters stay bounded, and may stay wrong.
"""

from lyapcheck.claims import Proof, any_vector, converges, exponential, moving_goal, norm, transpose

proof = Proof("slotine_li_adaptive", "Adaptive passivity-based tracking", reference="slotine1987adaptive")


def tracker(columns="p", adapt=1, bounded=True, kinetic=False, learn=False, theorem=converges):
    """The theorem, for parameters of some number."""
    goal = moving_goal()
    e, w, M, B, C = goal.e, goal.w, goal.M, goal.B, goal.C
    K, Λ = goal.gains("K Lambda")
    (G,) = goal.gains("G", size=columns)
    Y = goal.known("Y", columns=columns, bounded=bounded)
    s, y, reference = Λ @ e - w, any_vector("y_w"), goal.velocity + Λ @ e
    f = goal.state("f", adapt * transpose(Y) @ s, size=columns)
    model = M @ (goal.acceleration - Λ @ w) + C @ reference + B @ reference + goal.gravity
    loop = goal.under(model + K @ s + Y @ (G @ f))
    r, b, c, errors = norm(e), norm(w), norm(f), e @ Λ @ K @ e + e @ Λ @ B @ e
    V, least = s @ M @ s / 2 + f @ G @ f / 2, goal.mu / 2 * norm(y) ** 2
    most = goal.beta / 2 * (Λ.max * r + b) ** 2
    rate = K.min * b**2 + Λ.min**2 * K.min * r**2
    return theorem(
        loop,
        V if kinetic else V + errors,
        changes={"w": Λ @ e - y},
        above=least + G.min / 2 * c**2 + (0 if kinetic else Λ.min * K.min) * r**2,
        below=most + Λ.max * (K.max + B.max) * r**2 + G.max / 2 * c**2,
        rate=rate + G.min * c**2 if learn else rate,
        **({"to_zero": [e, w]} if theorem is converges else {}),
    )


proof.add_theorem(
    "P",
    "the errors q̃ and dq̃/dt tend to 0, and the origin is stable, with parameters of any number",
    tracker(),
)
proof.add(
    "P.joints",
    "so with one unknown parameter a joint, as for viscous friction alone: Y = diag(q̇_d + Λq̃), n columns",
    tracker(columns="n"),
)

proof.section("What would be too much")
proof.add("printed", "the same by ½sᵀMs + ½fᵀGf, which is 0 on a whole line", tracker(kinetic=True))
proof.add("turned", "the same with parameters that move the other way", tracker(adapt=-1))
proof.add("unbounded", "the same with a regressor that time may drive off", tracker(bounded=False))
proof.add("learned", "the parameters tend to the right ones as well", tracker(learn=True))
proof.add("exponential", "errors and parameters tend to 0 exponentially", tracker(theorem=exponential))
