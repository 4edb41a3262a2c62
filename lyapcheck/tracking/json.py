"""Tracking runs as plain data."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from fractions import Fraction
from importlib.metadata import version
from typing import Any

import numpy as np

from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.files import decimal_text
from lyapcheck.simulate.render import SCHEMA
from lyapcheck.tracking.run import TrackingRun


def as_json(runs: Sequence[TrackingRun]) -> str:
    """Schema ``lyapcheck/simulate/1`` with ``kind: tracking``: degrees, N·m, s, J; rates in rad/s."""
    notes = list(dict.fromkeys(note for run in runs for note in run.notes))
    results = [result_json(run) for run in runs]
    data = {"schema": SCHEMA, "version": version("lyapcheck"), "results": results, "notes": notes}
    return json.dumps(data, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def result_json(run: TrackingRun) -> dict[str, Any]:
    """One run; ``None`` where there is no number. What is promised is rounded outward."""
    found, motion = run.indices, run.motion
    return {
        "name": run.name,
        "m": run.gains.family.m,
        "robot": run.robot,
        "kind": "tracking",
        "reference": run.reference.sentence,
        "complete": run.complete,
        "time": run.T,
        "reached": _plain(motion.t[-1]),
        "start": _list(np.degrees(motion.q[0])),
        "joints": list(run.joints),
        "L2": _plain(found.L2),
        "rms": _list(found.rms),
        "peak_error": _list(found.peak_error),
        "final_error": _list(found.final_error),
        "band": _plain(math.degrees(run.band)),
        "entered": _list(found.entered),
        "peak_torque": _list(found.peak_torque),
        "torque_limit": list(run.torque_limit),
        "V_start": _plain(run.V[0]),
        "V_end": _plain(run.V[-1]),
        "accuracy": _plain(run.accuracy),
        "work_balance": _plain(run.work_balance),
        "seen": {
            "reference_speed": _plain(run.seen_speed),
            "error_rate": _plain(float(np.max(np.linalg.norm(motion.w, axis=1)))),
            "tightness": _plain(run.tightness),
        },
        "promised": _promise(run),
        "breach": None if run.breach is None else run.breach.data,
    }


def _promise(run: TrackingRun) -> dict[str, Any]:
    promise, torque = run.promise, run.promise.torque
    return {
        "reference_speed": _up(promise.suprema.speed),
        "reference_acceleration": _up(promise.suprema.push),
        "eps0": promise.eps0,
        "largest_eps0": None if promise.largest is None else decimal_text(promise.largest),
        "V_falls": promise.falls,
        "reason": promise.reason,
        "torque_bound": None if torque is None else [_up(x) for x in torque.total],
        "error_rate": None if torque is None else _up(torque.error_rate),
    }


def _up(value: Fraction) -> float:
    """The smallest double that is not below."""
    return Enclosure(value, value).float_upper


def _plain(value: float) -> float | None:
    """The number to nine digits, which is what the accuracy of a run supports; none for NaN."""
    return float(f"{value:.9g}") if math.isfinite(value) else None


def _list(values: Iterable[float]) -> list[float | None]:
    return [_plain(float(x)) for x in values]
