"""A sensitivity study as plain data: °, s, N·m and the arm's SI units, to six digits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from studies.printed_experiment.results import AtOnce, NumberStudy, SetStudy, Study


def study_json(study: Study) -> dict[str, Any]:
    """Everything in a study."""
    names = [one.name for one in study.assumed]
    together = study.together
    return {
        "robot": study.robot,
        "model": MODEL,
        "seed": study.seed,
        "spread": study.spread,
        "corners": study.corners,
        "search": study.search,
        "runs": study.runs,
        "assumed": [
            {"name": one.name, "words": one.words, "unit": one.unit}
            | {end: _plain(getattr(one, end)) for end in ("low", "nominal", "high")}
            for one in study.assumed
        ],
        "sets": [_set(one, study, names) for one in study.sets],
        "together": None
        if together is None
        else _at_once(together.nearest, names) | {"ordered": _plain(together.ordered)},
    }


MODEL = (
    "torque held for 2.5 ms, encoders read to the line, velocity by backward difference, torque cut at the "
    "motors' limits, Coulomb friction that lets joints stick"
)


def _set(one: SetStudy, study: Study, names: Sequence[str]) -> dict[str, Any]:
    return {
        "name": one.name,
        "m": one.m,
        "numbers": [_number(number, study, names) for number in one.numbers],
        "at_once": _at_once(one.at_once, names),
        "figure_gains": {"kp": _list(one.figure_gains.kp), "L2": _plain(one.figure_gains.L2)},
    }


def _number(one: NumberStudy, study: Study, names: Sequence[str]) -> dict[str, Any]:
    printed, shares = one.printed, one.shares
    return {
        "quantity": printed.quantity,
        "joint": None if printed.joint is None else study.joints[printed.joint],
        "unit": printed.unit,
        "printed": printed.value,
        "at_most": printed.at_most,
        "source": printed.source,
        "nominal": _plain(one.nominal),
        "low": _plain(one.low),
        "high": _plain(one.high),
        "typical": _list(one.typical),
        "unsettled": _plain(one.unsettled),
        "alone": {name: _list(ends) for name, ends in zip(names, one.alone, strict=True)},
        "shares": None if shares is None else dict(zip(names, _list(shares), strict=True)),
        "answer": one.answer.value,
        "nearest": _plain(one.nearest),
        "at": _at(one.at, names),
        "runs": one.runs,
    }


def _at_once(one: AtOnce, names: Sequence[str]) -> dict[str, Any]:
    result = {"values": _list(one.values), "worst": _plain(one.worst), "arms": one.arms}
    return result | {"at": _at(one.at, names)}


def _at(values: Sequence[float] | None, names: Sequence[str]) -> dict[str, float | None] | None:
    return None if values is None else dict(zip(names, _list(values), strict=True))


def _list(values: Sequence[float | None]) -> list[float | None]:
    return [_plain(value) for value in values]


def _plain(value: float | None) -> float | None:
    """Six digits, and no negative zero."""
    return None if value is None else float(f"{value:.6g}") + 0.0
