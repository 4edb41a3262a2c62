"""The map over m and k_v: the ε₀ that is proved at each place, and what the reference simulation does."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.output.digits import at_least
from lyapcheck.report.model import MapCell
from lyapcheck.report.plain import read
from lyapcheck.search.proof import DecreaseProof

if TYPE_CHECKING:
    from lyapcheck.answers.epsilon import EpsilonResult
    from lyapcheck.certificate import Certificate
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel

SCALES = ("0.05", "0.1", "0.2", "0.5", "1", "2")
"""k_v of the map, N·m."""
BOXES = 30_000
"""Budget of branch and bound for one place of the map: every report has all its certificates judged again."""
DIGITS = 3


def gain_map(
    model: RobotModel,
    sets: Mapping[int, GainSet],
    goal: Sequence[float],
    scales: Sequence[str] = SCALES,
) -> list[MapCell]:
    """For each m and k_v the ε₀ that is proved, and what the reference simulation does.

    Args:
        sets: a gain set for each m, whose K_p is kept.
        goal: (n,) the step of each joint from rest at home, rad.
        scales: k_v, N·m, the same in every joint.
    """
    return [cell for _, one in sorted(sets.items()) for cell in _row(model, one, scales, goal)]


def _row(model: RobotModel, one: GainSet, scales: Sequence[str], goal: Sequence[float]) -> list[MapCell]:
    """The places of one m: what is proved for a k_v serves smaller ones that have no larger ε₀ of their own.

    So one tree of boxes is judged for many places.
    """
    from lyapcheck.answers.epsilon.compute import answers
    from lyapcheck.answers.epsilon.kept import kept_epsilon
    from lyapcheck.answers.epsilon.options import Options

    cells: list[MapCell] = []
    served: DecreaseProof | None = None
    for kv in sorted(map(Fraction, scales), reverse=True):
        gains = _at(one, kv, model)
        result = kept_epsilon(gains, model, Options(max_boxes=BOXES, weights=False))
        known = None if served is None else served.for_smaller(gains.kv).accepted()
        if known is not None and _digits(result) <= Fraction(map_eps0(known.loop.eps0)):
            promise, _ = answers(known, gains, model, ranges=False)
            result = result if promise is None else replace(result, promise=promise, proof=known)
        served = result.proof if isinstance(result.proof, DecreaseProof) else None
        cells.append(_cell(result, model, kv, goal))
    return cells[::-1]


def _digits(result: EpsilonResult) -> Fraction:
    """The ε₀ that the map would show, 0 for none."""
    return Fraction(0) if result.certified is None else Fraction(map_eps0(result.certified))


def _cell(result: EpsilonResult, model: RobotModel, kv: Fraction, goal: Sequence[float]) -> MapCell:
    from lyapcheck.answers.epsilon.certificates import certificates
    from lyapcheck.simulate.closed_loop import simulate

    gains = result.gains
    run = simulate(gains, model, goal, stop=False)
    times = [math.nan if t is None else float(t) for t in run.settling]
    settling = max(times) if all(map(math.isfinite, times)) else None
    peaks = zip(run.peak_torque, model.torque_limit, strict=True)
    shares = [float(peak) / float(limit.value) for peak, limit in peaks if limit is not None]
    assert gains.m is not None
    made = certificates(result).items()
    return MapCell(
        m=gains.m,
        kv=f"{float(kv):g}",
        eps0=None if result.certified is None else map_eps0(result.certified),
        settling=None if settling is None else float(f"{settling:.{DIGITS}g}"),
        share=float(f"{max(shares):.{DIGITS}g}") if shares else None,
        within_19=result.published is not None,
        certificate=next((one.text() for name, one in made if name.endswith(".certified.json")), None),
    )


def map_eps0(value: Fraction) -> str:
    """The largest decimal of three digits that is not above it."""
    return at_least(value, DIGITS)


def kept_map(model: RobotModel, sets: Mapping[int, GainSet]) -> list[MapCell]:
    """The map of the paper's arm as the study wrote it, where the checker accepts what it rests on.

    None for another arm or K_p; as of all gains, no ε₀ is shown that is not proved.

    Args:
        sets: a gain set for each m, as for ``gain_map``.
    """
    from lyapcheck.check.certificate import judged
    from lyapcheck.report.experiment import arm_digest, study_file

    path = study_file("gain_map")
    result = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    if not result or result["arm"] != arm_digest(model):
        return []
    cells = [read(MapCell, data) for data in result["map"] if data["m"] in sets]
    holds = all(
        holds_of(one, model, sets)
        and (one.certificate is None or judged(one.certificate.encode()).verdict == "proved")
        for one in cells
    )
    return cells if holds else []


def for_the_sets(cells: Sequence[MapCell], sets: Mapping[int, GainSet]) -> dict[str, Certificate]:
    """By names of gain sets the ε₀ that the map proves with a larger k_v: no tree of boxes is judged twice.

    Args:
        cells: of the map, in the order of k_v, judged in this process.
        sets: the gain set of each m, of the K_p of the map.
    """
    from lyapcheck.certificate import Certificate
    from lyapcheck.check.certificate import certificate_of, judge
    from lyapcheck.check.kinds.decreasing import Decreasing, LargerKv, PositiveAndDecreasing
    from lyapcheck.check.refusal import Refused

    result: dict[str, Certificate] = {}
    for cell in cells:
        one = sets[cell.m]
        if cell.certificate is None or one.name in result:
            continue
        of_cell, _ = certificate_of(cell.certificate.encode())
        stated, proof = of_cell.statement, of_cell.proof
        if isinstance(stated, Decreasing) and isinstance(proof, PositiveAndDecreasing):
            for_set = replace(of_cell, statement=replace(stated, kv=one.kv), proof=LargerKv(stated.kv, proof))
            with suppress(Refused):
                judge(for_set)
                result[one.name] = Certificate.of(for_set)
    return result


def holds_of(cell: MapCell, model: RobotModel, sets: Mapping[int, GainSet]) -> bool:
    """Whether the certificate of a place, if it has one, is of its ε₀, for this arm and these gains."""
    from lyapcheck.certificate import to_json
    from lyapcheck.check.kinds.decreasing import statement_of
    from lyapcheck.search.controlled_arm import ControlledArm

    if cell.certificate is None or cell.m not in sets:
        return cell.eps0 is None
    stated = json.loads(cell.certificate)["statement"]
    eps0 = Fraction(stated["eps0"])
    loop = ControlledArm(_at(sets[cell.m], Fraction(cell.kv), model), model).loop(eps0)
    return bool(map_eps0(eps0) == cell.eps0 and to_json(statement_of(loop)) == stated)


def _at(one: GainSet, kv: Fraction, model: RobotModel) -> GainSet:
    """The gains of a place."""
    return replace(one, kv=(kv,) * model.n)
