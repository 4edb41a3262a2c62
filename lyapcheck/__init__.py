"""lyapcheck: the Lyapunov proof of bounded hyperbolic robot controllers, checked equation by equation.

The names below are the whole public interface. Each is imported from its home when it is first used, so that
``import lyapcheck`` costs next to nothing.
"""

from __future__ import annotations

TYPE_CHECKING = False  # typing takes longer to import than a short command to run
if TYPE_CHECKING:
    from typing import Any

    from lyapcheck.answers.check import ClaimResult, ProofResult
    from lyapcheck.answers.check.run import run_proof
    from lyapcheck.answers.derive import derivation
    from lyapcheck.answers.epsilon import EpsilonResult
    from lyapcheck.answers.epsilon.compute import epsilon
    from lyapcheck.answers.explain import explain
    from lyapcheck.answers.gate import GateResult, gate
    from lyapcheck.answers.sweep import Plan, Rows, read_plan, sweep
    from lyapcheck.answers.table import Table, build_table
    from lyapcheck.answers.tune import tune as tune_gains
    from lyapcheck.answers.tune.answer import Tuning
    from lyapcheck.answers.tune.targets import Targets
    from lyapcheck.check.numbers.balls import Constants, hyperbolic_constants
    from lyapcheck.check.numbers.polynomials import Enclosure
    from lyapcheck.check.recheck import gather as read_certificates
    from lyapcheck.check.recheck import recheck
    from lyapcheck.claims.claim import Claim, Proof
    from lyapcheck.claims.decision import Decision
    from lyapcheck.constants import RobotConstants, robot_constants
    from lyapcheck.control.gains import Bounds, GainFile, GainSet, paper_gain_file, read_gain_file
    from lyapcheck.control.limits import Limits, limits_for
    from lyapcheck.errors import InputError, Problem
    from lyapcheck.family.base import Family
    from lyapcheck.family.base import named as named_family
    from lyapcheck.family.members.hyperbolic import gamma_less_than
    from lyapcheck.files.loop import LoopEntry
    from lyapcheck.lyapunov.graph import LyapunovGraph, lyapunov_graph
    from lyapcheck.lyapunov.numeric import LyapunovNumeric
    from lyapcheck.report.build import build as build_report
    from lyapcheck.report.model import Subject
    from lyapcheck.robots import load as load_robot
    from lyapcheck.robots import names as robot_names
    from lyapcheck.robots.fields import Number, Vary
    from lyapcheck.robots.numeric import NumericModel
    from lyapcheck.robots.plant import RobotModel
    from lyapcheck.simulate.bench import Bench
    from lyapcheck.simulate.closed_loop import simulate as run_simulation
    from lyapcheck.simulate.reference import read_reference
    from lyapcheck.simulate.run import Run
    from lyapcheck.simulate.tracking import TrackingRun
    from lyapcheck.simulate.tracking import track as run_tracking
    from lyapcheck.simulate.trial import experiment as run_experiment
    from lyapcheck.tasks import (
        bounds,
        decide,
        export_controller,
        simulate_motion,
        torque,
        tune_for_targets,
    )
    from lyapcheck.verdicts import Exit, Grade, Verdict

    __version__: str

__all__ = [
    "Bench",
    "Bounds",
    "Claim",
    "ClaimResult",
    "Constants",
    "Decision",
    "Enclosure",
    "EpsilonResult",
    "Exit",
    "Family",
    "GainFile",
    "GainSet",
    "GateResult",
    "Grade",
    "InputError",
    "Limits",
    "LoopEntry",
    "LyapunovGraph",
    "LyapunovNumeric",
    "Number",
    "NumericModel",
    "Plan",
    "Problem",
    "Proof",
    "ProofResult",
    "RobotConstants",
    "RobotModel",
    "Rows",
    "Run",
    "Subject",
    "Table",
    "Targets",
    "TrackingRun",
    "Tuning",
    "Vary",
    "Verdict",
    "__version__",
    "bounds",
    "build_report",
    "build_table",
    "decide",
    "derivation",
    "epsilon",
    "explain",
    "export_controller",
    "gamma_less_than",
    "gate",
    "hyperbolic_constants",
    "limits_for",
    "load_robot",
    "lyapunov_graph",
    "named_family",
    "paper_gain_file",
    "read_certificates",
    "read_gain_file",
    "read_plan",
    "read_reference",
    "recheck",
    "robot_constants",
    "robot_names",
    "run_experiment",
    "run_proof",
    "run_simulation",
    "run_tracking",
    "simulate_motion",
    "sweep",
    "torque",
    "tune_for_targets",
    "tune_gains",
]

_HOMES = {
    "Bench": "simulate.bench",
    "Bounds": "control.gains",
    "Claim": "claims.claim",
    "ClaimResult": "answers.check",
    "Constants": "check.numbers.balls",
    "Decision": "claims.decision",
    "Enclosure": "check.numbers.polynomials",
    "EpsilonResult": "answers.epsilon",
    "Exit": "verdicts",
    "Family": "family.base",
    "GainFile": "control.gains",
    "GainSet": "control.gains",
    "GateResult": "answers.gate",
    "Grade": "verdicts",
    "InputError": "errors",
    "Limits": "control.limits",
    "LoopEntry": "files.loop",
    "LyapunovGraph": "lyapunov.graph",
    "LyapunovNumeric": "lyapunov.numeric",
    "Number": "robots.fields",
    "NumericModel": "robots.numeric",
    "Plan": "answers.sweep",
    "Problem": "errors",
    "Proof": "claims.claim",
    "ProofResult": "answers.check",
    "RobotConstants": "constants",
    "RobotModel": "robots.plant",
    "Rows": "answers.sweep",
    "Run": "simulate.run",
    "Subject": "report.model",
    "Table": "answers.table",
    "Targets": "answers.tune.targets",
    "TrackingRun": "simulate.tracking",
    "Tuning": "answers.tune.answer",
    "Vary": "robots.fields",
    "Verdict": "verdicts",
    "bounds": "tasks",
    "build_report": "report.build:build",
    "build_table": "answers.table",
    "decide": "tasks",
    "derivation": "answers.derive",
    "epsilon": "answers.epsilon.compute",
    "explain": "answers.explain",
    "export_controller": "tasks",
    "gamma_less_than": "family.members.hyperbolic",
    "gate": "answers.gate",
    "hyperbolic_constants": "check.numbers.balls",
    "limits_for": "control.limits",
    "load_robot": "robots:load",
    "lyapunov_graph": "lyapunov.graph",
    "named_family": "family.base:named",
    "paper_gain_file": "control.gains",
    "read_certificates": "check.recheck:gather",
    "read_gain_file": "control.gains",
    "read_plan": "answers.sweep",
    "read_reference": "simulate.reference",
    "recheck": "check.recheck",
    "robot_constants": "constants",
    "robot_names": "robots:names",
    "run_experiment": "simulate.trial:experiment",
    "run_proof": "answers.check.run",
    "run_simulation": "simulate.closed_loop:simulate",
    "run_tracking": "simulate.tracking:track",
    "simulate_motion": "tasks",
    "sweep": "answers.sweep",
    "torque": "tasks",
    "tune_for_targets": "tasks",
    "tune_gains": "answers.tune:tune",
}
"""The module of each public name, and its name there if that is another."""


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for, and keep it."""
    from importlib import import_module, metadata

    if name == "__version__":
        return metadata.version(__name__)
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, _, inside = _HOMES[name].partition(":")
    value = getattr(import_module(f"{__name__}.{module}"), inside or name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
