"""Whether a judged statement answers the question that was asked, field by field.

A sentence with a promise speaks about the question: the arm with every range, the gains, the printed number.
The proof speaks about a statement. Both are statements of one kind; this file compares them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from functools import partial
from operator import eq, ge, le
from typing import Any

from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.statement import Statement


def _wider(shown: Any, asked: Any) -> bool:
    """Each range that was asked for lies within the one that is shown."""
    return len(shown) == len(asked) and all(
        low <= a and b <= high for (low, high), (a, b) in zip(shown, asked, strict=True)
    )


def _each(shown: Any, asked: Any, holds: Callable[[Any, Any], bool]) -> bool:
    """``None`` asks nothing, and shows nothing."""
    if isinstance(asked, tuple):
        same = isinstance(shown, tuple) and len(shown) == len(asked)
        return same and all(_each(a, b, holds) for a, b in zip(shown, asked, strict=True))
    return asked is None or (shown is not None and holds(shown, asked))


def _each_covers(shown: Any, asked: Any) -> bool:
    """Each statement that was asked for is covered by the one in its place."""
    try:
        for have, want in zip(shown, asked, strict=False):
            require_covered(have, want)
    except Refused:
        return False
    return len(shown) == len(asked)


Row = Callable[[Any, Any], bool]
_at_least: Row = partial(_each, holds=ge)
_at_most: Row = partial(_each, holds=le)
_same: Row = eq
_ARM: dict[str, Row] = {"mass": _same, "parameters": _wider}
_LOOP: dict[str, Row] = _ARM | {"viscous": _wider, **dict.fromkeys(("family", "m", "kp", "kv"), _same)}
_CHAIN: dict[str, Row] = {"links": _same}
ROWS: dict[str, dict[str, Row]] = {
    "MassSymmetric": _ARM,
    "MassAbove": _ARM | {"low": _at_least},
    "MassBelow": _ARM | {"high": _at_most},
    "CoriolisBelow": _ARM | {"high": _at_most},
    **dict.fromkeys(
        ("CoriolisAtRest", "RateOfMass", "RateLessTwiceCoriolis", "CoriolisTorque"), _ARM | {"printed": _same}
    ),
    "GravityBelow": {"joints": _same, "gravity": _same, "parameters": _wider, "high": _at_most},
    "GravityOfPotential": {"gravity": _same, "potential": _same, "parameters": _wider},
    "ChainIdentity": _CHAIN | {"identity": _same},
    "ChainAbove": _CHAIN | {"low": _at_least},
    "ChainBelow": _CHAIN | {"high": _at_most},
    "ChainGravityBelow": _CHAIN | {"fall": _same, "joints": _same, "high": _at_most},
    # V itself depends on ε₀, so that a proof for one ε₀ is none for a smaller one
    "Decreasing": _LOOP | {"eps0": _same, "coupling": _same},
    "ChainDecreasing": _CHAIN
    | {"viscous": _wider, **dict.fromkeys(("family", "m", "kp", "kv", "eps0"), _same)},
    # more friction than was asked about leaves larger errors
    "Resting": dict.fromkeys(("family", "m", "kp"), _same) | {"torque": _at_least, "errors": _at_most},
    # A conjunction, so that fewer conditions follow. Of the ranges each part is *for all*: gravity for all
    # parameters, and (19) by the least viscous end. (10), (10p) and (10i) grow with each τmax;
    # no limit is asked as ``None``. But k_g is a
    # bound in two directions, of gravity from above and of the gains from below, and so the same.
    "GateAccepted": dict.fromkeys(("joints", "gravity", "potential", "k_g", "family", "m", "kp", "kv"), _same)
    | {"parameters": _wider, "viscous": _wider, "limits": _at_most, "stability": _each_covers}
    | {"conditions": lambda shown, asked: [one for one in shown if one in asked] == [*asked]},
    # for every T up to the period; a bound of gravity and the least friction are hypotheses
    "SampledStable": dict.fromkeys(("family", "m", "kp", "kv", "links", "fall", "mass", "potential"), _same)
    | dict.fromkeys(("delay", "taps", "conclusion"), _same)
    | dict.fromkeys(("k_g", "period", "stretch"), _at_least)
    | {"viscous_min": _at_most, "parameters": _wider},
    # at exactly this period; "for every start within": a smaller set of starts follows
    "SampledFromRest": _LOOP | dict.fromkeys(("potential", "period", "delay"), _same) | {"within": _at_least},
    "StableArm": dict.fromkeys(("argument", "arm", "gains", "numbers"), _same),
}
"""For each kind, how a field that is shown must stand to the one that was asked for.

Only a kind that says *for all arms in these ranges* may have ``_wider`` here: where ranges stand in a
hypothesis, the direction turns.
"""


def require_covered(shown: Statement, asked: Statement) -> None:
    """Refuse unless what is shown implies what was asked.

    ``asked`` is the question as a statement of the same kind, with the numbers that are printed.

    Soundness: each row of ``ROWS`` is a direction in which statements of that kind are monotone. A kind or a
        field without a row is refused, unless both statements are equal.
    """
    kind = type(asked).__name__
    require(type(shown) is type(asked), "statement", type(shown).__name__, f"was asked for as {kind}")
    if isinstance(shown, AllOf) and isinstance(asked, AllOf):  # each part covers the one of that name
        names = [", ".join(name for name, _ in whole.parts) for whole in (shown, asked)]
        require(names[0] == names[1], "parts", names[0], f"must be {names[1]}")
        for (_, have), (_, want) in zip(shown.parts, asked.parts, strict=True):
            require_covered(have, want)
        return
    if shown == asked:
        return
    require(kind in ROWS, "statement", kind, "has no directions in which one covers another")
    for one in fields(asked):  # type: ignore[arg-type]
        have, want = getattr(shown, one.name), getattr(asked, one.name)
        row = ROWS[kind].get(one.name)
        require(row is not None, f"{kind}.{one.name}", "", "has no direction in which one covers the other")
        assert row is not None
        require(row(have, want), f"{kind}.{one.name}", have, f"does not cover {want}")
