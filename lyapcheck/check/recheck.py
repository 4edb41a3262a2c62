"""Many certificates at once: their files, each judged by itself in a process, then what they rest on."""

from __future__ import annotations

import os
import stat
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

from lyapcheck.check.guard import Guard
from lyapcheck.check.judgement import MAX_BYTES, Judgement, Limits
from lyapcheck.check.refusal import plain

SORTS = {
    stat.S_IFDIR: "a directory",
    stat.S_IFIFO: "a pipe",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
}


class Unreadable(Exception):
    """Arguments that cannot be used: pairs (name, what is wrong)."""

    def __init__(self, problems: list[tuple[str, str]]) -> None:
        self.problems = [(plain(name), plain(rule)) for name, rule in problems]
        super().__init__("; ".join(f"{name}: {rule}" for name, rule in self.problems))


@dataclass(frozen=True)
class Document:
    """A file that may be a certificate: the name it goes by, and whether the user named it by itself."""

    file: str
    path: Path
    named: bool = True


def gather(paths: Iterable[str | Path]) -> list[Document]:
    """The files among the paths, and all ``.json`` entries of the directories among them.

    A directory that has none stands for the directories in it, as a report's ``certificates`` does.

    Files go by their names without the folder, unless two have the same.

    Raises:
        Unreadable: naming every path that is neither a readable regular file nor a directory of certificates.
    """
    result: list[Document] = []
    problems: list[tuple[str, str]] = []
    for path in map(Path, paths):
        try:
            if stat.S_ISDIR(os.stat(path).st_mode):
                inside = [path / name for name in sorted(os.listdir(path))]
                found = [one for one in inside if one.name.endswith(".json")]
                if not found:  # listed one by one, as glob leaves out without a word what it may not read
                    inner = (one / name for one in inside if one.is_dir() for name in sorted(os.listdir(one)))
                    found = [one for one in inner if one.name.endswith(".json")]
                if not found:
                    raise ValueError("the directory has no certificates (*.json), nor has one in it")
                result += [Document(one.name, one, named=False) for one in found]
            else:
                content(path)
                result.append(Document(path.name, path))
        except (OSError, ValueError) as error:
            problems.append((str(path), words(error)))
    if problems:
        raise Unreadable(problems)
    times = Counter(one.path.name for one in result)
    shown = (one.path.name if times[one.path.name] == 1 else str(one.path) for one in result)
    return [Document(plain(name), one.path, one.named) for name, one in zip(shown, result, strict=True)]


def content(path: Path) -> bytes:
    """The bytes of a regular file.

    Raises:
        OSError: it cannot be read.
        ValueError: it is not a regular file, too large, or changes while it is read.
    """
    _require_regular(os.stat(path).st_mode)
    # whatever has taken its place since then must not keep us waiting
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(descriptor, "rb") as file:
        before = os.fstat(descriptor)
        _require_regular(before.st_mode)
        if before.st_size > MAX_BYTES:
            raise ValueError(f"has {before.st_size} bytes, above {MAX_BYTES}, which no certificate has")
        result = file.read(MAX_BYTES + 1)
    if len(result) != before.st_size:
        raise ValueError("changes while it is read; copy it first")
    return result


def _require_regular(mode: int) -> None:
    if not stat.S_ISREG(mode):
        raise ValueError(f"is {SORTS.get(stat.S_IFMT(mode), 'something else')}, not a regular file")


def words(error: Exception) -> str:
    """What is wrong with a file, as a user reads it."""
    return f"cannot be read ({error.strerror})" if isinstance(error, OSError) else str(error)


GRADES = ("enclosure", "exact")
"""As in ``verify``, which only the process that judges needs to import."""


