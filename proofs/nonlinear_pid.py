"""PID control with a bounded integral action, τ = (K + K_i) q̃ − K_v q̇ + K_i ∫ α f(q̃) dt: global, unlike PID.

Let z be the integral less K_i⁻¹ g(q_d), so that τ = (K + K_i) q̃ − K_v q̇ + K_i z + g(q_d) and z = 0 at rest.
As f is bounded, the cubic term α f(q̃)ᵀCᵀq̇ is at most α k_c √n γ ‖q̇‖² for all q̃. So the proof of ``pid.py``
needs no region here. Gravity changes by at most f_kg ‖f(q̃)‖, as f does not vanish far away.
The idea is that of the nonlinear PID of Kelly (1998). That text was not at hand; the proof and its conditions
are written here anew. Of the later saturated PID in the reference, title page and abstract were seen.
"""

from lyapcheck.claims import (
    Proof,
    any_vector,
    at_arm,
    constant_goal,
    cosh,
    lasalle,
    log,
    norm,
    rate_at_most,
    tanh,
    var,
)
from lyapcheck.robots import load

proof = Proof(
    "nonlinear_pid", "PID control with a bounded integral action", reference="santibanez2008saturated"
)
x = var("x")


def any_function(goal):
    """The class: odd, C¹, positive right of 0, of bounded slope, with an endless integral."""
    return goal.entrywise("f", goal.e)


def tanh_of(goal):
    """tanh: tanh x ≥ 3x/4 as far as 1, and 3/4 from there on."""
    numbers = {"gamma": 1, "rho": 1, "secant": 1, "low": "3/4", "start": 1, "steep": "3/4"}
    return goal.function("f", goal.e, tanh(x), log(cosh(x)), **numbers)


def regulator(function, conditions=4, integral=1, bounded=True):
    """The theorem, with the first of its conditions."""
    goal = constant_goal()
    e, w, M = goal.e, goal.w, goal.M
    K, K_v, K_i = goal.gains("K Kv Ki")
    (α,) = goal.constants("alpha")
    f = function(goal)
    z, y = goal.state("z", integral * α * (f if bounded else e)), any_vector("y_z")
    r, b, a, β, k_g = norm(e), norm(w), norm(f), goal.beta, goal.kg
    loop = goal.under(K @ e + K_i @ e - K_v @ w + K_i @ z + goal.gravity_at_goal)
    V = w @ M @ w / 2 + e @ K @ e / 2 + (z + e) @ K_i @ (z + e) / 2 - α * f @ M @ w
    k = K.min - k_g
    p, d = K.min * f.sector - f.kg, K_v.min - α * (β * f.slope + goal.kc * f.reach)
    where = (
        (α * β * f.secant) ** 2 < goal.mu * k,
        f.kg < K.min * f.sector,
        α * (β * f.slope + goal.kc * f.reach) < K_v.min,
        α * (K_v.max + goal.B.max) ** 2 / 4 < p * d,
    )
    return lasalle(
        loop,
        V,
        gravity=True,
        changes={"z": y - e},
        where=where[:conditions],
        above=goal.mu / 2 * b**2 + k / 2 * r**2 - α * β * f.secant * r * b + K_i.min / 2 * norm(y) ** 2,
        rate=α * p * a**2 - α * (K_v.max + goal.B.max) * a * b + d * b**2,
        rest=(z, K_i.min * norm(z) ** 2),
    )


proof.add_theorem("P", "q̃ = 0, q̇ = 0, z = 0 is globally asymptotically stable", regulator(any_function))
proof.add("P.tanh", "so with tanh", regulator(tanh_of))
proof.add(
    "P.pelican",
    "so it is for the Pelican arm with these gains",
    at_arm(regulator(tanh_of), load("pelican2"), K="40 40", Kv="7 7", Ki="5 5", alpha="0.1"),
)

proof.section("What would be too much")
proof.add("turned", "the same with the integral turned", rate_at_most(regulator(any_function, integral=-1)))
proof.add("linear", "the same with the integral of q̃ itself", regulator(any_function, bounded=False))
proof.add("soft", "the same for any K and K_v: a soft arm falls", regulator(any_function, conditions=1))
