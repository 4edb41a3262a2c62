"""Loops as a computer runs them: against a loop written by hand, and what is seen of them."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lyapcheck import robots
from lyapcheck.control.gains import GainSet
from lyapcheck.control.sampling import LoopRecord
from lyapcheck.errors import InputError
from lyapcheck.simulate.bench import Bench
from lyapcheck.simulate.task import PAPER_TASK
from lyapcheck.simulate.trial import experiment

PENDULUM = robots.load("pendulum1")
"""1 kg at 0.5 m, 0.5 N·m·s/rad, 10 N·m."""


def gains(kp: float, kv: float) -> GainSet:
    return GainSet("g", 1, (Fraction(kp),), (Fraction(kv),))


def by_hand(kp: float, kv: float, goal: float, bench: Bench, T: float) -> list[float]:
    """Angles of the pendulum at the samples: h_1 = tanh, everything spelled out."""
    period, taps = float(bench.period or 0), [float(x) for x in bench.filter]
    load = 1.0 + float(bench.unknown_payload)
    line = 2 * math.pi / bench.encoder if bench.encoder else 0.0
    speeds, smooth, last = [0.0] * len(taps), 0.0, 0.0
    under_way = [0.0] * bench.delay
    state, angles = [0.0, 0.0], [0.0]
    for _ in range(round(T / period)):
        read = round(state[0] / line) * line if line else state[0]
        speeds = [state[1] if bench.velocity == "measured" else (read - last) / period, *speeds[:-1]]
        last, fresh = read, sum(a * b for a, b in zip(taps, speeds, strict=True))
        if bench.lowpass is None:
            smooth = fresh
        else:
            smooth += (1 - math.exp(-2 * math.pi * float(bench.lowpass) * period)) * (fresh - smooth)
        known = 9.81 * 0.5 * math.sin(read)
        wanted = kp * math.tanh(goal - read) - kv * math.tanh(smooth) + known
        under_way.append(min(max(wanted, -10.0), 10.0))
        tau = under_way.pop(0)

        def rate(_: float, y: list[float], tau: float = tau) -> list[float]:
            pull = (1 + float(bench.gravity_error)) * load * 9.81 * 0.5 * math.sin(y[0])
            return [y[1], (tau - pull - 0.5 * y[1]) / (load * 0.25)]

        state = solve_ivp(rate, (0, period), state, rtol=1e-10, atol=1e-12).y[:, -1].tolist()
        angles.append(state[0])
    return angles


@pytest.mark.parametrize(
    "bench",
    [
        Bench(period=0.01, delay=2),
        Bench(period=0.01, filter=(Fraction(1, 2), Fraction(1, 3), Fraction(1, 6)), delay=1),
        Bench(period=0.02, lowpass=Fraction(20), encoder=500),
        Bench(period=0.01, velocity="measured", gravity_error=0.25),
        Bench(period=0.01, unknown_payload=Fraction(1, 2), delay=3, lowpass=Fraction(5)),
    ],
    ids=lambda bench: bench.text,
)
def test_each_part_of_the_loop_is_that_of_a_loop_by_hand(bench: Bench) -> None:
    run = experiment(gains(4, 2), PENDULUM, [1.0], T=1.0, bench=bench)
    np.testing.assert_allclose(run.q[:, 0], by_hand(4, 2, 1.0, bench, 1.0), rtol=0, atol=1e-6)
    assert run.loop == bench


def test_damping_that_no_computer_can_run_is_seen_as_a_limit_cycle() -> None:
    """The joint of 0.25 kg·m² is unstable for T k_v/J > 2, and its motor bounds the swing."""
    wild = experiment(gains(3, 800), PENDULUM, [1.0], bench=Bench(period=1e-3))
    assert wild.unrest is not None
    assert (wild.unrest.kind, wild.unrest.joint) == ("limit cycle", "pivot")
    assert wild.unrest.torque == pytest.approx(20.0, rel=0.2)
    for calm in (gains(3, 2), gains(3, 100)):
        assert experiment(calm, PENDULUM, [1.0], bench=Bench(period=1e-3)).unrest is None


def test_a_joint_that_creeps_under_dry_friction_is_at_rest() -> None:
    creeping = GainSet("c", 2, (Fraction(25), Fraction(50), Fraction(5)), (Fraction(1, 4),) * 3)
    assert experiment(creeping, robots.load("buap3"), PAPER_TASK.q_d).unrest is None


@pytest.mark.parametrize("kp", [3, 4, 8])
def test_an_unknown_payload_rests_where_the_spring_holds_it_or_falls(kp: int) -> None:
    """k_p tanh(e) = Δg(q) = 0.5 · 9.81 · 0.5 m sin q = 2.4525 sin q, for a k_p above that."""
    load = Bench(period=2e-3, unknown_payload=Fraction(1, 2))
    run = experiment(gains(kp, 3), replace(PENDULUM, torque_limit=(None,)), [1.5], T=10.0, bench=load)
    q = run.q[-1, 0]
    assert kp * math.tanh(1.5 - q) == pytest.approx(2.4525 * math.sin(q), abs=1e-3)
    assert run.unrest is None
    weak = experiment(gains(2, 3), replace(PENDULUM, torque_limit=(None,)), [1.5], T=10.0, bench=load)
    assert weak.unrest is not None
    assert weak.unrest.kind == "falls"
    assert weak.unrest.most == pytest.approx(2.0)
    assert "pivot ends" in weak.unrest.sentence


def test_a_record_without_a_rate_is_run_fast_and_at_once() -> None:
    bench = Bench.of(LoopRecord(unknown_payload=Fraction(1)))
    assert (bench.period, bench.delay, bench.unknown_payload) == (Fraction(1, 4000), 0, 1)
    assert Bench.of(LoopRecord(period=Fraction(1, 100))).delay == 1


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"period": 0.0}, "period = 0: must be from"),
        ({"period": 2.0}, "period = 2: must be from"),
        ({"period": math.nan}, "period = nan"),
        ({"delay": -1}, "delay = -1: must be 0 to"),
        ({"delay": 1.5}, "delay"),
        ({"velocity": "guessed"}, "velocity = guessed: is unknown; use one of difference, measured"),
        ({"creep": 0.0}, "creep"),
    ],
)
def test_loops_that_nobody_can_run_are_refused(given: dict, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Bench(**given)


def test_what_the_arm_cannot_be_given_is_refused() -> None:
    three = GainSet("g", 1, (Fraction(1),) * 3, (Fraction(1),) * 3)
    with pytest.raises(InputError, match="buap3 is given by its inertia matrix"):
        experiment(three, robots.load("buap3"), PAPER_TASK.q_d, bench=Bench(unknown_payload=Fraction(1)))
    with pytest.raises(InputError, match="periods"):
        experiment(gains(3, 2), PENDULUM, [1.0], T=3600.0, bench=Bench(period=1e-6))
