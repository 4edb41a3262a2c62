"""Flexible joints: PD control of the motors, u = K_p (θ_d − θ) − K_d dθ/dt + g(q_d), moves the links to q_d.

Springs between links and motors give τ = K(θ − q). With θ_d = q_d + K⁻¹g(q_d), f = θ_d − θ, the momentum p of
the motors and J = (motor inertia)⁻¹, this is τ = K(q̃ − f) + g(q_d), df/dt = −Jp and
dp/dt = K_p f − K_d J p − K(q̃ − f). V falls only where motors move. If they stay still, the springs pull with
constant torque, so the links stand still too: q̃ is constant, and so q̇ = 0. What is left is statics.
The theorem is that of Tomei (1991), whose text was not at hand. The condition is written in λmin and λmax
of K and K_p: for springs that differ it asks for more than the least eigenvalue of both together would.
"""

from lyapcheck.claims import Proof, along, any_vector, at_arm, constant_goal, lasalle, norm, step
from lyapcheck.robots import load

proof = Proof("flexible_joints", "A PD controller for arms with flexible joints", reference="tomei1991simple")


def motors(damping=1, stiff=True, still=True):
    """The loop, V and the theorem."""
    goal = constant_goal()
    e, w, M, k_g = goal.e, goal.w, goal.M, goal.kg
    K, K_p, K_d, J = goal.gains("K Kp Kd J")
    f, p = any_vector("f"), any_vector("p")
    goal.state("f", -J @ p)
    goal.state("p", K_p @ f - damping * K_d @ (J @ p) - K @ (e - f))
    r, b, d, a = norm(e), norm(w), norm(f), norm(p)
    loop = goal.under(K @ (e - f) + goal.gravity_at_goal)
    V = w @ M @ w / 2 + p @ J @ p / 2 + (e - f) @ K @ (e - f) / 2 + f @ K_p @ f / 2
    springs = (K.min - k_g) * r**2 - 2 * K.max * r * d + (K.min + K_p.min) * d**2
    theorem = lasalle(
        loop,
        V,
        gravity=True,
        where=[k_g < K.min, K.max**2 < (K.min - k_g) * (K.min + K_p.min)] if stiff else [],
        above=goal.mu / 2 * b**2 + J.min / 2 * a**2 + springs / 2,
        rate=J.min**2 * K_d.min * a**2,
        rest=[step(b**2, still=[f, e] if still else [f], e=-w), step(springs, w=e, p=f)],
    )
    return loop, V, theorem, -p @ J @ K_d @ J @ p - w @ goal.B @ w


loop, V, theorem, power = motors()
proof.add(
    "rate",
    "dV/dt = −(dθ/dt)ᵀK_d dθ/dt − q̇ᵀBq̇: springs only store energy",
    along(loop, V, power, gravity=True),
)
proof.add_theorem(
    "P",
    "springs and K_p stiff enough against gravity make q̃ = 0, q̇ = 0, θ = θ_d globally asymptotically stable",
    theorem,
)
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with springs of 100 N·m/rad and these gains",
    at_arm(theorem, load("pelican2"), K="100 100", Kp="30 30", Kd="3 3", J="20 20"),
    uses=["P"],
)

proof.section("What would be too much")
proof.add("soft", "the same argument for all springs and gains: a soft arm falls", motors(stiff=False)[2])
proof.add("undamped", "the same without K_d: links and motors swing for ever", motors(damping=0)[2])
proof.add("still", "the same without a reason for q̃ to stand still", motors(still=False)[2])
