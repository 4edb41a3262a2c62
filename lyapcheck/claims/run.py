"""Running a proof: every claim decided for every m, and what rests on an open claim marked as broken."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from lyapcheck.check.certificate import theorems_of
from lyapcheck.check.theorems.premises import unmet
from lyapcheck.claims.case import Case, Lacking
from lyapcheck.claims.claim import Claim
from lyapcheck.claims.decision import Decision, undecided
from lyapcheck.claims.procedures import decide
from lyapcheck.claims.result import ClaimResult, ProofResult
from lyapcheck.claims.script import check_ids, find_script, load_proof
from lyapcheck.claims.statements import Missing, Statement
from lyapcheck.errors import InputError, Problem
from lyapcheck.verdicts import Grade, Verdict

Progress = Callable[[float, str], None]
Settled = dict[tuple[str, int | None], ClaimResult]

DEFAULT_ROBOT = "buap3"
DEFAULT_GAINS = "table2"


def run_proof(
    path: str | Path,
    ms: Sequence[int] = (1, 2, 3),
    robot: Any = None,
    n: int | None = None,
    gains: Any = None,
    only: Sequence[str] = (),
    on_progress: Progress | None = None,
) -> ProofResult:
    """Decide the claims of a proof script for each m.

    Args:
        path: the script; ``published.py`` is found wherever lyapcheck is installed.
        ms: the members of the family, m >= 1.
        robot: a robot model, or its name or file; the paper's arm by default, unless ``n`` is given.
        n: the number of joints, for claims on vectors, in place of a robot.
        gains: a gain file (read or its path); the paper's Table 2 by default.
        only: the ids to report; what they use is decided too.
        on_progress: called with the fraction done and the id at work.

    Returns:
        One result per claim and m; a claim that does not look at m has one result with ``m = None``.

    Raises:
        InputError: the script, an id, the robot or the gain file cannot be used.

    Soundness: a claim is proved only if its own decision is and every claim it uses is proved for the same m,
    and if those behind the hypotheses of a theorem state what these come to.
    """
    script = find_script(str(path))
    shown = script.name
    proof = load_proof(script, shown)
    check_ids(proof, tuple(only), shown)
    model = _robot(robot, n)
    joints = n if n is not None else model.n
    sets = _gain_sets(gains, joints)
    wanted = proof.needed(only) if only else set(proof.claims)
    order = [claim for claim in proof.order(shown) if claim.id in wanted]
    settled: Settled = {}
    for index, m in enumerate(ms):
        case_of = (m, joints, model, next((s for s in sets if s.m == m), None))
        for step, claim in enumerate(order):
            if on_progress:
                on_progress((index + step / len(order)) / len(ms), f"m = {m}: {claim.id}")
            if (claim.id, None) not in settled:
                result = _settle(claim, Case(*case_of), settled, shown)
                settled[claim.id, result.m] = result
    places = {name: k for k, name in enumerate(proof.claims)}
    keep = set(only) or set(proof.claims)
    every = sorted(settled.values(), key=lambda r: (places[r.id], r.m or 0))
    return ProofResult(
        proof.name,
        proof.title,
        tuple(ms),
        joints,
        model.name if model else None,
        tuple(row for row in every if row.id in keep),
        model.assumptions if model else (),
        tuple(every),
    )


def paper_case(m: int) -> Case:
    """The case of the paper: its arm and its Table 2 gains."""
    model = _robot(None, None)
    return Case(m, model.n, model, next((s for s in _gain_sets(None, model.n) if s.m == m), None))


def _settle(claim: Claim, case: Case, settled: Settled, file: str) -> ClaimResult:
    """The result of one claim for one case."""
    begin = time.perf_counter()
    statement = _statement(claim, case, file)
    used = [settled.get((name, case.the_m)) or settled[name, None] for name in claim.uses]
    case.read.update(name for name in "mn" if any(getattr(result, name) is not None for result in used))
    try:
        decision = decide(statement)
    except Exception as error:
        decision = Decision(Verdict.ERROR, Grade.NUMERIC, "", f"{type(error).__name__}: {error}")
    open_uses = tuple(result.id for result in used if result.verdict is not Verdict.PROVED)
    return ClaimResult(
        id=claim.id,
        m=case.the_m if "m" in case.read else None,
        n=case.the_n if "n" in case.read else None,
        statement=claim.says,
        place=claim.place,
        section=claim.section,
        kind=type(statement).__name__,
        uses=claim.uses,
        broken=open_uses,
        decision=_chained(decision, statement, used, open_uses),
        step=decision,
        stated=statement,
        seconds=time.perf_counter() - begin,
    )


def _chained(
    decision: Decision, statement: Statement | Missing, used: list[ClaimResult], open_uses: tuple[str, ...]
) -> Decision:
    """The decision with the weakest link of what it uses; a witness needs none of it."""
    if decision.verdict is not Verdict.PROVED:
        return decision
    if open_uses or isinstance(statement, Missing):
        names = ", ".join(open_uses)
        reason = f"its own step holds, but it rests on {names}; prove those, or prove it without them"
        return replace(undecided(reason, decision.method), evidence=decision.evidence)
    stated = {r.id: r.stated for r in used if not isinstance(r.stated, Missing)}
    for theorem in theorems_of(statement):
        lacks = unmet(theorem, stated)
        if lacks is not None:
            return replace(undecided(f"{lacks}; state it there", decision.method), evidence=decision.evidence)
    return replace(decision, grade=min([decision.grade, *(result.decision.grade for result in used)]))


def _statement(claim: Claim, case: Case, file: str) -> Statement | Missing:
    try:
        statement = claim.statement(case)
    except Lacking as lack:
        return Missing(str(lack))
    except InputError:
        raise
    except (Exception, SystemExit) as error:  # a script must not choose the exit code
        rule = f"its statement raises {type(error).__name__}: {error}"
        raise InputError(
            Problem(file, None, claim.id, "", rule, "correct the function of this claim")
        ) from error
    returned: object = statement
    if not isinstance(returned, Statement):
        rule = f"its function returns a {type(returned).__name__}, not a statement"
        repair = (
            "return for_all(...), identity(...), norm_bound(...), implies(...), agrees(...) or all_of(...)"
        )
        raise InputError(Problem(file, None, claim.id, "", rule, repair))
    return statement


def _robot(robot: Any, n: int | None) -> Any:
    if robot is None and n is not None:
        return None
    if robot is not None and not isinstance(robot, (str, Path)):
        return robot
    from lyapcheck.robots import load

    return load(str(robot or DEFAULT_ROBOT))


def _gain_sets(gains: Any, joints: int) -> tuple[Any, ...]:
    """The gain sets of the hyperbolic family with the right number of joints."""
    if gains is None or isinstance(gains, (str, Path)):
        from lyapcheck.control import paper_gain_file, read_gain_file

        gains = paper_gain_file(DEFAULT_GAINS) if gains is None else gains
        gains = read_gain_file(gains) if isinstance(gains, (str, Path)) else gains
    return tuple(s for s in gains.gains if s.m is not None and len(s.kp) == joints)
