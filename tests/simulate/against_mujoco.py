"""Motions of arms against MuJoCo: continuous ones to 1e-4 in L2, sampled ones by how they end.

Not part of the ordinary tests: it needs the package ``mujoco``. Run it as
``pytest tests/simulate/against_mujoco.py``; without the package it fails. MuJoCo has the arm's links as text;
controller, sampling, delay, and what is called a limit cycle or a fall are written anew here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from pathlib import Path

import mujoco
import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.answers.running.sampled import AsRun
from lyapcheck.answers.tune.search import Search
from lyapcheck.answers.tune.targets import limits_with
from lyapcheck.answers.tune.trial import BY_PROOF, Trials, Wishes
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.control.gains import GainSet
from lyapcheck.control.limits import model_limits
from lyapcheck.control.sampling import LoopRecord
from lyapcheck.robots import RobotModel
from lyapcheck.robots.dynamics import Chain
from lyapcheck.simulate.bench import Bench
from lyapcheck.simulate.closed_loop import simulate
from lyapcheck.simulate.task import task_for
from lyapcheck.simulate.trial import experiment

EXAMPLES = Path(__file__).parents[2] / "examples"
T, GOAL = 5.0, 0.7
"""s and rad: of every joint, from rest at home."""
GAINS = {
    "iiwa14": ("113.2 92.9 107.6 107.6 112.9 113 113.2", "3"),
    "panda": ("32.1 7.93 20.3 23.1 2.5 2.69 3.77", "0.755"),
    "ur5": ("60.4 36.2 53.9 10.5 10.6 10.6", "0.816"),
    "xarm6": ("20 8.31 7.76 12.2 12.2 7.75", "0.408"),
    "px150": ("3.53 7.19 5.45 2.1 0.398", "0.044"),
    "pelican2": ("30 7", "0.5"),
}
"""k_p and k_v, N·m, of each arm: as stiff as (10p) lets it be, and damped less than critically."""

STIFF = ("xarm6",)
"""Friction takes 1e-5 s to stop its last link: small steps of RK4, or an implicit method."""


def arm(name: str) -> RobotModel:
    """Without dry friction, which MuJoCo has in another way."""
    file = EXAMPLES / f"{name}.toml"
    model = robots.load(str(file) if file.exists() else name).fixed()
    return replace(model, coulomb=(None,) * model.n)


def gains(name: str, heavy: bool, m: int = 1) -> GainSet:
    """Those above, or 0.6 of their k_p with a quarter of it as k_v."""
    kp, kv = ([Fraction(word) for word in text.split()] for text in GAINS[name])
    stiff = tuple(k * Fraction(3, 5) if heavy else k for k in kp)
    return GainSet(name, m, stiff, tuple(k / 4 for k in stiff) if heavy else tuple(kv * len(kp)))


# --- The arm as MuJoCo has it.


def compiled(model: RobotModel, payload: float = 0.0, integrator: str = "RK4") -> mujoco.MjModel:
    chain = model.dynamics
    assert isinstance(chain, Chain)
    opened, bodies = "", [*zip(model.joints, chain.links, model.viscous, strict=True)]
    for i, (name, link, viscous) in enumerate(bodies):
        mass = float(link.mass) + (payload if i == len(bodies) - 1 else 0.0)
        axes = [row[k] for k in (0, 1) for row in link.turn]
        opened += (
            f'<body pos="{words(link.origin)}" xyaxes="{words(axes)}">'
            f'<joint name="{name}" axis="{words(link.axis)}" damping="{float(viscous.value)!r}"/>'
            f'<inertial pos="{words(link.com)}" mass="{mass!r}" fullinertia="{words(moments(link))}"/>'
        )
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><compiler angle="radian"/><option integrator="{integrator}" gravity="{words(chain.fall)}">'
        f'<flag contact="disable"/></option><worldbody>{opened}{"</body>" * len(bodies)}</worldbody></mujoco>'
    )


def moments(link: RigidLink) -> list[float]:
    """xx, yy, zz, xy, xz, yz; a body known about its axis alone gets as much across it, which never turns."""
    inertia = np.array(link.inertia, dtype=float)
    if np.linalg.matrix_rank(inertia) == 1:
        inertia = np.trace(inertia) * np.eye(3)
    return [float(inertia[i, k]) for i, k in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]


def words(values: Sequence[float | Fraction]) -> str:
    return " ".join(repr(float(x)) for x in values)


# --- The controller and what is seen, once more.


def h(x: np.ndarray, m: int) -> np.ndarray:
    """The paper's h_m, beyond 20 rad its limit."""
    x = np.clip(x, -20.0, 20.0)
    return np.sinh(x) ** (2 * m - 1) * np.cosh(x) / (1.0 + np.sinh(x) ** (2 * m))


