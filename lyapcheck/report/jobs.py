"""The long computations of a report, as functions of names and paths: each can run in its own process."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck.errors import InputError
from lyapcheck.files.fields import file_stem
from lyapcheck.output.digits import at_least, at_most
from lyapcheck.report.model import KINDS, LINKED, BySize, ClaimRow, EpsilonRow, RunRow
from lyapcheck.store import BEHIND

if TYPE_CHECKING:
    from lyapcheck.answers.check import ClaimResult
    from lyapcheck.answers.derive import Derivation
    from lyapcheck.control.gains import GainFile, GainSet
    from lyapcheck.report.model import Notes
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.run import Run

REST = 0.7853981633974483
"""45° in rad: the step of every joint of an arm that the paper's experiment does not fit."""
BOXES = 30_000
"""Budget of branch and bound for one gain set, in every report; ``epsilon`` goes further on request."""
DIGITS = 4
"""Significant digits of ε₀ in a report, rounded to the safe side: more would differ between machines."""
PROOF = "published.py"
CLASS = "every_function.py"
"""The proof for every number of joints and every function of a class."""
ARGUMENT = ("F.arms.origin", "F.arms.above", "F.arms.rate")
BOUNDS = ("F.h.square", "F.h.bounded", "F.h.slope", "F.h.endless")
"""Its claims that put h_m into the class for every real m ≥ 1."""
SAMPLED = "sampled.py"
"""The loop on a computer, from printed numbers."""
OTHERS = {"scalar.py": (), "tracking.py": (), CLASS: (*ARGUMENT, "F.arms", "F.family", *BOUNDS), SAMPLED: ()}
"""Proofs of what the paper concludes, that do not rest on what is refuted, and which of their claims."""
TURNS = (PROOF,), ("scalar.py",), ("tracking.py", CLASS, SAMPLED)
"""Proofs that one process decides, one after the other."""
SIZES = range(1, 7)
"""How many joints the paper's claims of these kinds are asked for; others are for every n, or of an arm."""
OF_NORMS = ("NormBound", "Implies", "ForSmall")
MODULES = {"python-flint": "flint"}
"""How a package is imported, where that is not its name."""
SHOWN = 6
"""Significant digits of what floating point computes."""


Claims = tuple[list[ClaimRow], dict[str, str]]
"""The claims of a proof, row by row, and the certificates behind them by their paths in a report."""


@dataclass(frozen=True)
class GainData:
    """What was computed for one gain set, with the certificates of its ε₀ by their paths in a report."""

    epsilon: EpsilonRow
    run: Run
    row: RunRow
    certificates: Mapping[str, str]


@dataclass(frozen=True)
class Done:
    """What a computation hands back, and the packages that its process had loaded at its end."""

    result: Any
    packages: frozenset[str]


def done(work: Callable[..., Any], *arguments: Any) -> Done:
    """A computation in its own process, whose packages are those that it, or one before it, has asked for."""
    result = work(*arguments)
    return Done(result, frozenset(name for name in BEHIND if MODULES.get(name, name) in sys.modules))


def _claims(
    proof: str, ms: Sequence[int], robot: str, gains: GainFile, only: Sequence[str] = (), more: bool = False
) -> Claims:
    """The claims of a proof, with what their verdicts rest on.

    Args:
        gains: with the gain set of each m first.
        only: the claims wanted; all if empty.
        more: whether only those about gains are, as the others are known.
    """
    from lyapcheck.answers.check.run import run_proof
    from lyapcheck.claims.decision import file_name

    result = run_proof(proof, ms, robot, None, gains, only)
    names = {one.m: one.name for one in reversed(gains.gains) if one.m is not None}
    stems = {own: own for own in result.certificates}
    if more:
        each = {file_name(claim, m): names[m] for claim in result.about_gains for m in ms}
        stems = {own: f"{file_stem(name)}.{own}" for own, name in each.items() if own in stems}
    paths, rows = {own: f"certificates/{result.name}/{stem}" for own, stem in stems.items()}, []
    for row in result.claims:
        name = names.get(row.m) if row.m is not None and row.id in result.about_gains else None
        if name is None and more:
            continue
        certificate = result.certificates.get(own := file_name(row.id, row.m))
        digest = certificate.digest if certificate else None
        rows.append(ClaimRow.of(row, result.name, result.title, paths.get(own), digest, name))
    return rows, {path: result.certificates[own].text() for own, path in paths.items()}


