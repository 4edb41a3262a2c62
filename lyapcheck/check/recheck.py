"""Many certificates at once: each judged by itself, then what they rest on."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any

from lyapcheck.check.certificate import Certificate, judge, read, theorems_of
from lyapcheck.check.refusal import Refused, plain
from lyapcheck.check.theorems.premises import unmet
from lyapcheck.check.verify import weakest


@dataclass(frozen=True)
class Document:
    """The JSON value of a file, or why it has none; a ``complete`` collection has all that it uses."""

    file: str
    data: Any
    complete: bool


@dataclass(frozen=True)
class Checked:
    """What became of one document: accepted, or refused for a reason.

    ``given`` lists the claims that it uses and whose certificates are not at hand; ``grade`` is the weakest
    of its own and of those it rests on, as far as they are.
    """

    file: str
    reason: str = ""
    certificate: Certificate | None = None
    digest: str = ""
    grade: str = ""
    given: tuple[str, ...] = ()
    complete: bool = False

    @property
    def accepted(self) -> bool:
        """Whether nothing was found against it."""
        return not self.reason


@dataclass(frozen=True)
class Outcome:
    """All documents in the order they were given, and the theorems with the files that rest on them."""

    checked: tuple[Checked, ...]
    theorems: dict[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def all_accepted(self) -> bool:
        """Whether every document was accepted."""
        return all(one.accepted for one in self.checked)


def recheck(documents: Iterable[Document]) -> Outcome:
    """Judge certificates, and whether what they use was judged well too.

    Soundness: a certificate is accepted if its own proof is, and no certificate that it uses is known to be
    refused, to be of another claim or to be a refutation, and those behind the hypotheses of a theorem state
    what it needs; in a complete collection none may be missing. Uses cannot go in circles: each digest is
    over the digests it uses.
    """
    own = [check_one(document) for document in documents]
    known = {one.digest: one for one in own if one.digest}
    settled: dict[str, Checked] = {}
    for one in own:
        _settle(one, known, settled)
    found = tuple(settled[one.digest] if one.accepted else one for one in own)
    checked = tuple(replace(new, file=old.file) for old, new in zip(own, found, strict=True))
    return Outcome(checked, _theorems(checked, known))


def check_one(document: Document) -> Checked:
    """One document judged by itself."""
    blank = Checked(document.file, complete=document.complete)
    try:
        if isinstance(document.data, Refused):
            raise document.data
        blank = replace(blank, certificate=read(document.data), digest=document.data["digest"])
        assert blank.certificate is not None
        accepted = judge(blank.certificate)
    except Refused as refusal:
        return replace(blank, reason=str(refusal))
    return replace(blank, grade=accepted.grade)


def _settle(one: Checked, known: dict[str, Checked], settled: dict[str, Checked]) -> None:
    """Follow the uses without recursion, the deepest first."""
    waiting = [one]
    while waiting:
        current = waiting[-1]
        used = [known[d] for d in _uses(current).values() if d in known and d not in settled]
        if used and current.accepted:
            waiting.extend(used)
            continue
        waiting.pop()
        settled.setdefault(current.digest, _with_uses(current, settled))


def _with_uses(one: Checked, settled: dict[str, Checked]) -> Checked:
    """The same with the reason why what it uses does not carry it, if there is one."""
    grades, given = [one.grade], []
    for claim, digest in _uses(one).items():
        used = settled.get(digest)
        if used is None:
            given.append(claim)
            if one.complete:
                return replace(
                    one, reason=f"rests on {plain(claim)}, whose certificate ({digest[:12]}…) is not here"
                )
        elif (fault := _fault(one, used, claim)) is not None:
            return replace(one, reason=f"rests on {plain(claim)}, {fault}")
        else:
            grades.append(used.grade)
            given.extend(used.given)
    if not one.accepted:
        return one
    lacks = _lacking(one, {claim: settled[d] for claim, d in _uses(one).items() if d in settled})
    if lacks is not None:
        return replace(one, reason=plain(lacks))
    return replace(one, grade=weakest(grades), given=tuple(dict.fromkeys(given)))


def _lacking(one: Checked, used: dict[str, Checked]) -> str | None:
    """What the claims behind the hypotheses of its theorems fail to state."""
    assert one.certificate is not None
    stated = {name: its.certificate.statement for name, its in used.items() if its.certificate is not None}
    found = (unmet(theorem, stated) for theorem in theorems_of(one.certificate.statement))
    return next((lacks for lacks in found if lacks is not None), None)


def _fault(one: Checked, used: Checked, claim: str) -> str | None:
    """Why a certificate does not carry a claim of that id for the same m and n."""
    if not used.accepted:
        return "whose certificate is refused"
    assert one.certificate is not None
    assert used.certificate is not None
    mine, its = one.certificate.claim, used.certificate.claim
    if its.id != claim:
        return f"but the certificate is about {plain(its.id)}"
    for name in ("m", "n"):
        wanted, found = getattr(mine, name), getattr(its, name)
        if found is not None and found != wanted:
            return f"but the certificate is for {name} = {found}"
    return None if used.certificate.verdict == "proved" else "which is refuted"


def _uses(one: Checked) -> dict[str, str]:
    return {} if one.certificate is None else dict(sorted(one.certificate.uses.items()))


def _theorems(checked: tuple[Checked, ...], known: dict[str, Checked]) -> dict[str, tuple[str, ...]]:
    """For each theorem the files of the accepted certificates that rest on it, directly or not."""
    found: dict[str, list[str]] = {}
    reached: dict[str, set[str]] = {}
    for one in checked:
        if one.accepted:
            for name in sorted(_rests_on(one, known, reached)):
                found.setdefault(name, []).append(one.file)
    return {name: tuple(files) for name, files in sorted(found.items())}


def _rests_on(one: Checked, known: dict[str, Checked], reached: dict[str, set[str]]) -> set[str]:
    """The names of the theorems below a certificate."""
    waiting, seen = [one], {one.digest}
    names: set[str] = set()
    while waiting:
        current = waiting.pop()
        if current.digest not in reached and current.certificate is not None:
            reached[current.digest] = {t.name for t in theorems_of(current.certificate.statement)}
        names |= reached.get(current.digest, set())
        for digest in _uses(current).values():
            if digest in known and digest not in seen:
                seen.add(digest)
                waiting.append(known[digest])
    return names
