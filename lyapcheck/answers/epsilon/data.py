"""One gain set's four ε₀ as plain data."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from lyapcheck.answers.epsilon.four import eps0_of
from lyapcheck.answers.epsilon.words import KINDS, exact, ratio_text
from lyapcheck.output.digits import decimals

if TYPE_CHECKING:
    from lyapcheck.answers.epsilon.four import FourEpsilons
    from lyapcheck.search.falsify import RisingState
    from lyapcheck.search.weights import Weighted

_DIGITS = 20


def result_data(result: FourEpsilons) -> dict[str, Any]:
    """Numbers as exact decimal strings; a missing one is ``None`` and has its reason under ``reasons``."""
    return {
        "name": result.name,
        "m": result.m,
        "robot": result.robot,
        **{kind: exact(getattr(result, kind)) for kind in KINDS},
        "scalar_grade": result.scalar_grade,
        "ratio": ratio_text(result.ratio),
        "certified_by": result.certified_by or None,
        "witness": None if result.witness is None else _witness(result.witness),
        "boxes": result.boxes,
        "weighted": None if result.weighted is None else _weighted(result.weighted),
        "ranges": result.ranges,
        "unvaried": exact(eps0_of(result.unvaried)),
        "outside": list(result.outside),
        "corner": {name: exact(value) for name, value in result.corner.items()},
        "seed": result.seed,
        "findings": list(result.findings),
        "reasons": dict(result.reasons),
        "assumptions": list(result.assumptions),
    }


def _weighted(weighted: Weighted) -> dict[str, Any]:
    loop = weighted.proof.loop
    return {
        "eps0": exact(loop.eps0),
        "lambda": [exact(scale) for scale in loop.Lambda],
        "eps0_lambda": [exact(value) for value in weighted.products],
        "boxes": weighted.proof.boxes,
        "states": weighted.states,
    }


def _witness(witness: RisingState) -> dict[str, Any]:
    state = {name: [exact(x) for x in getattr(witness.state, name)] for name in ("q", "e", "w")}
    rate = dict(zip(("lower", "upper"), decimals(witness.rate, _DIGITS), strict=True))
    return {"eps0": exact(witness.eps0), **state, "rate": rate, "kind": witness.kind}
