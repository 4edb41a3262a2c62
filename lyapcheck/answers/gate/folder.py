"""Proofs from the folder that a gain file names: the gate rechecks them, and needs no search."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from lyapcheck.check.covers import require_covered
from lyapcheck.check.refusal import Refused
from lyapcheck.control.judgement import JudgedStatement, judged_statement
from lyapcheck.errors import InputError, Problem
from lyapcheck.promise import Promise, promised

if TYPE_CHECKING:
    from lyapcheck.check.certificate import Certificate
    from lyapcheck.check.statement import Statement
    from lyapcheck.control.gains import GainFile


def certificates_of(file: GainFile) -> tuple[Certificate, ...]:
    """The certificates of the folder of a gain file, not yet judged; what is no certificate is left out.

    Raises:
        InputError: the folder cannot be read, or has no ``.json`` file.
    """
    if file.certificates is None:
        return ()
    from lyapcheck.check import kinds
    from lyapcheck.check.certificate import certificate_of
    from lyapcheck.check.recheck import Unreadable, content, gather

    kinds.load()
    try:
        documents = gather([file.certificates])
    except Unreadable as error:
        place = None if file.document is None else file.document.place(("certificates",))
        line, rule = None if place is None else place.line, error.problems[0][1]
        repair = "write the certificates there with gate … --certificates DIR, or remove the key"
        raise InputError(Problem(file.path, line, "certificates", file.certificates, rule, repair)) from None
    found = []
    for one in documents:
        try:
            found.append(certificate_of(content(one.path))[0])
        except (Refused, OSError, ValueError, RecursionError):  # certificates of other versions, other files
            continue
    return tuple(found)


def shown_by(
    kept: Sequence[Certificate], question: Callable[[Statement], Statement | None]
) -> Iterator[tuple[Promise, JudgedStatement]]:
    """The promises of certificates that answer a question, each judged again.

    Args:
        kept: certificates, not judged.
        question: what a statement would have to answer, such as with its own ε₀; ``None``: another kind.

    Soundness: that of ``lyapcheck.check.verify`` and ``lyapcheck.check.covers``; names and verdicts in the
        files are not used.
    """
    for one in kept:
        asked = question(one.statement)
        if asked is None:
            continue
        try:
            require_covered(one.statement, asked)
        except Refused:
            continue
        judged = judged_statement(one.statement, [one.proof])
        promise, _ = promised(asked, judged)
        if promise is not None:
            yield promise, judged
