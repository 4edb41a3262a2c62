"""Branch and bound on several processes: the same boxes, in the same order, to the last byte."""

from __future__ import annotations

from concurrent.futures import Executor, Future
from fractions import Fraction

import pytest

from lyapcheck.control.gains import GainSet
from lyapcheck.robots import load
from lyapcheck.search import branch_and_bound as shared
from lyapcheck.search import cover
from lyapcheck.search.branch_and_bound import certify
from lyapcheck.search.certified import certified_epsilon
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.schur import SchurProblem
from tests.helpers.shares import but

GAINS = GainSet("one", 1, (Fraction(20), Fraction(5)), (Fraction(1, 5), Fraction(1, 5)))


class Here(Executor):
    """Takes every task in this process, and counts the boxes whose subtrees they are."""

    def __init__(self):
        self.hands: list[int] = []

    def submit(self, fn, /, *args, **kwargs):
        self.hands.append(len(args[1]))
        done = Future()
        done.set_result(fn(*args, **kwargs))
        return done


def certified(budget, jobs=1):
    found = certified_epsilon(ControlledArm(GAINS, load("reyes-kelly2")), Fraction(8, 10), budget, jobs)
    return found.looked_at, found.reason, found.proof and found.proof.certificate


@pytest.fixture
def early(monkeypatch):
    """Small levels are worth it too."""
    monkeypatch.setattr(cover, "FEW", 8)
    monkeypatch.setattr(shared, "WORTH", 16)


ENDS = [
    (Fraction(85, 100), 20_000, cover.RESISTS),
    (Fraction(8, 10), 20_000, ""),
    *((Fraction(80, 100), most, cover.EXHAUSTED) for most in (150, 250, 346)),
]


@pytest.mark.parametrize(("eps0", "budget", "reason"), but([ENDS[0], ENDS[2]], ENDS))
def test_a_search_ends_where_that_of_one_process_does(early, eps0, budget, reason):
    """At the same level with the same point, count and tree, whoever has found which part of it."""
    loop = ControlledArm(GAINS, load("reyes-kelly2")).loop(eps0)
    outcomes, rounds = [], []
    for jobs in (1, 2, 3):
        pool = Here()
        with shared.boxes_shared(jobs, pool):
            one = certify(SchurProblem(loop), budget)
        point = None if one.point is None else one.point.tolist()
        outcomes.append((one.proved, one.boxes, one.reason, point, one.tree))
        rounds.append(len(pool.hands))
    assert outcomes[0][2] == reason
    assert outcomes[1:] == outcomes[:1] * 2
    assert rounds[0] == 0
    assert rounds[2] >= 3 * shared.HANDS
