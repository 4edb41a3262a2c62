"""Gains on a computer: (S) against constants of its own, against simulated loops, and at its border."""

from __future__ import annotations

import math
import random
from dataclasses import replace
from fractions import Fraction as F
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from lyapcheck import asked
from lyapcheck.check.kinds.all_of import AllOf, EveryPart
from lyapcheck.check.kinds.chain import ChainAbove, OwnMoments
from lyapcheck.check.kinds.inertia import Bisection, MassAbove
from lyapcheck.check.kinds.sampled import SampledStable
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.claims import run_proof
from lyapcheck.control.gains import GainSet
from lyapcheck.control.sampling import (
    LoopRecord,
    judged_sampled,
    largest_periods,
    require_sampled,
    sampled_proof,
)
from lyapcheck.robots import load
from tests import oracle
from tests.helpers.committed import read
from tests.helpers.shares import one_in
from tests.oracle.numbers import supremum

PRINTED, NOTHING = read("good/printed.sam")
"""The paper's, from printed numbers: b_2 > 0.233 + T/2·(60 + 40.28 + 1.81)."""
ONE, SHOWN = read("good/potential.sam")
"""g = p sin q, p in [1, 2], read with jitter: 5 > 2·(1 + ½·T·(6 + 2)), so that T < 3/8 is enough."""
TWO, BOTH = read("good/links.sam")
"""|g_1| ≤ 3 and |g_2| ≤ 1: 12 > 1 + 3/2·T·(6 + 3 + 1), so that T < 11/15 is enough."""
GAINS = {1: ((28, 60, 5), "0.233"), 2: ((27, 50, 5), "0.223"), 3: ((25, 50, 5), "0.223")}
LONGEST = {(1, 0): 3.389, (2, 0): 3.379, (3, 0): 2.185, (1, 1): 1.129, (2, 1): 1.126, (3, 1): 0.7283}
"""ms, of the paper's gains without and with a sample of delay, rounded down."""


def printed(m: int, **others: Any) -> SampledStable:
    kp, kv = GAINS[m]
    return replace(PRINTED, m=m, kp=tuple(map(F, kp)), kv=(F(kv),) * 3, **others)


@pytest.mark.parametrize(("m", "delay"), LONGEST)
def test_the_longest_periods_of_the_paper_are_those_of_constants_of_ones_own(m: int, delay: int) -> None:
    kp, kv = GAINS[m]
    with mp.workdps(40):
        rho, secant = (mpf(1) if m == 1 else mpf(str(supremum(name, m, 40))) for name in ("rho", "L"))
        steep = (0, mpf("40.28") + mpf("1.81"), 2 * mpf("1.81"))
        rows = zip(kp, steep, strict=True)
        most = min((mpf("0.406") - secant * mpf(kv)) / ((0.5 + delay) * (rho * k + g)) for k, g in rows)
        found = min(largest_periods(printed(m, delay=delay)))
        assert abs(mpf(found.numerator) / found.denominator / most - 1) < mpf(10) ** -25
    assert 0 < 1000 * found - F(str(LONGEST[m, delay])) < F(1, 1000)
    for share, shown in ((F(999_999, 10**6), "proved"), (F(1), "undecided")):
        assert judged_sampled(printed(m, delay=delay, period=share * found)).shown == shown


def test_the_claims_of_the_paper_and_what_the_third_lacks() -> None:
    rows = {
        row.id: row
        for row in run_proof(
            "sampled.py", only=[f"sampled.m{m}{x}" for m in GAINS for x in ("", ".late")]
        ).claims
    }
    verdicts = {name: row.verdict.value for name, row in rows.items()}
    assert verdicts == {
        name: "proved" if name in ("sampled.m1", "sampled.m2") else "undecided" for name in rows
    }
    assert "T < 2.185 ms; b_2 > 0.4334 N·m·s/rad would do" in rows["sampled.m3"].decision.reason
    granted = " ".join(rows["sampled.m1"].decision.granted)
    for words in ("at once", "no interval", "unwrapped", "that of the arm", "b_i ≥", "serial"):
        assert words in granted