@dataclass(frozen=True)
class Checked:
    """What became of one document: ``accepted``, ``refused`` or ``undecided``, the last two for a reason.

    ``given`` lists the claims that it uses and whose certificates are not at hand, directly or not;
    ``grade`` is the weakest of its own and of those it rests on.
    """

    document: Document
    finding: Judgement
    status: str
    reason: str = ""
    grade: str = ""
    given: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"<Checked: {self.file}, {self.status}>"

    @property
    def file(self) -> str:
        return self.document.file

    @property
    def accepted(self) -> bool:
        return self.status == "accepted"

    @property
    def verdict(self) -> str:
        return self.finding.verdict if self.accepted else ""


@dataclass(frozen=True)
class Alarm:
    """A statement that some certificates prove and others refute: the checker itself is wrong."""

    digest: str
    statement: str
    proved: tuple[str, ...]
    refuted: tuple[str, ...]


@dataclass(frozen=True)
class Outcome:
    """All documents in the order they were given, what they rest on, and what contradicts itself.

    ``theorems`` gives for each theorem the files of the accepted certificates that rest on it, ``granted``
    for each accepted file what its statements take for granted, ``rules`` the (rule, module)
    pairs it rests on; ``limited`` says which limits the system keeps.
    """

    checked: tuple[Checked, ...]
    alarms: tuple[Alarm, ...] = ()
    theorems: dict[str, tuple[str, ...]] = field(default_factory=dict)
    references: dict[str, str] = field(default_factory=dict)
    granted: dict[str, tuple[str, ...]] = field(default_factory=dict)
    rules: dict[str, tuple[tuple[str, str], ...]] = field(default_factory=dict)
    limited: tuple[str, ...] = ()

    def __repr__(self) -> str:
        accepted = sum(one.accepted for one in self.checked)
        return f"<Outcome: {accepted} of {len(self.checked)} accepted>"

    @property
    def code(self) -> int:
        """0: all accepted, 1: some refused, 3: some undecided and none refused, 4: an alarm."""
        result = {one.status for one in self.checked}
        return 4 if self.alarms else 1 if "refused" in result else 3 if "undecided" in result else 0


def recheck(documents: Iterable[Document], limits: Limits | None = None, full: bool = False) -> Outcome:
    """Verify certificates and the certificates that they use.

    ``limits`` are for each certificate. ``full`` gives statements and descriptions whole.
    Raises ``Unreadable`` if a file that was named alone is not JSON.

    Soundness: a certificate is accepted if its own proof is, and each certificate that it uses is at hand and
    accepted, is of the claim it is used for and proves it. It is refused if one of these is known not to be
    so, and undecided otherwise, as it is where judging it came to no end. Uses cannot go in circles: each
    digest is over the digests it uses.
    """
    with Guard(limits or Limits()) as guard:
        own = []
        for document in documents:
            try:
                finding = guard.judge(content(document.path), full)
            except (OSError, ValueError) as error:
                finding = replace(Judgement().refused(words(error)), unreadable=True)
            status = "undecided" if finding.spent else "refused" if finding.reason else "accepted"
            own.append(Checked(document, finding, status, finding.reason, finding.grade))
        problems = [
            (str(d.document.path), d.reason) for d in own if d.finding.unreadable and d.document.named
        ]
        if problems:
            raise Unreadable(problems)
        known = {one.finding.digest: one for one in own if one.finding.digest}
        settled: dict[str, Checked] = {}
        for one in own:
            _settle(one, known, settled)
        result = tuple(
            replace(settled[one.finding.digest], document=one.document) if one.finding.digest else one
            for one in own
        )
        return summed(result, settled, guard.limited)


def _settle(one: Checked, known: dict[str, Checked], settled: dict[str, Checked]) -> None:
    """Follow the uses without recursion, the deepest first."""
    waiting = [one] if one.finding.digest else []
    while waiting:
        current = waiting[-1]
        uses = current.finding.uses.values() if current.accepted else ()
        ahead = [known[digest] for digest in uses if digest in known and digest not in settled]
        if ahead:
            waiting.extend(ahead)
            continue
        waiting.pop()
        if current.finding.digest not in settled:
            settled[current.finding.digest] = _with_uses(current, settled)


