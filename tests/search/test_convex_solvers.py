"""The one place where a convex solver is asked: however it ends, something is said."""

import clarabel
import cvxpy as cp
import numpy as np
import pytest

from lyapcheck.convex import PANIC, Ended, solved, solved_cones


class Panic(BaseException):
    """As Rust's panics come to Python."""


Panic.__name__ = PANIC


def ask(aim, *constraints, variables=()):
    return solved(aim, constraints, variables)


def test_what_has_no_answer_says_why():
    x = cp.Variable()
    assert ask(x, x <= 1, x >= 2, variables=[x]).reason == "Clarabel says infeasible"
    assert ask(x, variables=[x]).reason == "Clarabel says unbounded"


@pytest.mark.parametrize("error", [cp.SolverError("no\nluck"), ValueError("no luck"), Panic("no luck")])
def test_what_a_solver_raises_is_a_reason(monkeypatch, error):
    def fail(self, **_):
        raise error

    monkeypatch.setattr(cp.Problem, "solve", fail)
    x = cp.Variable()
    solution = ask(x, x <= 1, variables=[x])
    assert (solution.ended, solution.values) == (Ended.FAILED, ())
    assert solution.reason.endswith("Error: no luck") or solution.reason == f"{PANIC}: no luck"


@pytest.mark.parametrize("error", [KeyboardInterrupt(), SystemExit(3)])
def test_a_user_who_has_enough_is_obeyed(monkeypatch, error):
    def stop(self, **_):
        raise error

    monkeypatch.setattr(cp.Problem, "solve", stop)
    with pytest.raises(type(error)):
        ask(cp.Variable(), variables=())


@pytest.mark.parametrize(
    ("status", "value", "ended"),
    [
        (cp.OPTIMAL_INACCURATE, 1.0, Ended.ALMOST),
        (cp.OPTIMAL, 1.0, Ended.SOLVED),
        (cp.OPTIMAL, float("nan"), Ended.FAILED),
        (cp.OPTIMAL, None, Ended.FAILED),
        (cp.INFEASIBLE_INACCURATE, 1.0, Ended.FAILED),
        (cp.USER_LIMIT, 1.0, Ended.FAILED),
    ],
)
def test_almost_is_told_from_solved_and_both_from_failed(monkeypatch, status, value, ended):
    x = cp.Variable()

    def solve(self, **_):
        self._status = status
        if value is not None:
            x.save_value(np.array(value))

    monkeypatch.setattr(cp.Problem, "solve", solve)
    solution = ask(x, x <= 1, variables=[x])
    assert solution.ended is ended
    assert bool(solution.values) == (ended is not Ended.FAILED)
    assert bool(solution.reason) == (ended is not Ended.SOLVED)


def least(constant, tolerance=1e-8):
    """The least x with x ≥ 1 and x·0 ≤ constant."""
    one = np.eye(1)
    return solved_cones(np.ones(1), [(-one, {0: one}), (constant * one, {0: 0 * one})], tolerance)


def test_of_matrices_without_an_answer_the_last_point_is_kept_apart():
    solution = least(-1.0)
    assert solution.ended is Ended.FAILED
    assert solution.reason in {"Clarabel says PrimalInfeasible", "Clarabel gives no numbers"}


def test_what_clarabel_raises_is_a_reason(monkeypatch):
    def fail(*_):
        raise Panic("no luck")

    monkeypatch.setattr(clarabel, "DefaultSolver", fail)
    assert least(1.0).reason == f"{PANIC}: no luck"
