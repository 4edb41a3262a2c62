"""Goals at which a sampled loop is unstable, against the nonlinear loop and exact criteria."""

from dataclasses import replace
from fractions import Fraction as F
from math import exp
from pathlib import Path

import numpy as np
import pytest

from lyapcheck import asked
from lyapcheck.check.kinds.sampled import SampledStable
from lyapcheck.check.kinds.sampled_unstable import GrowingMotion
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import Accepted, verify
from lyapcheck.control.gains import GainSet
from lyapcheck.control.sampling import LoopRecord
from lyapcheck.robots import load
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.sampled import refuted_at, smallest_refuted
from tests.helpers.shares import but

EXAMPLES = Path(__file__).parents[2] / "examples"
REFUTED = Accepted("refuted", "enclosure")
ARMS = {
    "iiwa14": ("79.372 65.092 75.188 75.478 79.197 79.290 79.372",
               "34.017 27.897 32.223 32.348 26.109 26.140 26.167", "0.05 ms", 28.6e-6),
    "buap3": ("19.063 44.342 5.331", "8.170 19.004 1.757", "60 ms", 38.9e-3),
    "reyes-kelly2": ("41.089 5.618", "17.610 2.112", "40 ms", 31.0e-3),
    "ur5": ("43.977 23.008 32.827 10.461 10.698 11.429",
            "17.260 13.477 3.676 0.635 0.732 0.001", "40 ms", 19.2e-3),
    "xarm6": ("13.327 3.830 4.613 8.144 8.269 7.413",
              "2.616 0.292 1.667 0.001 0.001 0.001", "12.5 ms", 10.2e-3),
}  # fmt: skip
"""Gains that targets at infinite rate suggest; a period, and the smallest unstable one by another program."""


def arm_of(name: str):
    file = EXAMPLES / f"{name}.toml"
    return load(str(file) if file.exists() else name).fixed()


def question(name: str, period: F | None = None, m: int = 1, delay: int = 1, **changes) -> SampledStable:
    arm, (kp, kv, text, _) = arm_of(name), ARMS[name]
    gains = GainSet(name, m, *(tuple(map(F, row.split())) for row in (kp, kv)))
    T = period or F(text.split()[0]) / 1000
    friction = tuple(number.value for number in arm.viscous)
    return replace(asked.sampled(gains, LoopRecord(T, delay=delay), friction, arm), **changes)


def against(statement: SampledStable) -> GrowingMotion:
    proof = refuted_at(statement, statement.period)
    assert proof is not None
    return proof


