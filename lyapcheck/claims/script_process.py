"""``python -m lyapcheck.claims.script_process``: the process in which a proof script runs.

The request comes pickled on standard input, from the process that trusts no script; the answer goes as JSON
to the file that the request names. What the script prints goes to standard error. This process ends with the
one that started it, which is when standard input ends.
"""

from __future__ import annotations

import gc
import os
import pickle
import sys
from collections.abc import Iterator
from pathlib import Path
from threading import Thread
from typing import BinaryIO

from lyapcheck.check.statement import Statement
from lyapcheck.claims.claim import Case, Claim, Lacking, in_order, needed
from lyapcheck.claims.handover import (
    TOO_DEEP,
    CaseData,
    ClaimData,
    Handover,
    ScriptAnswer,
    ScriptRequest,
    statement_json,
    write,
)
from lyapcheck.claims.script import check_ids, line_of, load_proof, raised, repair_of
from lyapcheck.errors import InputError, Problem
from lyapcheck.process_tree import GROUPS, end_below, end_own_group
from lyapcheck.robots.dynamics import TooManyTerms

Lines = dict[Statement, tuple[int, str]]
"""The number and the line of each statement."""


def main() -> None:
    """Answer one request and leave at once, whatever threads and exit handlers the script has left."""
    gc.disable()  # a short life, most of it building trees
    own, code = os.getpid(), 1
    try:
        stream = _only_ours()
        request = pickle.load(stream)  # lyapcheck wrote it # nosec B301
        Thread(target=_end_with, args=(stream,), daemon=True).start()
        text = answer(request)
        if os.getpid() == own:  # a copy that the script has forked has nothing to say
            Path(request.answer).write_text(text, encoding="utf-8")
            code = 0
    except BaseException as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
    finally:
        if not GROUPS:  # elsewhere the parent ends the group
            end_below()
        os._exit(code)


def _only_ours() -> BinaryIO:
    """Standard input, which the script must not read; what it prints is not for standard output."""
    stream = os.fdopen(os.dup(0), "rb")
    with open(os.devnull, "rb") as nothing:
        os.dup2(nothing.fileno(), 0)
    sys.stdout = sys.stderr
    return stream


def _end_with(stream: BinaryIO) -> None:
    """End this process, and all that the script has started in its group, when the stream ends."""
    stream.read()
    end_own_group()


def answer(request: ScriptRequest) -> str:
    """The handover of the script as JSON: its claims with their statements, or what is wrong with it."""
    try:
        proof = load_proof(Path(request.path), request.shown)
        check_ids(proof.claims, request.only, request.shown)
        in_order(proof.claims, request.shown)
        wanted = needed(proof.claims, request.only or proof.claims)
        statements: Lines = {}
        handover = []
        for claim in proof.claims.values():
            answers = tuple(_answers(claim, request, statements)) if claim.id in wanted else ()
            about = (claim.id, claim.says, claim.place, claim.section, claim.uses, claim.stands)
            handover.append(ClaimData(*about, answers))
        return write(
            Handover(proof.name, proof.title, proof.reference, tuple(handover)),
            (line for _, line in statements.values()),
        )
    except InputError as error:
        problems = tuple((p.file, p.line, p.key, p.value, p.rule, p.repair) for p in error.problems)
        return write(Handover(problems=problems), [])


def _answers(claim: Claim, request: ScriptRequest, statements: Lines) -> Iterator[ScriptAnswer]:
    for case_data in request.asked:
        yield _answer(claim, case_data, statements, request)
    for case_data in request.others:
        try:
            yield _answer(claim, case_data, statements, request)
        except InputError as error:
            yield ScriptAnswer(None, str(error), ())


def _answer(claim: Claim, case_data: CaseData, statements: Lines, request: ScriptRequest) -> ScriptAnswer:
    case, shown = Case(*case_data), request.shown
    try:
        statement = _statement(claim, case, request)
        if statement not in statements:
            statements[statement] = len(statements), statement_json(statement)
    except (Lacking, TooManyTerms) as lack:
        return ScriptAnswer(None, str(lack), tuple(sorted(case.read)))
    except RecursionError:
        return ScriptAnswer(None, f"its statement {TOO_DEEP}", tuple(sorted(case.read)))
    except (TypeError, ValueError, AttributeError) as error:
        rule = f"its statement is not plain data ({type(error).__name__}: {error})"
        repair = "build it with the functions of lyapcheck.claims"
        raise InputError(Problem(shown, None, claim.id, "", rule, repair)) from error
    return ScriptAnswer(statements[statement][0], "", tuple(sorted(case.read)))


def _statement(claim: Claim, case: Case, request: ScriptRequest) -> Statement:
    """What a claim states for a case.

    Raises:
        Lacking: the case lacks something.
        InputError: the function raises something else, or gives no statement.
    """
    try:
        statement = claim.statement(case)
    except (Lacking, InputError, RecursionError):
        raise
    except BaseException as error:  # a script must not choose the exit code
        rule, repair = (
            f"its statement {raised(error)}",
            repair_of(error, "correct the function of this claim"),
        )
        line = line_of(error, Path(request.path))
        raise InputError(Problem(request.shown, line, claim.id, "", rule, repair)) from error
    returned: object = statement
    if not isinstance(returned, Statement):
        rule = f"its function returns a {type(returned).__name__}, not a statement"
        repair = (
            "return for_all(...), identity(...), norm_bound(...), implies(...), agrees(...) or all_of(...)"
        )
        raise InputError(Problem(request.shown, None, claim.id, "", rule, repair))
    return statement


if __name__ == "__main__":
    main()
