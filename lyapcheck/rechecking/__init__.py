"""``recheck`` as a command, the same behind ``lyapcheck recheck`` and ``python -P -m lyapcheck.check``.

What the checker found is printed, and what it rests on is counted: nothing here decides.
"""

from __future__ import annotations

import argparse
import ast
import io
import json
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from lyapcheck import check
from lyapcheck.check.guard import CannotStart
from lyapcheck.check.judgement import MOST, Limits
from lyapcheck.check.recheck import Checked, Outcome, Unreadable, gather, recheck
from lyapcheck.check.refusal import plain

PACKAGE = "lyapcheck.check"
ROOT = Path(check.__file__).parent
CORE = tuple(f"{PACKAGE}.{name}" for name in ("recheck", "certificate"))
"""What every verdict goes through; the last one is imported by name."""
FUNCTIONS = f"{PACKAGE}.numbers.functions"
"""The bounded functions, which are imported by name."""
GENERAL = (
    "a statement means what its symbols mean for real numbers; whether a robot is so, no certificate says",
    "Python, its integers and fractions, and SHA-256, by which certificates name each other",
    "python-flint and FLINT: exact polynomials and matrices, and balls that contain what they enclose",
    "doubles of IEEE 754: each corner of a box is the rational number that its double is",
    "that the code of the checker itself is right: recheck --trusted lists it for each verdict",
)
"""What every verdict takes for granted; what a theorem does stands with it."""


def lies_in(places: str) -> list[str]:
    """The modules of a rule, from the places ``module:class`` of its statement and its proof."""
    return sorted({place.partition(":")[0] for place in places.split()})


def modules(rules: Iterable[tuple[str, str]]) -> list[str]:
    """All modules that some rules, pairs (name, places of its classes), rest on."""
    result: set[str] = set()
    waiting = {*CORE, *(module for _, places in rules for module in lies_in(places))}
    while waiting:
        result |= waiting
        waiting = {name for module in waiting for name in _imported(module)} - result
    return sorted(result)


@cache
def _imported(module: str) -> frozenset[str]:
    """The modules of the checker that one imports, wherever in its source, and the packages it is in."""
    names, package = set(), module
    while package != PACKAGE:
        package = package.rpartition(".")[0]
        names.add(package)
    for node in ast.walk(ast.parse(source(module).read_bytes())):
        if isinstance(node, ast.ImportFrom):
            names |= {f"{node.module}", *(f"{node.module}.{part.name}" for part in node.names)}
    if FUNCTIONS in names:
        names |= {f"{FUNCTIONS}.{file.stem}" for file in source(FUNCTIONS).parent.glob("*.py")}
    return frozenset(name for name in names if f"{name}.".startswith(f"{PACKAGE}.") and source(name).exists())


