"""PD control with g(q_d) from positions alone, τ = K_p q̃ − N L z + g(q_d), dz/dt = N q̇ − A z.

z = x + N q with dx/dt = −A (x + N q) needs no velocity. λmin(K_p) > k_g is enough, whatever N, L and A.
dV/dt sees z alone, so LaSalle's theorem needs two steps: z = 0 gives q̇ = 0, and that gives q̃ = 0.
With K_v = N L this is the P"D" control of Kelly (1993), also in his book with Santibáñez and Loría. Neither
text was at hand; the proof is written here anew.
"""

from lyapcheck.claims import (
    Proof,
    along,
    any_vector,
    at_arm,
    constant_goal,
    lasalle,
    norm,
    rate_at_most,
    step,
)
from lyapcheck.robots import load

proof = Proof("kelly_filter", "PD control from positions alone", reference="kelly2005control")


def regulator(sign=1, soft=False, leak=1):
    """The loop, V and the theorem."""
    goal = constant_goal()
    e, w, M, k_g = goal.e, goal.w, goal.M, goal.kg
    K_p, L, N, A = goal.gains("Kp L N A")
    z = goal.state("z", N @ w - leak * A @ any_vector("z"))
    r, b, c = norm(e), norm(w), norm(z)
    loop = goal.under(K_p @ e - sign * N @ (L @ z) + goal.gravity_at_goal)
    V = w @ M @ w / 2 + e @ K_p @ e / 2 + z @ L @ z / 2
    theorem = lasalle(
        loop,
        V,
        gravity=True,
        where=[] if soft else [k_g < K_p.min],
        above=goal.mu / 2 * b**2 + (K_p.min - k_g) / 2 * r**2 + L.min / 2 * c**2,
        rate=L.min * A.min * c**2,
        rest=[step(N.min * b**2, z=w), step((K_p.min - k_g) * r**2, w=e)],
    )
    return loop, V, theorem, -z @ L @ A @ z - w @ goal.B @ w


loop, V, theorem, power = regulator()
proof.add("rate", "dV/dt = −zᵀL A z − q̇ᵀBq̇", along(loop, V, power, gravity=True))
proof.add_theorem("P", "λmin(K_p) > k_g makes q̃ = 0, q̇ = 0, z = 0 globally asymptotically stable", theorem)
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with these gains",
    at_arm(theorem, load("pelican2"), Kp="30 30", L="2 2", N="5 5", A="10 10"),
    uses=["P"],
)

proof.section("What would be too much")
proof.add("soft", "the same argument for all positive gains: a soft arm falls", regulator(soft=True)[2])
proof.add(
    "turned", "the same with the filter fed back with the other sign", rate_at_most(regulator(sign=-1)[2])
)
proof.add("leak", "the same with A = 0: z is then Nq̃ and a constant, and nothing damps", regulator(leak=0)[2])
