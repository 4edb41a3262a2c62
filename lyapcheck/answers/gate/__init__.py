"""The gate: which gain sets hold the conditions that must hold, and what to change where they do not."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck.answers.gate.friction import damping_lines, friction_lines, held
from lyapcheck.answers.gate.judge import DAMPED, GRAVITY, GateResult, judged_sets
from lyapcheck.answers.gate.words import FIELDS, RULES, Row, advices
from lyapcheck.answers.running import running_sentences
from lyapcheck.control.conditions import ACCEPTED, REJECTED, UNDECIDED
from lyapcheck.control.gains import CERTIFICATES, DECIDING, GainFile, gain_file_of
from lyapcheck.control.limits import Limits
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.loop import NOTHING, LoopEntry
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.digits import at_least
from lyapcheck.output.document import Document
from lyapcheck.output.fields import Field, data
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck._types import Progress
    from lyapcheck.robots import ArmLike

__all__ = ["DECIDING", "GateAnswer", "GateResult", "gate"]

LEVELS = {ACCEPTED: Level.PASSED, REJECTED: Level.FAILED, UNDECIDED: Level.UNDECIDED}
_NO_ARM = (
    "(19) fails, but it is only sufficient; stability is not judged without the arm: name one with robot = …"
)
_SINGLE = "(10p) fails, but by its √n only: |τ_i| ≤ γ (k_p + k_v) + k_g keeps each joint within its limit"
_NO_FRICTION = (
    "no viscous friction is known of a joint (λmin(B) = 0), so (19) admits no k_v. Without it the origin "
    "is still globally asymptotically stable; what is not known is how fast: no ε₀, no certified time or "
    "error, no bound under a disturbance. State a measured friction as viscous in the arm file"
)


OTHERWISE = (Field("condition", "id"), Field("eps0", "value", to=decimal_text))
"""What is said of a proof of stability."""


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
        """One gain set with its deciding checks, or a row a set."""
        from lyapcheck.answers.gate.document import document

        return document(self)

    def data(self) -> dict[str, Any]:
        """``results: [{name, m, verdict, checks: [...]}]``, numbers as decimal strings, limits enclosed."""
        return {
            "results": [
                {
                    "name": result.name,
                    "file": result.file.path,
                    "family": result.gains.family,
                    "m": result.m,
                    "verdict": result.spoken,
                    "standing": result.spoken_standing,
                    "deciding": list(result.deciding),
                    "strict": result.strict,
                    "loop": None if result.record is None else result.record.text,
                    "stable_otherwise": None if result.stable is None else data(OTHERWISE, result.stable),
                    "remarks": remarks(result),
                    "assumptions": list(result.rests_on),
                    "checks": [data(FIELDS, Row(result, check)) for check in result.checks],
                }
                for result in self
            ]
        }

    def records(self) -> list[dict[str, Any]]:
        """A row a check."""
        return [
            {"name": result.name, "m": result.m, **data(FIELDS, Row(result, check))}
            for result in self
            for check in result.checks
        ]

    def annotations(self) -> list[Annotation]:
        """A case a gain set, at the first gain that breaks a condition."""
        return [annotation for result in self for annotation in _annotations(result)]


def gate(
    gain_file: GainFile | str | Path,
    robot: ArmLike | None = None,
    deciding: Sequence[str] | None = None,
    strict: bool = False,
    arms: dict[str, Limits] | None = None,
    on_progress: Progress | None = None,
    loop: LoopEntry = NOTHING,
) -> GateAnswer:
    """Decide (10), (10p) and (19) for every gain set of a file, and the certificates that are asked for.

    Args:
        gain_file: a gain file or its path.
        robot: an arm, its name or the path of its file, instead of the arm of the gain file.
        deciding: the conditions that must hold. Default: the conditions of each set, else (10p) and (19).
        strict: True counts undecided as a failure.
        arms: arms already read, by name, for many files on one arm. Arms that are read now are added.
        on_progress: receives the fraction done, and the certificate in search.
        loop: the sampled loop, which replaces the loop in the files.

    Raises:
        InputError: no arm to judge the gains by, or an unknown condition.

    Soundness: ``lyapcheck.check.verify`` makes every verdict, on a statement with a proof.
        ``lyapcheck.answers.gate.certificates`` writes both as a certificate. Without a proof the verdict is
        ``undecided``.

    References: (10), (19) and Section 4 of reyes2019family.

    Example:
        >>> from lyapcheck import paper_gain_file
        >>> [result.verdict for result in gate(paper_gain_file("table2"))]
        ['accepted', 'rejected', 'rejected']
    """
    file = gain_file_of(gain_file)
    return GateAnswer(judged_sets(file, robot, deciding, strict, arms, on_progress=on_progress, loop=loop))


def _annotations(result: GateResult) -> Iterator[Annotation]:
    """One case for the set; where it passes, also what dry friction makes of its gains."""
    first = next(iter(result.failures), None)
    spot = result.file.spot(result.gains, *(() if first is None else (RULES[first.id].key, first.joint)))
    level = LEVELS[result.verdict]
    if result.strict and level is Level.UNDECIDED:
        level = Level.FAILED
    head = [] if result.standing in LEVELS else [result.spoken_standing]
    known = [*head, *advices(result), *(() if result.stable is None else remarks(result)[:1])]

    def said(level: Level, rule: str, text: str, message: str) -> Annotation:
        return Annotation(level, rule, text, result.name, "", message, **spot)

    asked = "the gains meet " + ", ".join(f"({name})" for name in result.deciding)
    yield said(level, "gate", asked, "; ".join(known) if level is not Level.PASSED else "")
    model = result.limits.model
    stuck = list(held(result.gains, model)) if model is not None and level is Level.PASSED else []
    if model is not None and stuck:
        lines = friction_lines(result, model, stuck)[: len(stuck)]
        yield said(Level.REMARK, "dry-friction", "γ k_p exceeds the dry friction", "; ".join(lines))
    run = running_sentences(result.checks, result.limits.joints) if level is Level.PASSED else []
    if run:
        yield said(Level.REMARK, "loop", "the loop as a computer runs it", "; ".join(run))


# --- Remarks: what is said of a gain set beside its checks.


def remarks(result: GateResult) -> list[str]:
    """What the conditions say about each other, and the bench about the gains."""
    run = running_sentences(result.checks, result.limits.joints, result.failures)
    joints = result.verdict_of(("10p",))
    missing = [check for check in result.checks if check.id in CERTIFICATES and check.verdict != ACCEPTED]
    outcome = without_19(result)
    if missing and result.verdict_of(("10p", "19")) == ACCEPTED:
        outcome += [f"(10p) and (19) hold, yet no {check.id} certificate was found" for check in missing]
    if joints == REJECTED and result.verdict_of(("10i",)) == ACCEPTED and "10p" in result.deciding:
        outcome.append(_SINGLE + _accepts(result))
    elif result.saturates and result.stable is not None:
        words = "(10i) fails: a motor may saturate, and stability is proved only while none does"
        outcome.append(result.stable.own_promise.says(words))
    model, gains = result.limits.model, result.gains
    if not result.explained or model is None:
        return [*outcome, *run]
    friction = friction_lines(result, model, list(held(gains, model)))
    return [*outcome, *run, *friction, *damping_lines(gains, model)]


def without_19(result: GateResult) -> list[str]:
    """What is known of stability where (19) fails."""
    if result.verdict_of(("19",)) != REJECTED:
        return []
    known, frictionless = result.stable, result.limits.viscous_min == 0
    if known is not None:
        where = "over all its ranges" if result.limits.varied else "at its nominal numbers"
        how = "proved stable while no motor saturates" if result.saturates else "proved stable without it"
        proof = f"M(q) ≻ 0 is proved for the arm {where}, the rest is LaSalle's theorem"
        if known.value is not None:
            eps0 = at_least(known.value)
            proof = f"dV/dt < 0 with ε₀ = {eps0} ({known.id} certificate, for the arm {where})"
        outcome = f"(19) fails, yet the gains are {how}: {proof}"
        outcome += _accepts(result) if "19" in result.deciding else ""
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


def proved_otherwise(result: GateResult, titled: bool = False) -> str:
    """The same in a line, of a set that breaks nothing but (19).

    Args:
        result: of the gate.
        titled: whether the line before says which numbers this is about.
    """
    known = result.stable
    assert known is not None
    nominal = " at nominal numbers" if result.limits.nominal and not titled else ""
    return known.own_promise.says(f"proved stable ({known.id}){nominal}{_accepts(result)}")


def _accepts(result: GateResult) -> str:
    options = accepting(result)
    return f"; {' '.join(options)} accepts it" if options else ""


def accepting(result: GateResult) -> list[str]:
    """The options with which the gate would accept, by what this run has shown; none where it has not."""
    if result.verdict == ACCEPTED or result.verdict_of((GRAVITY, DAMPED, *result.broken)) == REJECTED:
        return []  # a false bound of gravity and an unstable loop are rejected whatever decides
    known = result.stable
    instead = {"10p": "10i"} if result.verdict_of(("10p",)) == REJECTED else {}
    if known is not None and result.verdict_of(("19",)) == REJECTED:
        instead["19"] = known.id
    wanted = dict.fromkeys(instead.get(name, name) for name in result.deciding)
    others = tuple(name for name in wanted if known is None or name != known.id)
    if others and result.verdict_of(others) != ACCEPTED:
        return []
    return [word for name in wanted for word in ("--condition", name)]