def light(seed: int) -> SampledStable:
    """One joint, h with slope 1 at 0, no delay: there (S) is exact for an arm without inertia."""
    draw = random.Random(seed)
    kp, kv = (F(draw.randint(1, 400), 10) for _ in range(2))
    friction = kv + F(draw.randint(1, 100), 10)
    one = replace(PRINTED, kp=(kp,), kv=(kv,), viscous_min=(friction,), k_g=(F(0),))
    border = min(largest_periods(one))
    assert border == 2 * (friction - kv) / kp
    return replace(one, period=border)


@pytest.mark.parametrize("seed", one_in(4, range(12)))
def test_a_light_arm_is_unstable_just_beyond_the_border(seed: int) -> None:
    border = light(seed)
    assert oracle.objection(replace(border, period=border.period * F(1001, 1000))) is not None
    assert oracle.objection(replace(border, period=border.period * F(999, 1000))) is None


@pytest.mark.parametrize("seed", one_in(4, range(10)))
def test_nothing_is_found_against_what_is_proved(seed: int) -> None:
    draw = random.Random(seed)
    n = draw.randint(1, 3)
    some = [tuple(F(draw.randint(1, 300), 10) for _ in range(n)) for _ in range(3)]
    taps = tuple(F(draw.randint(-9, 9), 10) for _ in range(draw.randint(1, 3)))
    one = replace(
        PRINTED,
        m=draw.randint(1, 4),
        kp=some[0],
        kv=some[1],
        k_g=some[2],
        taps=taps,
        delay=draw.randint(0, 2),
    )
    one = replace(one, period=F(1, draw.randint(50, 2000)), stretch=F(draw.randint(10, 20), 10))
    one = replace(one, viscous_min=tuple(x * F(1_000_001, 10**6) for x in one.needed(one.k_g)))
    assert judged_sampled(one).shown == "proved"
    assert oracle.objection(one, seed) is None


def h(m: int, x: Any) -> Any:
    x = np.clip(x, -40, 40)
    return np.sinh(x) ** (2 * m - 1) * np.cosh(x) / (1 + np.sinh(x) ** (2 * m))


def steps(one: SampledStable, draw: random.Random) -> list[float]:
    """The stored energy W at each reading of a pendulum under these gains."""
    (kp, kv, b, pull), m, T, d = (
        (float(x[0]) for x in (one.kp, one.kv, one.viscous_min, one.k_g)),
        one.m or 1,
        float(one.period),
        one.delay,
    )
    inertia, goal, taps = (
        b * T * 10 ** draw.uniform(-0.5, 2),
        draw.uniform(-3, 3),
        [float(f) for f in one.taps],
    )
    q, w = draw.uniform(-3, 3), draw.uniform(-3, 3)
    past = [q + draw.uniform(-1, 1) for _ in range(d + len(taps))]
    rho, secant = (1.0 if m == 1 else float(supremum(name, m, 20)) for name in ("rho", "L"))
    charges = [kv * secant / T * abs(f) / 2 for f in taps[::-1]] + [(rho * kp + pull) / 2] * d
    energies = []
    for _ in range(200):
        read = [q, *past]
        v = sum(f * (read[d + j] - read[d + j + 1]) for j, f in enumerate(taps)) / T
        torque = kp * h(m, goal - read[d]) - kv * h(m, v) + pull * math.sin(read[d])
        moved = [x - y for x, y in pairwise(read)][::-1]  # the oldest first
        stored = sum(sum(charges[: k + 1]) * x * x for k, x in enumerate(moved))
        potential = kp * math.log(1 + math.sinh(goal - q) ** (2 * m)) / (2 * m)
        energies.append(inertia * w * w / 2 + potential + stored)
        span = float(one.stretch) * T * draw.uniform(0.2, 1)
        count = 12
        for _ in range(count):
            q, w = runge_kutta(
                q, w, span / count, lambda x, y, held=torque: (held - pull * math.sin(x) - b * y) / inertia
            )
        past = read[: d + len(taps)]
    return energies


