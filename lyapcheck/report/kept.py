"""A report computed before: taken from the store only if the checker accepts all its certificates again."""

from __future__ import annotations

import json
from base64 import b64decode, b64encode
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck import store
from lyapcheck.answers.check.claim import statement_text
from lyapcheck.certificate import to_json
from lyapcheck.check.judging import certificate_of
from lyapcheck.check.kinds.decreasing import statement_of
from lyapcheck.claims.fresh_check import answer_of
from lyapcheck.errors import InputError
from lyapcheck.kernel.record import GRADE, accepted_before
from lyapcheck.report.claim_row import ClaimRow
from lyapcheck.report.computed import Computed
from lyapcheck.report.gain_map import holds_of
from lyapcheck.report.jobs import BOXES, rounded
from lyapcheck.report.plain import plain
from lyapcheck.report.plain import read as read_row
from lyapcheck.robots import load
from lyapcheck.search.controlled_arm import ControlledArm

if TYPE_CHECKING:
    from lyapcheck.report.subject import Subject

HALF = ("published", "scalar", "tracking", "every_function")
"""The folders of certificates that one process judges while another judges the rest, about as long."""
JUDGED = ("verdict", "id", "m", "rules", "granted")
"""What a row has from the checker."""


def question(subject: Subject) -> dict[str, Any]:
    """All that a report depends on: exact numbers of the arm and of the gains, by their digests."""
    gains = [(file.gains, file.bounds) for file in subject.gain_files]
    names = [name for _, name in subject.sets]
    about = {"ms": subject.ms, "sets": names, "own": subject.own, "map": subject.map, "boxes": BOXES}
    return {"report": store.exact(load(subject.robot), gains), **about}


def written(result: Computed) -> dict[str, Any]:
    """All of it as plain data."""
    figures = {
        name: drawing if isinstance(drawing, str) else {"base64": b64encode(drawing).decode()}
        for name, drawing in result.figures.items()
    }
    return plain(result) | {"figures": figures}


def read(kept: Any, subject: Subject) -> Computed | None:
    """What was written, if every verdict in it is what the checker says of its certificate now.

    The certificates must also be of the statements that are shown, and of the arm and gains of the report.
    """
    try:
        figures = {
            name: drawing if isinstance(drawing, str) else b64decode(drawing["base64"])
            for name, drawing in kept["figures"].items()
        }
        result = read_row(Computed, {**kept, "figures": figures})
        with _judging(result.certificates) as judged:
            said = _of(subject, result) and _as_said(result)
            return result if said and _decided(result, judged()) else None
    except (InputError, AttributeError, KeyError, RuntimeError, TypeError, ValueError):
        return None


def _of(subject: Subject, result: Computed) -> bool:
    """Whether each ε₀, also of the map, has certificates of the arm and gains that it is shown for."""
    arm, sets = load(subject.robot), [one for file in subject.gain_files for one in file.gains]

    def stated(path: str, name: str) -> bool:
        one = json.loads(result.certificates[path])["statement"]
        of = (ControlledArm(gains, arm).loop(Fraction(one["eps0"])) for gains in sets if gains.name == name)
        return any(to_json(statement_of(loop)) == one for loop in of)

    texts, family = result.certificates, subject.of_family
    return all(
        stated(path, row.name) for row in result.epsilon for path in row.certificates.values()
    ) and all(holds_of(cell, texts.get(cell.path), arm, family) for cell in result.cells)


def _as_said(result: Computed) -> bool:
    """Whether each claim shows the statement of its certificate, and the grade ``kernel`` where it has it."""
    texts = {json.loads(text)["digest"]: text for text in result.certificates.values()}
    for row in _decided_rows(result):
        certificate, _ = certificate_of(texts[row.digest].encode())
        by_coq = accepted_before(certificate.statement, certificate.proof, certificate.verdict)
        if by_coq != (row.grade == GRADE) or row.statement != statement_text(certificate.statement):
            return False
    return True


def _decided_rows(result: Computed) -> list[ClaimRow]:
    return [row for row in (*result.claims, *result.others) if row.decided]


def _decided(result: Computed, judged: Mapping[str, Any]) -> bool:
    """Whether a fresh checker decides all of it as it says."""
    digests = {path: json.loads(text)["digest"] for path, text in result.certificates.items()}

    def verdict(path: str | None) -> str | None:
        return None if path is None else judged.get(digests[path], {}).get("verdict")

    for row in _decided_rows(result):
        answer = judged.get(row.digest or "", {})
        if [answer.get(name) for name in JUDGED] != [_as_json(getattr(row, name)) for name in JUDGED]:
            return False
        if row.grade not in (GRADE, answer["grade"]):
            return False
    if any(verdict(one.certificate) != "refuted" for one in result.small.values()):
        return False
    if any(cell.eps0 is not None and verdict(cell.path) != "proved" for cell in result.cells):
        return False
    return all(
        verdict(path) == ("refuted" if kind == "falsified" else "proved")
        and rounded(_eps0(result.certificates[path]), up=kind == "falsified") == row.eps0(kind)
        for row in result.epsilon
        for kind, path in row.certificates.items()
    ) and all(row.certified is None or "certified" in row.certificates for row in result.epsilon)


def _as_json(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value


def _eps0(certificate: str) -> Fraction:
    return Fraction(json.loads(certificate)["statement"]["eps0"])


@contextmanager
def _judging(certificates: Mapping[str, str]) -> Iterator[Callable[[], dict[str, Any]]]:
    """Two fresh processes of the checker at work; what they say, by the digest of each certificate."""
    halves: tuple[dict[str, str], dict[str, str]] = ({}, {})
    for number, (path, text) in enumerate(certificates.items()):
        halves[path.split("/")[1] in HALF][f"{number}.json"] = text

    def judged() -> dict[str, Any]:
        answers = [job.result() for job in jobs]
        if any(answer["alarms"] for answer in answers):
            return {}
        return {row["digest"]: row for answer in answers for row in answer["certificates"] if row["accepted"]}

    with ThreadPoolExecutor(len(halves)) as pool:
        jobs = [pool.submit(answer_of, half) for half in halves if half]
        yield judged