@dataclass(frozen=True)
class Seen:
    """q, w and τ at the samples; Δg there and at the goal."""

    t: np.ndarray
    q: np.ndarray
    w: np.ndarray
    tau: np.ndarray
    unknown: np.ndarray


class Law:
    """τ = K_p h(e) − K_v h(v) + ĝ(q) of an arm without payload."""

    def __init__(self, model: RobotModel, given: GainSet) -> None:
        self.kp, self.kv = (np.array(k, dtype=float) for k in (given.kp, given.kv))
        assert given.m is not None
        self.m, self.known = given.m, compiled(model)
        self.data = mujoco.MjData(self.known)
        limits = [np.inf if one is None else float(one.value) for one in model.torque_limit]
        self.most = np.array(limits)

    def gravity(self, q: np.ndarray) -> np.ndarray:
        return weight(self.known, self.data, q)

    def torque(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        return self.kp * h(GOAL - q, self.m) - self.kv * h(v, self.m) + self.gravity(q)


def weight(model: mujoco.MjModel, data: mujoco.MjData, q: np.ndarray) -> np.ndarray:
    data.qpos[:], data.qvel[:] = q, 0.0
    mujoco.mj_fwdPosition(model, data)
    mujoco.mj_fwdVelocity(model, data)
    return data.qfrc_bias.copy()


def continuous(model: RobotModel, given: GainSet, T: float, step: float) -> float:
    """L2 in degrees of the loop (11), the torque taken anew at every stage of RK4."""
    law, world = Law(model, given), compiled(model)
    world.opt.timestep = step
    data = mujoco.MjData(world)

    def control(_: mujoco.MjModel, at: mujoco.MjData) -> None:
        if at is not law.data:
            at.qfrc_applied[:] = law.torque(at.qpos.copy(), at.qvel.copy())

    errors = [np.full(model.n, GOAL)]
    mujoco.set_mjcb_control(control)
    try:
        for _ in range(round(T / step)):
            mujoco.mj_step(world, data)
            errors.append(GOAL - data.qpos)
    finally:
        mujoco.set_mjcb_control(None)
    square = np.sum(np.square(errors), axis=1)
    return float(np.degrees(np.sqrt((square.sum() - (square[0] + square[-1]) / 2) * step / T)))


def sampled(
    model: RobotModel, given: GainSet, rate: int, delay: int, payload: float, start: np.ndarray | None = None
) -> Seen:
    """The loop at a rate: reading, backward difference, torque held; ``delay`` samples late.

    From home the first torques are those of gravity, from a start that is given those of a reading there.
    """
    way = "implicitfast" if model.name in STIFF else "RK4"
    law, world = Law(model, given), compiled(model, payload, way)
    steps = max(1, round(4000 / rate))
    world.opt.timestep = 1.0 / rate / steps
    data, other = mujoco.MjData(world), mujoco.MjData(world)
    last, first = np.zeros(model.n), law.gravity(np.zeros(model.n))
    if start is not None:
        data.qpos[:] = last = start
        first = law.torque(start, np.zeros(model.n))
    waiting = [first] * delay
    rows = []
    for k in range(round(T * rate)):
        q = data.qpos.copy()
        waiting.append(np.clip(law.torque(q, (q - last) * rate), -law.most, law.most))
        last, tau = q, waiting.pop(0)
        rows.append((k / rate, q, data.qvel.copy(), tau, weight(world, other, q) - law.gravity(q)))
        data.qfrc_applied[:] = tau
        for _ in range(steps):
            mujoco.mj_step(world, data)
    seen = Seen(*(np.array(column) for column in zip(*rows, strict=True)))
    goal = np.full(model.n, GOAL)
    there = weight(world, other, goal) - law.gravity(goal)
    return replace(seen, unknown=np.vstack((seen.unknown, there)))


def ending(seen: Seen, model: RobotModel, given: GainSet) -> str:
    """``falls``, ``limit cycle`` or ``settles``."""
    load, kp = np.abs(seen.unknown).max(axis=0), np.array(given.kp, dtype=float)
    assert given.m == 1  # of which γ is 1
    if np.any((load >= kp) & (load > 0) & (np.abs(GOAL - seen.q[-1]) > np.radians(1))):
        return "falls"
    fifths = [(seen.t >= T * a) & (seen.t < T * b) for a, b in ((0.6, 0.8), (0.8, 1.0))]
    limits = np.array([np.inf if one is None else float(one.value) for one in model.torque_limit])
    for signal, least in ((seen.q, np.radians(0.05)), (seen.tau, 0.01 * limits)):
        before, last = (np.ptp(signal[part], axis=0) for part in fifths)
        back = [np.sum(np.diff(np.sign(seen.w[part]), axis=0) != 0, axis=0) >= 2 for part in fifths]
        if np.any((last > least) & (last >= 0.9 * before) & back[0] & back[1]):
            return "limit cycle"
    return "settles"


# --- Both.


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("name", GAINS)
def test_continuous_motions(name: str, m: int) -> None:
    model, given = arm(name), gains(name, heavy=False, m=m)
    seconds, step = (0.5, 1e-5) if name in STIFF else (2.0, 2e-4) if name == "iiwa14" else (T, 1e-3)
    run = simulate(given, model, [GOAL] * model.n, T=seconds, stop=False)
    assert pytest.approx(continuous(model, given, seconds, step), abs=1e-4) == run.L2


LOOPS = ((1000, 0, 0), (1000, 1, 0), (250, 1, 0), (100, 2, 0), (1000, 1, 2))
"""Hz, samples, kg."""


@pytest.mark.parametrize(("name", "heavy", "loop"), [*product(GAINS, (False, True), LOOPS)])
def test_sampled_runs_end_alike(name: str, heavy: bool, loop: tuple[int, int, int]) -> None:
    model, given, (rate, delay, payload) = arm(name), gains(name, heavy), loop
    bench = Bench(period=Fraction(1, rate), delay=delay, unknown_payload=Fraction(payload))
    bench = replace(bench, encoder=2**40)
    run = experiment(given, model, [GOAL] * model.n, T=T, bench=bench)
    other = sampled(model, given, rate, delay, payload)
    mine = "settles" if run.unrest is None else run.unrest.kind
    assert mine == ending(other, model, given)
    if mine == "settles":
        np.testing.assert_allclose(run.q[-1], other.q[-1], rtol=0, atol=2e-3)


def test_gains_that_are_tuned_for_a_computer_settle() -> None:
    """What `tune` finds for the iiwa at 1 kHz, one sample late: overshoot 10 %, settled within 2 s."""
    model = arm("iiwa14")
    task = task_for(model.n, [GOAL] * model.n, None, None, T)
    bench, limits = (
        Trials(Wishes(overshoot=10, settle=2), (task,)),
        limits_with(model),
    )
    found = Search(bench, [model], limits, 1, BY_PROOF, LoopRecord(period=Fraction(1, 1000))).run()
    seen = sampled(model, found.gains, 1000, 1, 0)
    assert ending(seen, model, found.gains) == "settles"
    assert np.max(seen.q) < GOAL * 1.1
    assert np.all(np.abs(GOAL - seen.q[seen.t >= 2]) < 0.02 * GOAL)
    np.testing.assert_allclose(
        found.trial.overshoot, 100 * (seen.q.max(axis=0) / GOAL - 1).clip(0), atol=0.05
    )


@pytest.mark.parametrize(
    ("name", "kp", "kv", "rate", "within"),
    [
        (
            *("ur5", "43.977 23.008 32.827 10.461 10.698 11.429", "17.26 13.477 3.676 0.635 0.732 0.001"),
            *(1000, 5),
        ),
        ("pelican2", "30 7", "6 1.4", 1000, 30),
    ],
)
def test_gains_that_are_proved_from_rest_settle(name: str, kp: str, kv: str, rate: int, within: int) -> None:
    """By (P), one sample late, from corners of its starts."""
    model, random = arm(name), np.random.default_rng(3)
    given = GainSet(name, 1, *([Fraction(word) for word in row.split()] for row in (kp, kv)))
    record = LoopRecord(period=Fraction(1, rate), within=Fraction(within))
    promise, why = AsRun(given, model_limits(model), record, None).from_rest(model)
    assert promise is not None, why
    for corner in random.choice([-1.0, 1.0], (3, model.n)):
        start = GOAL - np.radians(within) * corner
        seen = sampled(model, given, rate, 1, 0, start)
        assert ending(seen, model, given) == "settles"
        assert np.abs(GOAL - seen.q[-1]).max() < 1e-3