def runge_kutta(q: float, w: float, s: float, force: Any) -> tuple[float, float]:
    a = w, force(q, w)
    b = w + s / 2 * a[1], force(q + s / 2 * a[0], w + s / 2 * a[1])
    c = w + s / 2 * b[1], force(q + s / 2 * b[0], w + s / 2 * b[1])
    d = w + s * c[1], force(q + s * c[0], w + s * c[1])
    return tuple(
        x + s / 6 * (i + 2 * j + 2 * k + l) for x, i, j, k, l in zip((q, w), a, b, c, d, strict=True)
    )


@pytest.mark.parametrize("seed", range(8))
def test_the_energy_of_the_theorem_falls_from_reading_to_reading(seed: int) -> None:
    """With jitter, delay and filters, just inside the border; the theorem's own W, by a simulation."""
    draw = random.Random(seed)
    taps = tuple(F(draw.randint(-9, 9) or 1, 10) for _ in range(draw.randint(1, 3)))
    one = replace(
        PRINTED,
        m=draw.randint(1, 3),
        kp=(F(draw.randint(10, 300), 10),),
        kv=(F(draw.randint(1, 30), 10),),
        k_g=(F(draw.randint(0, 200), 10),),
        taps=taps,
        delay=draw.randint(0, 2),
        period=F(1, draw.randint(20, 400)),
        stretch=F(draw.randint(10, 20), 10),
    )
    one = replace(one, viscous_min=(one.needed(one.k_g)[0] * F(1001, 1000),))
    assert judged_sampled(one).shown == "proved"
    energies = steps(one, draw)
    assert all(after <= before + 1e-6 * (1 + before) for before, after in pairwise(energies))
    assert energies[-1] < energies[0]


@pytest.mark.parametrize("name", one_in(3, ["reyes-kelly2", "ur5", "panda"]))
def test_no_slope_of_gravity_is_above_the_smaller_bound(name: str) -> None:
    arm = load(name)
    ones = (F(1),) * arm.n
    one = asked.sampled(GainSet("", 1, ones, ones), LoopRecord(F(1, 1000), delay=0), ones, arm)
    bounds = [float(k) for k in sampled_proof(one).k_g]
    generator = np.random.default_rng(1)
    for _ in range(20):
        q = generator.uniform(-math.pi, math.pi, arm.n)
        for j in range(arm.n):
            up, down = (
                np.array(arm.at(np.sin(x), np.cos(x), float).gravity())
                for x in (q + 1e-5 * np.eye(arm.n)[j], q - 1e-5 * np.eye(arm.n)[j])
            )
            slope = np.abs(up - down) / 2e-5
            assert all(slope[i] <= min(bounds[i], bounds[j]) + 1e-6 for i in range(arm.n))


@pytest.mark.parametrize(
    ("loop", "words"),
    [
        ({"velocity": "measured"}, 'take velocity = "difference"'),
        ({"angles": "wrapped"}, "add the turns"),
        ({"delay": F(1, 2)}, "whole samples"),
        ({"delay": -1}, "whole samples"),
        ({"filter": "lowpass"}, "cut one off that never ends"),
        ({"filter": ()}, "1 to 1000"),
        ({"longest": F(1, 2000)}, "give the longest interval"),
        ({"period": F(0)}, "give seconds"),
    ],
)
def test_a_loop_that_it_does_not_speak_of_is_refused_with_what_to_do(
    loop: dict[str, Any], words: str
) -> None:
    angles = loop.pop("angles", "unwrapped")
    with pytest.raises(ValueError, match=words):
        require_sampled(LoopRecord(**({"period": F(1, 1000)} | loop)), angles)


def test_a_conjunction_is_about_one_arm_whichever_way_it_is_given() -> None:
    heavy = tuple(replace(link, mass=link.mass * 2) for link in TWO.links)
    chain = ChainAbove(TWO.links, F(0)), OwnMoments()
    for one, shown, (part, own) in (
        (TWO, BOTH, chain),
        (ONE, SHOWN, (MassAbove(ONE.mass, ONE.parameters, F(0)), Bisection())),
        (PRINTED, NOTHING, chain),
    ):
        both = AllOf((("arm", part), ("loop", one)))
        assert verify(both, EveryPart((own, shown))).verdict == "proved"
    with pytest.raises(Refused, match="another M"):
        AllOf((("arm", chain[0]), ("loop", replace(TWO, links=heavy)))).require_well_formed()
