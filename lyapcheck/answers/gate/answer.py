"""The gate's answer: which gain sets hold the conditions, and what to change where they do not."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from lyapcheck.answers.gate.friction import Fact, damping_lines, farthest, friction_lines, held
from lyapcheck.answers.gate.judge import BREAKS_19, GRAVITY, GateResult
from lyapcheck.answers.gate.words import (
    KEYS,
    RULES,
    SYMBOLS,
    about,
    advice,
    advices,
    joint_name,
    largest_shown,
    largest_text,
    limit_ends,
    limit_text,
    margin_shown,
    margin_text,
    spoken_verdict,
    value_text,
)
from lyapcheck.answers.running import INFINITE, farthest_unknown, open_as_run, running_sentences
from lyapcheck.control.conditions import ACCEPTED, REJECTED, UNDECIDED, Check
from lyapcheck.control.gains import CERTIFICATES
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.document import Bullets, Document, Section, Table
from lyapcheck.promise import all_say
from lyapcheck.verdicts import Exit

_NO_ARM = (
    "(19) fails, but it is only sufficient; stability is not judged without the arm: name one with robot = …"
)
_SINGLE = "(10p) fails, but by its √n only: |τ_i| ≤ γ (k_p + k_v) + k_g keeps each joint within its limit"
_NO_FRICTION = (
    "no viscous friction is known of a joint (λmin(B) = 0), so (19) admits no k_v. Without it the origin "
    "is still globally asymptotically stable; what is not known is how fast: no ε₀, no certified time or "
    "error, no bound under a disturbance. A measured friction goes into [bounds] viscous_min"
)
HEADS = ("", "condition", "joint", "value", "limit", "margin", "largest admissible")
NAMED = "!"
"""Accepted, with a fact that no condition is about."""
DIGITS, MARGIN_DIGITS = 20, 12
"""Significant digits of limits and of margins in data; people see fewer."""
LEVELS = {ACCEPTED: Level.PASSED, REJECTED: Level.FAILED, UNDECIDED: Level.UNDECIDED}
NO_DECISION = "* shown, but does not decide; --condition chooses what does"


def remarks(result: GateResult) -> list[str]:
    """What the conditions say about each other, and the bench about the gains, a sentence each."""
    run = running_sentences(result.checks, result.limits.joints, result.failures)
    damping, joints = result.verdict_of(("19",)), result.verdict_of(("10p",))
    missing = [check for check in result.checks if check.id in CERTIFICATES and check.verdict != ACCEPTED]
    outcome = _without_19(result) if damping == REJECTED else []
    if missing and result.verdict_of(("10p", "19")) == ACCEPTED:
        outcome += [f"(10p) and (19) hold, yet no {check.id} certificate was found" for check in missing]
    if joints == REJECTED and result.verdict_of(("10i",)) == ACCEPTED and "10p" in result.deciding:
        outcome.append(_SINGLE + _accepting(result))
    elif result.saturates and result.stable is not None:
        words = "(10i) fails: a motor may saturate, and stability is proved only while none does"
        outcome.append(result.stable.own_promise.says(words))
    model, gains = result.limits.model, result.gains
    if not result.explained or model is None:
        return [*outcome, *run]
    return [
        *outcome,
        *run,
        *friction_lines(gains, model, list(held(gains, model))),
        *damping_lines(gains, model),
    ]


def _without_19(result: GateResult) -> list[str]:
    known, frictionless = result.stable, result.limits.viscous_min == 0
    if known is not None:
        where = "over all its ranges" if result.limits.varied else "at its nominal numbers"
        how = "proved stable while no motor saturates" if result.saturates else "proved stable without it"
        outcome = f"(19) fails, yet the gains are {how}: {_proof(known, where)}"
        outcome += _accepting(result) if "19" in result.deciding else ""
        said = [outcome, _NO_FRICTION] if frictionless else [outcome]
        return [known.own_promise.says(words) for words in said]
    if not result.limits.robot:
        return [_NO_ARM]
    if frictionless:
        return []
    asked = set(CERTIFICATES) & set(result.deciding)
    return [
        f"(19) fails, but it is only sufficient{'' if asked else '; --condition scalar looks for a proof'}"
    ]


def _proof(known: Check, where: str) -> str:
    if known.value is None:
        return f"M(q) ≻ 0 is proved for the arm {where}, the rest is LaSalle's theorem"
    return f"dV/dt < 0 with ε₀ = {decimal_text(known.value)} ({known.id} certificate, for the arm {where})"


def _accepting(result: GateResult) -> str:
    """The options with which the gate would accept, by what this run has shown; empty where it has not."""
    if result.verdict_of((GRAVITY,)) == REJECTED:
        return ""  # a false bound of gravity is rejected whatever decides
    known = result.stable
    instead = {"10p": "10i"} if result.verdict_of(("10p",)) == REJECTED else {}
    if known is not None and result.verdict_of(("19",)) == REJECTED:
        instead["19"] = known.id
    wanted = dict.fromkeys(instead.get(name, name) for name in result.deciding)
    others = tuple(name for name in wanted if known is None or name != known.id)
    if others and result.verdict_of(others) != ACCEPTED:
        return ""
    return f"; {' '.join(f'--condition {name}' for name in wanted)} accepts it"


class GateAnswer(tuple[GateResult, ...], Answer):
    """The results of gain sets, in the order of their files."""

    schema = "lyapcheck/gate/1"

    @property
    def exit_code(self) -> Exit:
        """1 if any set is rejected, else 3 if any is undecided, else 0; strictly, undecided leads to 1."""
        result = {REJECTED if any(map(one.failed, one.failures)) else one.verdict for one in self}
        if REJECTED in result:
            return Exit.REFUTED
        return Exit.UNDECIDED if UNDECIDED in result or not result else Exit.PROVED

    def document(self) -> Document:
        """How many sets got which verdict; a section a set."""
        return Document(self._title(), tuple(map(_section, self)), tuple(self._notes()))

    def data(self) -> dict[str, Any]:
        """``results: [{name, m, verdict, checks: [...]}]``, numbers as decimal strings, limits enclosed."""
        return {"results": [_data(result) for result in self]}

    def records(self) -> list[dict[str, Any]]:
        """A row a check."""
        return [
            {"name": result.name, "m": result.m, **_check_data(result, check)}
            for result in self
            for check in result.checks
        ]

    def annotations(self) -> list[Annotation]:
        """A case a gain set, at the first gain that breaks a condition."""
        return [annotation for result in self for annotation in _annotations(result)]

    def _title(self) -> str:
        verdicts, words = ([getattr(result, name) for result in self] for name in ("verdict", "standing"))
        worst = next((v for v in (REJECTED, UNDECIDED) if v in verdicts), ACCEPTED)
        counts = {word: words.count(word) for word in (REJECTED, BREAKS_19, UNDECIDED, ACCEPTED)}
        counted = "; ".join(self._counted(word, count) for word, count in counts.items() if count)
        facts = [fact for result in self if (fact := _fact(result))]
        symbol = NAMED if worst == ACCEPTED and facts else SYMBOLS[worst]
        said = max(facts, key=_weight)[1] if facts else ""
        return "; ".join(filter(None, (f"{symbol} {counted or 'no gain sets'}", said)))

    def _counted(self, standing: str, count: int) -> str:
        """So many sets of a standing, as the promises on each of them allow to say it."""
        words = f"{count} {standing.replace('breaks', 'break') if count > 1 else standing}"
        known = [result for result in self if result.standing == standing]
        if standing == ACCEPTED:
            return all_say((one for result in known for one in result.grounds.promises), words)
        if standing == BREAKS_19:
            return all_say((result.stable.own_promise for result in known if result.stable), words)
        return words

    def _notes(self) -> Iterator[str]:
        """What the conditions say, and what the numbers rest on."""
        shown = dict.fromkeys(check.id for result in self for check in result.checks)
        yield from (f"({name}) {RULES[name]}" for name in shown)
        if any(not result.decides(check) for result in self for check in result.checks):
            yield NO_DECISION
        if any(result.record is None or result.record.period is None for result in self):
            yield INFINITE
        yield from dict.fromkeys(_assumptions(self))


def _fact(result: GateResult) -> Fact | None:
    """What decides nothing of a set that is accepted: rest beside the goal, and the loop as it is run."""
    model = result.limits.model
    if model is None or not result.explained or result.verdict != ACCEPTED:
        return None
    unknown, open_ = farthest_unknown(result.checks), open_as_run(result.checks)
    far = farthest(result.gains, model) if unknown is None else unknown
    if not open_:
        return far
    return (Fraction(0), open_) if far is None else (far[0], f"{far[1]}; {open_}")


def _weight(fact: Fact) -> Fraction:
    return fact[0]


def _assumptions(results: GateAnswer) -> Iterator[str]:
    return (text for result in results for text in _rests_on(result))


def _rests_on(result: GateResult) -> tuple[str, ...]:
    return (*result.grounds.premises, *result.limits.assumptions)


def _section(result: GateResult) -> Section:
    fact = _fact(result)
    symbol = SYMBOLS[result.verdict] if fact is None else NAMED
    standing = "; ".join((result.spoken_standing, *(() if fact is None else (fact[1],))))
    title = f"{symbol} {result.name}: {standing} ({about(result)}, {result.file.path})"
    rows = tuple([_row(result, check) for check in result.checks])
    said = [*advices(result), *remarks(result)]
    table = Table(HEADS, rows, align="lllrrrr", keys=3)
    return Section(title, (table, Bullets(tuple(said))) if said else (table,))


def _row(result: GateResult, check: Check) -> tuple[str, ...]:
    """One check; a star for one that does not decide."""
    return (
        SYMBOLS[check.verdict],
        check.id if result.decides(check) else f"{check.id} *",
        joint_name(result, check),
        value_text(check),
        limit_text(check),
        margin_shown(check),
        largest_shown(check),
    )


def _data(result: GateResult) -> dict[str, Any]:
    stable = result.stable
    return {
        "name": result.name,
        "file": result.file.path,
        "family": result.gains.family,
        "m": result.m,
        "verdict": result.spoken,
        "standing": result.spoken_standing,
        "deciding": list(result.deciding),
        "strict": result.strict,
        "loop": None if result.record is None else result.record.text,
        "stable_otherwise": None if stable is None else {"condition": stable.id, "eps0": _exact(stable)},
        "remarks": remarks(result),
        "assumptions": list(_rests_on(result)),
        "checks": [_check_data(result, check) for check in result.checks],
    }


def _exact(check: Check) -> str | None:
    return None if check.value is None else decimal_text(check.value)


def _check_data(result: GateResult, check: Check) -> dict[str, Any]:
    place = result.file.place(result.gains, KEYS[check.id], check.joint)
    limit = None if check.limit is None else limit_ends(check.limit, DIGITS)
    return {
        "id": check.id,
        "joint": None if check.joint is None else joint_name(result, check),
        "verdict": spoken_verdict(check),
        "value": _exact(check),
        "limit": None if limit is None else {"lower": limit[0], "upper": limit[1]},
        "margin": None if limit is None else margin_text(check, MARGIN_DIGITS),
        "largest_admissible": None if check.largest_admissible is None else largest_text(check),
        "line": None if place is None else place.line,
        "column": None if place is None else place.column,
        "message": advice(result, check),
    }


def _annotations(result: GateResult) -> Iterator[Annotation]:
    """One case for the set; where it passes, also what dry friction makes of its gains."""
    first = next(iter(result.failures), None)
    place = result.file.place(result.gains, *(() if first is None else (KEYS[first.id], first.joint)))
    level = LEVELS[result.verdict]
    if result.strict and level is Level.UNDECIDED:
        level = Level.FAILED
    head = [] if result.standing in LEVELS else [result.spoken_standing]
    known = [*head, *advices(result), *(() if result.stable is None else remarks(result)[:1])]

    def said(level: Level, rule: str, text: str, message: str) -> Annotation:
        at = (0, 0) if place is None else (place.line, place.column)
        return Annotation(level, rule, text, result.name, "", message, result.file.path, *at)

    asked = "the gains meet " + ", ".join(f"({name})" for name in result.deciding)
    yield said(level, "gate", asked, "; ".join(known) if level is not Level.PASSED else "")
    model = result.limits.model
    stuck = list(held(result.gains, model)) if model is not None and level is Level.PASSED else []
    if model is not None and stuck:
        lines = friction_lines(result.gains, model, stuck)[: len(stuck)]
        yield said(Level.REMARK, "dry-friction", "γ k_p exceeds the dry friction", "; ".join(lines))
    run = running_sentences(result.checks, result.limits.joints) if level is Level.PASSED else []
    if run:
        yield said(Level.REMARK, "loop", "the loop as a computer runs it", "; ".join(run))