def _own_claims(proof: str, ms: Sequence[int], robot: str, gains: GainFile, only: Sequence[str]) -> Claims:
    """Some claims of a proof; those about gains for each gain set of an m, one set of each m at a time."""
    left = [one for one in gains.gains if one.m in ms]
    rows: list[ClaimRow] = []
    certificates: dict[str, str] = {}
    while left or not rows:
        turn = list({one.m: one for one in reversed(left)}.values())[::-1]
        left = [one for one in left if one not in turn]
        asked = ms if not rows else [one.m for one in turn if one.m is not None]
        file = replace(gains, gains=tuple(turn) or gains.gains)
        fresh, made = _claims(proof, asked, robot, file, only, more=bool(rows))
        rows, certificates = rows + fresh, certificates | made
    order = list(dict.fromkeys(row.id for row in rows))
    return sorted(rows, key=lambda row: order.index(row.id)), certificates


def proofs_job(
    proofs: Sequence[str], ms: Sequence[int], robot: str, gains: str
) -> tuple[list[Claims], tuple[BySize, ...]]:
    """The claims of some proofs, of the published one also for other numbers of joints.

    One proof after the other: what several of them state is searched for once, and then in the store.
    """
    from lyapcheck.control.gains import read_gain_file

    file, only = read_gain_file(gains), {PROOF: (), **OTHERS}
    found = [_claims(proof, ms, robot, file, only[proof]) for proof in proofs]
    return found, _by_size(found[0][0], ms) if PROOF in proofs else ()


def own_proofs_job(
    ms: Sequence[int], robot: str, gains: str, notes: Notes
) -> tuple[list[Claims], tuple[BySize, ...]]:
    """The claims about an arm of one's own; none is about the paper."""
    from lyapcheck.control.gains import read_gain_file

    file = read_gain_file(gains)
    chosen = [
        (proof, notes.own[stem]) for proof in (PROOF, *OTHERS) if (stem := Path(proof).stem) in notes.own
    ]
    return [_own_claims(proof, ms, robot, file, only) for proof, only in chosen], ()


def _by_size(rows: Sequence[ClaimRow], ms: Sequence[int]) -> tuple[BySize, ...]:
    """The claims about norms and between numbers, for each n of ``SIZES``, where the verdicts differ."""
    from lyapcheck.answers.check.run import proposed_proof
    from lyapcheck.claims.decision import judge_afresh

    its_own = (row for row in rows if row.stands != "ours" and row.n is not None)
    only = list(dict.fromkeys(row.id for row in its_own if row.kind in OF_NORMS))
    proposed = {n: proposed_proof(PROOF, ms, n=n, only=only) for n in SIZES}
    judged = judge_afresh({(n, key): one for n, (made, _) in proposed.items() for key, one in made.items()})
    found: dict[tuple[str, int | None], dict[int, ClaimResult]] = {}
    for n, (made, result) in proposed.items():
        for row in result({key: judged[n, key] for key in made}).claims:
            found.setdefault((row.id, row.m), {})[n] = row
    return tuple(
        BySize(claim, m, sizes[SIZES[0]].comment, {n: row.decision for n, row in sizes.items()})
        for (claim, m), sizes in found.items()
        if len({row.verdict for row in sizes.values()}) > 1
    )


