"""What a user would write for many runs of the three-joint arm: CVODES through CasADi, diffrax on JAX.

M(q) is typed once; its derivatives are those of CasADi and of JAX.
"""

import numpy as np

from .arms import BASE, CROSS, ELBOW, SHOULDER, VISCOUS

GOAL, SECONDS = np.radians([45, 45, 90]), 5.0
RELATIVE, ABSOLUTE = 1e-9, 1e-11
STEPS = 100_000
B = VISCOUS["buap3"]


def entries(s2, c2, s3, c3):
    """M from the sines and cosines of the last two angles."""
    s23 = s2 * c3 + c2 * s3
    first = BASE + SHOULDER * s2**2 + 2 * CROSS * s2 * s23 + ELBOW * s23**2
    return [
        [first, 0.0 * s2, 0.0 * s2],
        [0.0 * s2, SHOULDER + ELBOW + 2 * CROSS * c3, ELBOW + CROSS * c3],
        [0.0 * s2, ELBOW + CROSS * c3, ELBOW + 0.0 * s2],
    ]


def cvodes(m, kp, kv, runs, threads):
    """From initial positions (runs, 3) to final states (runs, 6)."""
    import casadi as ca

    q, w = ca.SX.sym("q", 3), ca.SX.sym("w", 3)
    rows = entries(ca.sin(q[1]), ca.cos(q[1]), ca.sin(q[2]), ca.cos(q[2]))
    M = ca.vertcat(*[ca.horzcat(*row) for row in rows])
    momentum, energy = M @ w, 0.5 * ca.bilin(M, w, w)
    turned = ca.jtimes(momentum, q, w) - ca.gradient(energy, q)  # C(q, w) w
    torque = kp * _h(m, GOAL - q, ca) - kv * _h(m, w, ca) - B * w - turned
    system = {"x": ca.vertcat(q, w), "ode": ca.vertcat(w, ca.solve(M, torque))}
    options = {"reltol": RELATIVE, "abstol": ABSOLUTE, "max_num_steps": STEPS}
    one = ca.integrator("run", "cvodes", system, 0.0, SECONDS, options)
    many = one.map(runs, "thread", threads) if threads > 1 else one.map(runs)

    def call(starts):
        x0 = np.vstack([starts.T, np.zeros((3, runs))])
        return np.asarray(many(x0=x0)["xf"]).T

    return call


def diffrax(m, kp, kv):
    """The same by Dopri8 under ``vmap`` and ``jit``, in double precision."""
    import diffrax as dx
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)

    def inertia(q):
        rows = entries(jnp.sin(q[1]), jnp.cos(q[1]), jnp.sin(q[2]), jnp.cos(q[2]))
        return jnp.array(rows)

    def rate(t, y, args):
        q, w = y[:3], y[3:]
        _, along = jax.jvp(lambda q: inertia(q) @ w, (q,), (w,))
        turned = along - jax.grad(lambda q: 0.5 * w @ inertia(q) @ w)(q)
        torque = kp * _h(m, GOAL - q, jnp) - kv * _h(m, w, jnp) - B * w - turned
        return jnp.concatenate([w, jnp.linalg.solve(inertia(q), torque)])

    term, control = dx.ODETerm(rate), dx.PIDController(rtol=RELATIVE, atol=ABSOLUTE)

    def run(y0):
        result = dx.diffeqsolve(
            term, dx.Dopri8(), 0.0, SECONDS, 1e-3, y0, stepsize_controller=control, max_steps=STEPS
        )
        return result.ys[-1]

    many = jax.jit(jax.vmap(run))

    def call(starts):
        return np.asarray(many(np.hstack([starts, np.zeros_like(starts)])))

    return call


def _h(m, x, library):
    s = library.sinh(x)
    return s ** (2 * m - 1) * library.cosh(x) / (1 + s ** (2 * m))
