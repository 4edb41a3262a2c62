"""What holds for all tests."""

from __future__ import annotations

import gc
import os
import sys

import pytest
from hypothesis import HealthCheck, settings

from lyapcheck import store
from tests.helpers.one_process import one_process

# The same properties in all: ``make test-slow`` looks at more examples, ``make promises`` writes what it has
# looked at. No deadlines: how long an example takes says more of the machine than of the code.
NO_CLOCK = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("fast", NO_CLOCK, max_examples=10)
settings.register_profile("thorough", NO_CLOCK, max_examples=100)
settings.register_profile("promises", NO_CLOCK, max_examples=200, derandomize=True)
settings.load_profile("fast")

# Each of the many processes that tests start would else compile the whole package for itself.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# Nothing of what collection makes is garbage before the end, and it is much to look through again and again.
gc.disable()

# What an earlier run has found is not what is tested, nor does a test leave anything to a later run.
os.environ[store.OFF] = "1"


def pytest_collection_finish() -> None:
    """From here on there is garbage, in what is made from here on."""
    gc.freeze()
    gc.enable()


@pytest.fixture
def few_tries(monkeypatch):
    """Where it is asked whether a proof exists: the search for entries against it may be short."""
    monkeypatch.setattr("lyapcheck.claims.procedures.norm_bounds.TRIES", 20)
    monkeypatch.setattr("lyapcheck.claims.procedures.norm_bounds.TRIES_OF_ONE", 20)


@pytest.fixture(scope="module")
def in_this_process():
    """Scripts run, and certificates are judged, in the process of the test, by the same functions.

    For tests of what is decided. That processes of their own do it, and outlive what scripts and certificates
    do to them, is what tests/claims/test_script_process.py and tests/check/test_recheck_door.py are about.
    """
    with one_process():
        yield