def _with_uses(one: Checked, settled: dict[str, Checked]) -> Checked:
    """The same as what it uses leaves of it."""
    if not one.accepted:
        return one
    missing = [claim for claim, digest in one.finding.uses.items() if digest not in settled]
    used = {claim: settled[digest] for claim, digest in one.finding.uses.items() if digest in settled}
    for claim, its in used.items():
        if (fault := _fault(one, its, claim)) is not None:
            return replace(one, status="refused", reason=f"rests on {plain(claim)}, {fault}", grade="")
    open_ = [claim for claim, its in used.items() if not its.accepted]
    if missing or open_:
        given = (*missing, *(name for its in used.values() for name in its.given))
        reasons = [
            f"{plain(claim)}, whose certificate ({one.finding.uses[claim][:12]}…) is not here"
            for claim in missing
        ]
        reasons += [f"{plain(claim)}, which is undecided" for claim in open_]
        reason = f"rests on {'; on '.join(reasons)}"
        return replace(one, status="undecided", reason=reason, grade="", given=tuple(dict.fromkeys(given)))
    return replace(one, grade=min([one.grade, *(its.grade for its in used.values())], key=GRADES.index))


def _fault(one: Checked, used: Checked, claim: str) -> str | None:
    """Why a certificate does not carry a claim of that id for the same m and n."""
    if used.status == "refused":
        return "whose certificate is refused"
    mine, its = one.finding, used.finding
    if its.claim != claim:
        return f"but the certificate is about {its.label}"
    for name in ("m", "n"):
        wanted, result = getattr(mine, name), getattr(its, name)
        if result is not None and result != wanted:
            return f"but the certificate is for {name} = {result}"
    return None if its.verdict == "proved" else "which is refuted"


def summed(checked: tuple[Checked, ...], settled: dict[str, Checked], limited: tuple[str, ...]) -> Outcome:
    """The outcome, with what the accepted ones rest on."""
    theorems: dict[str, list[str]] = {}
    references: dict[str, str] = {}
    granted: dict[str, tuple[str, ...]] = {}
    rules: dict[str, tuple[tuple[str, str], ...]] = {}
    for one in checked:
        if not one.accepted:
            continue
        below = [its.finding for its in _rests_on(one, settled)]
        applied = {name: where for its in below for name, where in its.theorems}
        for name in sorted(applied):
            theorems.setdefault(name, []).append(one.file)
            references[name] = applied[name]
        granted[one.file] = tuple(dict.fromkeys(line for its in below for line in its.granted))
        rules[one.file] = tuple(sorted({rule for its in below for rule in its.rules}))
    files = {name: tuple(theorems[name]) for name in sorted(theorems)}
    return Outcome(checked, tuple(_alarms(checked)), files, references, granted, rules, limited)


def _rests_on(one: Checked, settled: dict[str, Checked]) -> list[Checked]:
    """A certificate and all that it uses, directly or not."""
    result = {one.finding.digest: one}
    waiting = [one]
    while waiting:
        for digest in waiting.pop().finding.uses.values():
            if digest in settled and digest not in result:
                result[digest] = settled[digest]
                waiting.append(settled[digest])
    return list(result.values())


def _alarms(checked: tuple[Checked, ...]) -> Iterator[Alarm]:
    """Statements that are both proved and refuted, whatever became of what the certificates rest on."""
    # of each statement in which part it is, the verdict, and where
    said: dict[str, list[tuple[str, str, Checked]]] = {}
    for one in checked:
        for digest, verdict, where in one.finding.shows:
            said.setdefault(digest, []).append((where, verdict, one))
    for digest, places in said.items():
        if len({verdict for _, verdict, _ in places}) == 1:
            continue
        named: dict[str, dict[str, None]] = {"proved": {}, "refuted": {}}
        for where, verdict, one in places:
            named[verdict][f"{one.file} ({where})" if where else one.file] = None
        where, _, first = min(places, key=lambda entry: entry[0])
        of = f"{where} of: " if where else ""
        yield Alarm(digest, of + first.finding.statement, tuple(named["proved"]), tuple(named["refuted"]))
