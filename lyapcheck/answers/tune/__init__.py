"""Tuning: the largest gains that an arm's limits admit, by a convex program and exact rounding."""

from lyapcheck.answers.tune.answer import Tuning
from lyapcheck.answers.tune.bench_answer import BenchTuning
from lyapcheck.answers.tune.bench_tuning import tune_for
from lyapcheck.answers.tune.gain_file import gain_file_text
from lyapcheck.answers.tune.results import TunedJoint, TunedSet
from lyapcheck.answers.tune.targets import Targets
from lyapcheck.answers.tune.tuning import tune
from lyapcheck.answers.tune.wishes import Bench, Wishes

__all__ = [
    "Bench",
    "BenchTuning",
    "Targets",
    "TunedJoint",
    "TunedSet",
    "Tuning",
    "Wishes",
    "gain_file_text",
    "tune",
    "tune_for",
]
