"""Tuned gains as plain data."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from lyapcheck.answers.tune.results import ComparedJoint, GainComparison, TunedJoint, TunedSet
from lyapcheck.answers.tune.targets import Targets
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.control.limits import Limits
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.digits import decimals

DIGITS = 20


def targets_data(targets: Targets) -> dict[str, Any]:
    """What was asked for; numbers as decimal strings."""
    return {
        "digits": targets.digits,
        "peak_share": _texts(targets.peak_share),
        "kv_share": _texts(targets.kv_share),
        "kv_min": _texts(targets.kv_min),
        "damping": _texts(targets.damping),
    }


def limits_data(limits: Limits) -> dict[str, Any]:
    """What the gains were tuned to, N·m and N·m·s/rad."""
    return {
        "torque": [None if limit is None else decimal_text(limit) for limit in limits.torque],
        "gravity": _texts(limits.gravity),
        "viscous_min": None if limits.viscous_min is None else decimal_text(limits.viscous_min),
    }


def joint_records(sets: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """A row a joint of each member, with what it is compared with; a row a member that has no gains."""
    rows = []
    for item in sets:
        head = {key: item[key] for key in ("name", "m", "status")}
        beside = {joint["joint"]: joint for joint in (item["comparison"] or {}).get("joints", ())}
        for joint in item["joints"]:
            compared = {key: value for key, value in beside.get(joint["joint"], {}).items() if key != "joint"}
            broken = {"broken": ", ".join(compared["broken"])} if compared else {}
            rows.append(head | joint | ({"compared": compared | broken} if compared else {}))
        if not item["joints"]:
            rows.append(head | {"reasons": "; ".join(item["reasons"])})
    return rows


def set_data(item: TunedSet, digits: int) -> dict[str, Any]:
    """The gains of one member, what ends each, and what they are compared with."""
    return {
        "name": item.name,
        "m": item.m,
        "status": item.status,
        "reasons": list(item.reasons),
        "joints": [_joint(joint, digits) for joint in item.joints],
        "program": item.program or None,
        "comparison": None if item.comparison is None else _comparison(item.comparison),
    }


def _joint(joint: TunedJoint, digits: int) -> dict[str, Any]:
    return {
        "joint": joint.name,
        "kp": decimal_text(joint.kp, digits),
        "kv": decimal_text(joint.kv, digits),
        "kp_bound": joint.kp_bound,
        "kv_bound": joint.kv_bound,
        "sum_limit": _ends(joint.sum_limit),
        "kv_limit": _ends(joint.kv_limit),
        "damping": None if joint.damping is None else decimal_text(joint.damping),
    }


def _comparison(comparison: GainComparison) -> dict[str, Any]:
    return {
        "name": comparison.name,
        "source": comparison.source,
        "joints": [_compared(joint) for joint in comparison.joints],
    }


def _compared(joint: ComparedJoint) -> dict[str, Any]:
    return {
        "joint": joint.name,
        "kp": decimal_text(joint.kp),
        "kv": decimal_text(joint.kv),
        "kp_left": decimal_text(joint.kp_left),
        "kp_left_share": decimal_text(joint.kp_left_share),
        "used": decimal_text(joint.used),
        "broken": list(joint.broken),
    }


def _ends(value: Enclosure) -> dict[str, str]:
    return dict(zip(("lower", "upper"), decimals(value, DIGITS), strict=True))


def _texts(values: Sequence[Fraction] | None) -> list[str] | None:
    return None if values is None else [decimal_text(value) for value in values]
