"""Long lists of cases: a share for the fast tests, the rest for the slow ones."""

import pytest


def one_in(count, cases):
    """The same cases for ``parametrize``; all but the first and each ``count``-th from it are slow."""
    return [case if k % count == 0 else _slow(case) for k, case in enumerate(cases)]


def but(fast, cases):
    """The same cases for ``parametrize``; all but the ``fast`` ones are slow."""
    kept = list(fast)
    result = list(cases)
    assert all(case in result for case in kept), "a fast case is one of the cases"
    return [case if case in kept else _slow(case) for case in result]


def _slow(case):
    values = case if type(case) is tuple else (case,)  # a named tuple is one value
    return pytest.param(*values, marks=pytest.mark.slow)
