"""The scalar form beyond a radius: below −dV/dt at every state, whatever the gains."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
from flint import arb
from hypothesis import assume, given
from hypothesis import strategies as st

from lyapcheck.check.loop import ScalarForm, certifies
from lyapcheck.check.loop.states import State, rate
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.robots import load
from lyapcheck.search.controlled_arm import ControlledArm

F = Fraction
ARMS = {"reyes-kelly2": "table2_shoulder_elbow", "buap3": "table2"}
CASES = {
    (name, m): ControlledArm(read_gain_file(paper_gain_file(file)).gains[m - 1], load(name))
    for name, file in ARMS.items()
    for m in (1, 2, 3)
}


def drawn(case, random):
    """The loop with gains, friction and ε₀ over decades."""

    def numbers(low, high):
        return tuple(F(float(x)) for x in 10 ** random.uniform(low, high, case.loop(F(1)).n))

    low, more = numbers(-2, 2), numbers(-3, 1)
    ranges = tuple((b, b + x) for b, x in zip(low, more, strict=True))
    loop = case.loop(numbers(-3, 0)[0])
    return replace(loop, kp=numbers(-1, 3), kv=numbers(-2, 2), viscous=ranges)


@given(st.sampled_from(sorted(CASES)), st.integers(0, 10**6))
def test_it_is_below_minus_dV_at_any_state(name, seed):
    """By the chain rule in balls at exact states, many of them with one joint alone away from 0."""
    case, random = CASES[name], np.random.default_rng(seed)
    loop, n = drawn(case, random), case.loop(F(1)).n
    assume(loop.admissible)
    form, friction = loop.tail, tuple(ends[random.integers(2)] for ends in loop.friction)
    arm = replace(case.arm, viscous=friction)
    controller = replace(case.controller, kp=loop.kp, kv=loop.kv)
    for _ in range(20):
        e, w = (random.normal(size=n) * 10 ** random.uniform(-2, 2) * (random.random(n) < 0.6) for _ in "ew")
        if random.random() < 0.5:  # where −dV/dt is smallest: w of the size of ε h(e)
            w = e * float(loop.eps0) * random.uniform(0, 1, n)
        q = random.uniform(-np.pi, np.pi, n)
        state = State(*(tuple(F(float(x)) for x in part) for part in (q, e, w)))
        dV = float(rate(arm, controller, loop.eps0, state))
        eps = float(loop.eps0) / (1 + np.linalg.norm(e))
        a = np.linalg.norm([float(loop.member.h(arb(float(x)))) for x in e])
        b = np.linalg.norm(w)
        least = (
            eps * float(form.stiffness) * a**2
            + (float(form.friction) - eps * float(form.drift)) * b**2
            - eps * (float(form.cross) + eps * float(form.drift)) * a * b
        )
        assert dV <= -least + 1e-9 * (1 + abs(dV) + abs(least))


@given(*[st.fractions(F(1, 1000), 1000) for _ in range(4)], st.fractions(F(1, 1000), 1000))
def test_what_certifies_is_positive_definite_at_every_smaller_eps(k, beta, c, d, eps0):
    form = ScalarForm(k, beta, c, d)
    assume(certifies(form, eps0))
    for share in (F(1), F(9, 10), F(1, 2), F(1, 100)):
        eps = share * eps0
        side = eps * (d + eps * c) / 2
        assert eps * k * (beta - eps * c) > side**2
        assert eps * k > 0