def source(module: str) -> Path:
    """The file of a module of the checker."""
    path = ROOT.joinpath(*module.removeprefix(PACKAGE).strip(".").split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


# --- The outcome of a recheck as text or JSON; its statements are rendered from data, not an author's words.


SCHEMA = "lyapcheck/recheck/3"
STATUSES = ("accepted", "refused", "undecided")
VERDICTS = ("proved", "refuted")
INDENT = " " * 11


def text(outcome: Outcome, trusted: bool = False) -> str:
    """Alarms first, then each certificate, then what all of them rest on and how many there are."""
    lines = [*_alarms(outcome)]
    for one in outcome.checked:
        lines += _certificate(one)
    lines.append("")
    if trusted:
        lines += [*_trusted(outcome), ""]
    for name, own in outcome.theorems.items():
        claims = "1 claim rests" if len(own) == 1 else f"{len(own)} claims rest"
        lines.append(f"{claims} on {name} ({outcome.references[name]}): {', '.join(own)}")
    for granted, files in granted_of(outcome).items():
        lines += [f"{files}: taken for granted:", *(f"  {sentence}" for sentence in granted)]
    lines += ["every verdict takes for granted:", *(f"  {sentence}" for sentence in GENERAL)]
    lines += [f"the system keeps no limit on {name} here" for name in unlimited(outcome)]
    n = _counts(outcome)
    accepted = f"{n['accepted']} accepted ({n['proved']} proved, {n['refuted']} refuted)"
    lines += [*_alarms(outcome), f"{accepted}, {n['refused']} refused, {n['undecided']} undecided"]
    return "\n".join(lines) + "\n"


def as_json(outcome: Outcome, trusted: bool = False) -> str:
    """JSON of the schema ``lyapcheck/recheck/3``."""
    counts = _counts(outcome)
    data = {
        "schema": SCHEMA,
        "counts": {name: counts[name] for name in (*STATUSES, *VERDICTS)},
        "alarms": [
            {
                "statement": alarm.statement,
                "statement_digest": alarm.digest,
                "proved": list(alarm.proved),
                "refuted": list(alarm.refuted),
            }
            for alarm in outcome.alarms
        ],
        "granted": list(GENERAL),
        "theorems": {name: list(files) for name, files in outcome.theorems.items()},
        "unlimited": unlimited(outcome),
        "certificates": [_row(one, outcome) for one in outcome.checked],
    }
    if trusted:
        data["trusted"] = {
            verdict: {
                "rules": {name: lies_in(places) for name, places in rules},
                "modules": modules(rules),
            }
            for verdict, rules in _sums(outcome)
        }
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"


def _certificate(one: Checked) -> Iterator[str]:
    result = one.finding
    if one.accepted:
        yield f"accepted   {one.file}: {result.verdict} [{one.grade}]: {result.statement}"
    else:
        yield f"{one.status:<9}  {one.file}: {one.reason}"
    if one.status == "undecided" and result.statement:
        yield f"{INDENT}the statement, if the rest is shown {result.verdict}: {result.statement}"
    if one.status != "refused" and result.statement:
        member = f" (m = {result.m})" if result.m is not None else ""
        words = f"{result.label}{member}: “{result.says}”"
        yield f"{INDENT}statement {result.statement_digest[:12]}; the author's words: {words}"


def granted_of(outcome: Outcome) -> dict[tuple[str, ...], str]:
    """What statements take for granted, with all the files of which that is so."""
    groups: dict[tuple[str, ...], list[str]] = {}
    for one in outcome.checked:
        if granted := outcome.granted.get(one.file):
            groups.setdefault(granted, []).append(one.file)
    return {granted: ", ".join(files) for granted, files in groups.items()}


def _alarms(outcome: Outcome) -> Iterator[str]:
    for alarm in outcome.alarms:
        yield (
            f"ALARM: one statement is both proved, in {', '.join(alarm.proved)}, and refuted, in "
            f"{', '.join(alarm.refuted)}: the checker is wrong; trust none of these verdicts, and report this"
        )
        yield f"{INDENT}statement {alarm.digest[:12]}: {alarm.statement}"


def _trusted(outcome: Outcome) -> Iterator[str]:
    """The certificates that rest on the same rules together, then all of each verdict."""
    groups: dict[tuple[str, tuple[tuple[str, str], ...]], list[str]] = {}
    for one in outcome.checked:
        if one.accepted:
            groups.setdefault((one.finding.verdict, outcome.rules[one.file]), []).append(one.file)
    for (verdict, rules), files in groups.items():
        yield from _code(f"{verdict}: {', '.join(files)}", rules)
    for verdict, rules in _sums(outcome):
        yield from _code(f"all that is {verdict}", rules)


def _code(title: str, rules: tuple[tuple[str, str], ...]) -> Iterator[str]:
    """The rules, each with the modules that it lies in, and all that they rest on."""
    result = modules(rules)
    yield f"trusted for {title}"
    yield from (f"  rule {name}: {', '.join(lies_in(places))}" for name, places in rules)
    yield from (f"  {name}" for name in result)
    yield f"  {len(result)} modules"


def _sums(outcome: Outcome) -> list[tuple[str, tuple[tuple[str, str], ...]]]:
    """The rules behind all certificates of each verdict."""
    result: dict[str, set[tuple[str, str]]] = {}
    for one in outcome.checked:
        if one.accepted:
            result.setdefault(one.finding.verdict, set()).update(outcome.rules[one.file])
    return [(verdict, tuple(sorted(rules))) for verdict, rules in sorted(result.items())]


def unlimited(outcome: Outcome) -> list[str]:
    """What the system keeps no limit on here."""
    return [name for name in ("seconds", "memory") if name not in outcome.limited]


def _counts(outcome: Outcome) -> Counter[str]:
    return Counter((*(one.status for one in outcome.checked), *(one.verdict for one in outcome.checked)))


def _row(one: Checked, outcome: Outcome) -> dict[str, Any]:
    result, read = one.finding, bool(one.finding.verdict)
    return {
        "file": one.file,
        "status": one.status,
        "accepted": one.accepted,
        "reason": one.reason,
        "statement": result.statement if read else None,
        "statement_digest": result.statement_digest if read else None,
        "verdict": one.verdict or None,
        "grade": one.grade if one.accepted else None,
        "granted": list(outcome.granted.get(one.file, ())),
        "rules": [name for name, _ in outcome.rules.get(one.file, ())],
        "id": result.label if read else None,
        "m": result.m,
        "n": result.n,
        "comment": result.says if read else None,
        "uses": [plain(claim) for claim in result.uses],
        "given": [plain(claim) for claim in one.given],
        "digest": result.digest or None,
    }


UNUSABLE = 2
Writer = Callable[[Outcome, bool], str]
FORMATS: Mapping[str, Writer] = {"text": text, "json": as_json}
HELP = {
    "format": "How to write it.",
    "full": "Write long statements, and what their authors say of them, whole.",
    "trusted": "Also list the rules and modules that each verdict rests on.",
    "seconds": "The most computing time, in s, for one certificate; past it, it is undecided.",
    "memory": "The most memory, in MiB, for one certificate; past it, it is undecided.",
}
REPAIR = "give files written with --certificates, or their folders"


def run(
    certificates: Sequence[str],
    format: str,  # noqa: A002
    full: bool,
    trusted: bool,
    seconds: int,
    memory: int,
    formats: Mapping[str, Writer] = FORMATS,
) -> int:
    """Print the outcome; 0: all accepted, 1: some refused, 2: unusable, 3: some undecided, 4: an alarm."""
    try:
        outcome = recheck(gather(certificates), Limits(seconds, memory), full)
    except Unreadable as error:
        for name, rule in error.problems:
            print(f"error: {name}: CERTIFICATE: {rule}; {REPAIR}", file=sys.stderr)
        return UNUSABLE
    except CannotStart as error:
        print(f"error: --memory = {memory}: {error}; allow more", file=sys.stderr)
        return UNUSABLE
    sys.stdout.write(formats[format](outcome, trusted))
    return outcome.code


# --- ``python -P -m lyapcheck.check CERTIFICATE…``: the same without any other library.


INTERRUPTED = 130


def main(arguments: list[str] | None = None) -> int:
    """Parse the options of :func:`run`, and run."""
    parser = argparse.ArgumentParser(prog="python -P -m lyapcheck.check", description=__doc__)
    parser.add_argument("certificates", nargs="+", metavar="CERTIFICATE", help="files or directories")
    parser.add_argument("--format", choices=FORMATS, default="text", help=HELP["format"])
    for name in ("full", "trusted"):
        parser.add_argument(f"--{name}", action="store_true", help=HELP[name])
    for name in ("seconds", "memory"):
        least = getattr(Limits(), name)
        parser.add_argument(f"--{name}", type=_positive, default=least, help=f"{HELP[name]} [{least}]")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    try:
        return run(**vars(parser.parse_args(arguments)))
    except KeyboardInterrupt:
        return INTERRUPTED


def _positive(word: str) -> int:
    value = int(word)
    if not 1 <= value <= MOST:
        raise argparse.ArgumentTypeError(f"must be from 1 to {MOST}")
    return value
