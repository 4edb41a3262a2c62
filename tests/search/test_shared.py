"""Branch and bound on several processes: the same boxes, in the same order, to the last byte."""

from __future__ import annotations

from concurrent.futures import Executor, Future
from fractions import Fraction
from typing import Any

import pytest

from lyapcheck.control.gains import GainSet
from lyapcheck.robots import load
from lyapcheck.search import shared
from lyapcheck.search.certified import certified_epsilon
from lyapcheck.search.controlled_arm import ControlledArm

GAINS = GainSet("one", 1, (Fraction(20), Fraction(5)), (Fraction(1, 5), Fraction(1, 5)))


class Here(Executor):
    """Takes every slice in this process, and counts them."""

    def __init__(self) -> None:
        self.slices: list[int] = []

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.slices.append(len(args[1]))
        done: Future[Any] = Future()
        done.set_result(fn(*args, **kwargs))
        return done


def certified(budget: int, jobs: int = 1) -> Any:
    found = certified_epsilon(ControlledArm(GAINS, load("reyes-kelly2")), Fraction(8, 10), budget, jobs)
    return found.looked_at, found.reason, found.proof and found.proof.certificate


@pytest.mark.parametrize("budget", [600, 200])
def test_slices_change_nothing(monkeypatch: pytest.MonkeyPatch, budget: int) -> None:
    alone = certified(budget)
    monkeypatch.setattr(shared, "WORTH", 8)
    pool = Here()
    with shared.boxes_shared(3, pool):
        assert certified(budget) == alone
    assert len(pool.slices) >= 3 * shared.SLICES
    assert len(set(pool.slices)) > 1


@pytest.mark.slow
def test_processes_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    alone = certified(600)
    monkeypatch.setattr(shared, "WORTH", 8)
    assert certified(600, jobs=2) == alone
