"""Constants of a chain of links of any length: a posture from one side, storage forms from the other."""

from __future__ import annotations

from lyapcheck._types import Progress, silent
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.constants.constant import ConstantResult
from lyapcheck.constants.extreme import extreme
from lyapcheck.constants.outside import from_distances
from lyapcheck.constants.storage.bounds import storage_proof
from lyapcheck.errors import argument_error
from lyapcheck.robots.plant import Plant


def chain_constant(plant: Plant, name: str, on_progress: Progress = silent) -> ConstantResult:
    """λmin(M), λmax(M), k_c, k_g or a k_gi of a chain of exact links.

    Args:
        plant: the arm.
        name: of the constant.
        on_progress: receives the share of the work done.

    Soundness: the inside end is taken in balls at a posture; the outside end is what the checker accepts.
    """
    on_progress(0.0, "posture")
    inner, chain = extreme(plant, name), plant.chain
    assert chain is not None
    outer = from_distances(plant, name)
    still = name.startswith("k_g") and inner.value == 0
    shown = storage_proof(chain, name, still=True) if still else None
    if shown is None:
        on_progress(0.1, "forms along the links")
        shown = storage_proof(chain, name)
    if shown is not None:
        outer = shown.bound if outer is None or name != "k_c" else min(outer, shown.bound)
    if outer is None:
        raise argument_error(
            name, "", "has no bound: no body has the inertia of some link", "correct the inertias"
        )
    low, high = sorted((inner.value, outer))
    unit = "N·m" if name.startswith("k_g") else "kg·m²"
    return ConstantResult(name, unit, Enclosure(low, high), tuple(map(float, (*inner.q, *inner.x))), 0, shown)
