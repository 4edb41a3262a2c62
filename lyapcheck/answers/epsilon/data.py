"""The four ε₀ as versioned JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

from lyapcheck.admissible.formats.words import KINDS, exact, ratio_text

if TYPE_CHECKING:
    from lyapcheck.admissible import EpsilonResult
    from lyapcheck.search.falsify import Witness
    from lyapcheck.search.weights import Weighted

SCHEMA = "lyapcheck/epsilon/1"
_DIGITS = 20


def render(results: Sequence[EpsilonResult], seconds: Sequence[float] | None = None) -> str:
    """``results: [{name, m, published, scalar, certified, falsified, ratio, witness, boxes, …}]``.

    Numbers are exact decimal strings, a missing one is null and has its reason under ``reasons``.
    """
    rows = [result_json(result) for result in results]
    if seconds is not None:
        rows = [{**row, "seconds": round(time, 3)} for row, time in zip(rows, seconds, strict=True)]
    document = {"schema": SCHEMA, "version": version("lyapcheck"), "results": rows}
    return json.dumps(document, ensure_ascii=False, indent=2) + "\n"


def result_json(result: EpsilonResult) -> dict[str, Any]:
    """One gain set as plain data."""
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
        "corner": {name: exact(value) for name, value in result.corner.items()},
        "seed": result.seed,
        "findings": list(result.findings),
        "reasons": dict(result.reasons),
        "assumptions": list(result.assumptions),
    }


def _weighted(weighted: Weighted) -> dict[str, Any]:
    closure = weighted.proof.closure
    return {
        "eps0": exact(closure.eps0),
        "lambda": [exact(scale) for scale in closure.Lambda],
        "eps0_lambda": [exact(value) for value in weighted.products],
        "boxes": weighted.proof.boxes,
        "states": weighted.states,
    }


def _witness(witness: Witness) -> dict[str, Any]:
    state = {name: [exact(x) for x in getattr(witness.state, name)] for name in ("q", "e", "w")}
    rate = dict(zip(("lower", "upper"), witness.rate.decimals(_DIGITS), strict=True))
    return {"eps0": exact(witness.eps0), **state, "rate": rate, "kind": witness.kind}