def states_after(statement, arm: NumericModel, proof: GrowingMotion, x, samples: int, steps: int = 4):
    """The nonlinear loop by a program of its own: states (N, s) = (q − q_d, w, earlier readings) later.

    Fourth order in some steps a sample, with M, C and g as they are.
    """
    n, d, T = statement.n, statement.delay, float(proof.period)
    goal = np.radians([float(angle) for angle in proof.goal])
    kp, kv, b = (np.array(row, dtype=float) for row in (statement.kp, statement.kv, statement.viscous_min))
    q, w, *earlier = (part.copy() for part in np.split(np.asarray(x, float), np.shape(x)[1] // n, axis=1))

    def rates(q, w, torque):
        coriolis = np.einsum("aij,aj->ai", arm.coriolis(goal + q, w), w)
        force = torque - coriolis - b * w - arm.gravity(goal + q)
        return w, np.linalg.solve(arm.mass(goal + q), force[..., None])[..., 0]

    for _ in range(samples):
        readings = [q, *earlier]
        v = sum(float(f) * (readings[d + j] - readings[d + j + 1]) / T for j, f in enumerate(statement.taps))
        torque = -kp * np.tanh(readings[d]) - kv * np.tanh(v) + arm.gravity(goal + readings[d])
        earlier = readings[:-1]
        for _ in range(steps):
            h = T / steps
            a, c = rates(q, w, torque)
            a2, c2 = rates(q + h / 2 * a, w + h / 2 * c, torque)
            a3, c3 = rates(q + h / 2 * a2, w + h / 2 * c2, torque)
            a4, c4 = rates(q + h * a3, w + h * c3, torque)
            q, w = q + h / 6 * (a + 2 * a2 + 2 * a3 + a4), w + h / 6 * (c + 2 * c2 + 2 * c3 + c4)
    return np.concatenate([q, w, *earlier], axis=1)


def at_rest(statement: SampledStable, proof: GrowingMotion) -> np.ndarray:
    start = [float(x) for x in proof.start]
    return np.array([start + start[: statement.n] * (statement.delay + len(statement.taps))])


@pytest.mark.parametrize("name", but(["buap3", "reyes-kelly2"], ARMS))
def test_the_nonlinear_loop_leaves_a_refuted_goal(name):
    statement = question(name)
    proof = against(statement)
    assert verify(statement, proof) == REFUTED
    arm, start = NumericModel(arm_of(name)), at_rest(statement, proof)
    size, near = start.shape[1], 1e-4 * float(proof.period)
    light = name == "xarm6"  # friction stops its wrist within 0.1 ms
    both = np.concatenate([np.eye(size), -np.eye(size)]) * near
    moved = states_after(statement, arm, proof, both, 1, 50 if light else 4)
    step = (moved[:size] - moved[size:]).T / (2 * near)
    assert np.abs(np.linalg.eigvals(step)).max() > float(proof.growth)
    if statement.n < 4:
        samples = int(np.log(1000) / np.log(float(proof.growth)))
        assert np.abs(states_after(statement, arm, proof, near * start, samples)).max() > 30 * near


@pytest.mark.parametrize("name", but(["reyes-kelly2"], ARMS))
def test_the_smallest_refuted_period_is_that_of_another_program_or_less(name):
    proof = smallest_refuted(question(name, F(3, 5)), F(1, 10**5))
    assert proof is not None
    statement, known = question(name, proof.period), ARMS[name][-1]
    assert verify(statement, proof) == REFUTED
    assert 0.8 * known < proof.period < 1.03 * known
    calm = replace(statement, period=proof.period / 2)
    assert refuted_at(calm, calm.period) is None
    if calm.n < 4:
        half, start = replace(proof, period=calm.period), 1e-3 * at_rest(statement, proof)
        after = states_after(calm, NumericModel(arm_of(name)), half, start, 200)
        assert np.abs(after[:, : calm.n]).max() < 1e-4


def one_joint(inertia=F(1), period=F(1), kp=F(1), kv=F(1), friction=F(1), sign=0, **changes) -> SampledStable:
    """One joint with an inertia, and U = ``sign``·cos q, J."""
    return SampledStable(**{
        "family": "tanh", "m": None, "kp": (kp,), "kv": (kv,), "viscous_min": (friction,), "k_g": (),
        "links": (), "fall": (), "mass": (((((0, 0), inertia),),),),
        "potential": (((0, 1), F(sign)),), "parameters": (),
        "period": period, "stretch": F(1), "delay": 0, "taps": (F(1),), "conclusion": "goal",
    } | changes)  # fmt: skip


def schur_cohn(c) -> bool:
    """Whether all roots of a real polynomial, the highest power first, are inside the unit circle."""
    while len(c) > 1:
        if abs(c[-1]) >= abs(c[0]):
            return False
        c = [(c[0] * a - c[-1] * b) for a, b in zip(c[:-1], c[:0:-1], strict=True)]
        c = [x / abs(c[0]) for x in c]
    return True


def test_one_joint_is_refuted_exactly_where_its_polynomial_has_a_root_outside():
    """z^(d+1) (z − 1)(z − E) + (β z + β₀)(k_p z + k_v (z − 1)/T), the hold of 1/(M s² + b s) exactly."""
    random, seen = np.random.default_rng(5), set()
    for d in (0, 1, 2) * 40:
        drawn = 10 ** random.uniform([-2, -1, -0.5, -1, -2], [0.5, 1, 1.5, 1, 0])
        M, b, kp, kv, T = (F(round(float(x) * 1000) + 1, 1000) for x in drawn)
        E, a = exp(-float(b * T / M)), float(b / M)
        beta = (float(T) - (1 - E) / a) / float(b), ((1 - E) / a - float(T) * E) / float(b)
        held = np.polymul(beta, [float(kp + kv / T), -float(kv / T)])

        def stable(radius, held=held, E=E, d=d):
            c = np.polyadd(np.polymul([1, -1 - E, E], [1] + [0] * (d + 1)), held)
            return schur_cohn([x * radius**k for k, x in enumerate(c[::-1])][::-1])

        if stable(1.001) != stable(0.999):  # too near to tell by doubles
            continue
        statement = one_joint(M, T, kp, kv, b, delay=d)
        proof = refuted_at(statement, T)
        assert (proof is None) == stable(1.0)
        seen.add((d, stable(1.0)))
    assert len(seen) == 6


def test_late_gravity_alone_refutes_where_h_is_flat_and_only_there():
    """With h'(0) = 0 the slope −G of an upright pendulum, d + ½ samples late, is negative damping."""
    flat = {"family": "hyperbolic", "m": 2, "delay": 1, "sign": 1, "period": F(1, 10)}
    loose = one_joint(friction=F(1, 10), kv=F(5), **flat)
    assert abs(against(loose).goal[0]) < 60
    tight = one_joint(friction=F(1, 5), kv=F(5), **flat)
    assert refuted_at(tight, tight.period) is None
    assert refuted_at(replace(loose, family="tanh", m=None), loose.period) is None


def test_an_arm_in_the_ranges_refutes_for_all_of_them():
    ranged = (((((0, 0, 1), F(1)),),),)
    statement = one_joint(
        mass=ranged, parameters=((F(1, 100), F(1)),), period=F(1, 10), kv=F(5), delay=1, potential=()
    )
    proof = against(statement)
    assert proof.parameters == (F(1, 100),)
    heavy = replace(statement, parameters=((F(1), F(1)),))
    assert refuted_at(heavy, heavy.period) is None
    for changed in (F(1), F(1, 200), F(2)):
        with pytest.raises(Refused):
            verify(statement, replace(proof, parameters=(changed,)))
    with pytest.raises(Refused):
        verify(heavy, proof)


def test_bounds_of_gravity_alone_are_no_arm_to_refute():
    statement = one_joint(mass=(), potential=(), k_g=(F(1),))
    proof = against(one_joint(F(1, 1000), kv=F(5), delay=1))
    with pytest.raises(Refused, match="must be given by links or by M"):
        verify(replace(statement, delay=1), proof)