def gains_job(gains: str, name: str, robot: str, seed: int) -> GainData:
    """The four ε₀ of one gain set, and the reference simulation."""
    from lyapcheck.answers.gate.friction import rest_errors
    from lyapcheck.answers.simulate.runs import SetPointRuns
    from lyapcheck.control.gains import read_gain_file
    from lyapcheck.control.judgement import dry_friction, stalls
    from lyapcheck.control.limits import limits_for
    from lyapcheck.robots import load
    from lyapcheck.simulate.closed_loop import simulate
    from lyapcheck.simulate.task import PAPER_TASK

    file, model = read_gain_file(gains), load(robot)
    gain_set = next(item for item in file.gains if item.name == name)
    row, files = _epsilon(gain_set, model, seed)
    # the paper's experiment if the arm has its three joints, else a step of 45° in every joint
    paper = (PAPER_TASK.q_d, PAPER_TASK.q0, PAPER_TASK.w0, PAPER_TASK.T)
    task = paper if model.n == len(PAPER_TASK.q_d) else ([REST] * model.n,)
    eps0, moved = float(row.certified or row.scalar or 0.0), model.with_motors(file.bounds.torque)
    run = simulate(gain_set, moved, *task, eps0=eps0, stop=False)
    # how far off dry friction may hold a joint; none for anywhere, as with a motor at its limit
    loads = zip(rest_errors(gain_set, model), dry_friction(model), limits_for(file, robot).room, strict=True)
    errors = [None if stalls(f, most) else error for error, f, most in loads]
    rest = None if None in errors else max(math.degrees(e) for e in errors if e is not None)
    facts = SetPointRuns((run,)).plain_data(run)
    for size in ("accuracy", "energy_balance"):  # of rounding errors, which no two machines share
        del facts[size]
    facts |= {"top_speed": float(abs(run.w).max()), "rest": rest}
    return GainData(row, run, RunRow(**_shortened(facts)), files)


def _epsilon(gain_set: GainSet, model: RobotModel, seed: int) -> tuple[EpsilonRow, dict[str, str]]:
    """The four ε₀, rounded to the safe side, and why one is missing; and their certificates."""
    from lyapcheck.answers.epsilon.compute import Options
    from lyapcheck.answers.epsilon.kept import certificates, kept_epsilon
    from lyapcheck.search.controlled_arm import ControlledArm

    own: dict[str, Any] = {"name": gain_set.name, "m": gain_set.m, "robot": model.name}
    own |= {"assumptions": model.assumptions, "seed": seed, "boxes": BOXES}
    try:
        ControlledArm(gain_set, model).require_friction()
    except InputError as refused:  # no ε₀ is certified on an arm that lacks friction
        lacking = f"{model.name} {refused.problems[0].rule}"
        return EpsilonRow(**own, reasons=dict.fromkeys(KINDS, lacking)), {}
    result = kept_epsilon(gain_set, model, Options(max_boxes=BOXES, seed=seed))
    numbers = {kind: getattr(result, kind) for kind in KINDS}
    shown: dict[str, Any] = {
        kind: (at_most if kind == "falsified" else at_least)(value, DIGITS)
        for kind, value in numbers.items()
        if value is not None
    }
    files = {f"certificates/epsilon/{name}": one.text() for name, one in certificates(result).items()}
    row = EpsilonRow(
        **own,
        **shown,
        certified_by=result.certified_by or None,
        ratio=None if result.ratio is None else at_least(result.ratio, DIGITS),
        reasons={kind: text for kind, text in result.reasons.items() if kind not in shown},
        certificates={path.split(".")[-2]: path for path in files if path.split(".")[-2] in LINKED},
        weighted=tuple(at_least(x, DIGITS) for x in result.weighted.products) if result.weighted else (),
        promise=result.promise,
    )
    return row, files


def derive_job(ms: Sequence[int], robot: str) -> Derivation:
    """What SymPy derives of the members and for as many joints as the arm has, and the checker judges."""
    from lyapcheck.answers.derive import LARGEST_M, MOST_JOINTS, derivation
    from lyapcheck.robots import load

    return derivation([m for m in ms if m <= LARGEST_M], min(load(robot).n, MOST_JOINTS))


def _shortened(value: Any) -> Any:
    """The same with every floating-point number to the digits that machines agree on."""
    if isinstance(value, float):
        return float(f"{value:.{SHOWN}g}")
    if isinstance(value, dict):
        return {key: _shortened(part) for key, part in value.items()}
    return [_shortened(part) for part in value] if isinstance(value, (list, tuple)) else value
