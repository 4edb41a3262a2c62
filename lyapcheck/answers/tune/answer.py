"""Which gains an arm admits: the largest of each member of the family, and what forbids larger ones."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lyapcheck.answers.tune.data import joint_records, limits_data, set_data, targets_data
from lyapcheck.answers.tune.results import INFEASIBLE, TUNED, UNDECIDED, GainComparison, TunedSet
from lyapcheck.answers.tune.targets import Targets
from lyapcheck.control.gains import Bounds
from lyapcheck.control.limits import Limits
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.answer import Answer
from lyapcheck.output.digits import at_least
from lyapcheck.output.document import Block, Bullets, Document, Paragraph, Section, Table
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.answers.tune.effect import Effect
    from lyapcheck.simulate.task import Task

HEADS = ("joint", "k_p", "k_v", "(10p) limit", "(19) limit", "k_p ends at", "k_v ends at")
DAMPING_HEAD = "ζ"
COMPARED_HEADS = ("joint", "k_p", "k_v", "k_p left", "of the largest", "share of (10p)", "breaks")
BOUNDS = {"10p": "(10p)", "19": "(19)", "damping": "damping"}
MARKS = {TUNED: "✓", INFEASIBLE: "✗", UNDECIDED: "?"}
NONE_FOUND = {
    INFEASIBLE: "no gains within (10p) and (19)",
    UNDECIDED: "its limits are not known, so no gains",
}
LIMITS = ("(10p): k_p + k_v < (τmax − k_g)/(√n γ), N·m.", "(19): k_v < λmin(B)/(√n γ), N·m.")
ENDS = "One unit more in the last place of a gain breaks what it ends at."
DAMPED = (
    "ζ: estimated: the least damping ratio of the joint alone over all ranges of the arm, with the steepest "
    "secant of h in its place."
)
LIMIT_DIGITS = 6
"""Significant digits of limits, as the gate shows them."""
LEFT = "k_p left: how much smaller the k_p is than the largest; negative where it is larger."


@dataclass(frozen=True)
class Tuning(Answer):
    """Tuned gains of one arm for several members of the family.

    Args:
        robot: the arm as the user named it.
        title: what it is.
        targets: what was asked for, one value a joint.
        limits: what the gains were tuned to, the share of the torque taken off.
        bounds: the limits that the gain file has to repeat, as the arm alone says otherwise.
        sets: one a member.
        task: a motion on which the members are compared; ``None`` where they are not.
        effects: its runs.
    """

    schema = "lyapcheck/tune/1"

    robot: str
    title: str
    targets: Targets
    limits: Limits
    bounds: Bounds
    sets: tuple[TunedSet, ...]
    task: Task | None = None
    effects: tuple[Effect, ...] = ()

    @property
    def exit(self) -> Exit:
        """0 if every member has gains, else 2 if one provably has none, else 3."""
        result = {item.status for item in self.sets}
        if INFEASIBLE in result:
            return Exit.USAGE
        return Exit.UNDECIDED if UNDECIDED in result or not result else Exit.PROVED

    def document(self) -> Document:
        """A table a member, one for what it is compared with, and what it all rests on."""
        blocks: list[Block] = [_section(item, self.targets.digits) for item in self.sets]
        if self.task is not None and len(self.effects) > 1:
            from lyapcheck.answers.tune.effect import effect_section

            blocks.append(effect_section(self.effects, [math.degrees(x) for x in self.task.q_d], self.task.T))
        return Document(self._verdict(), (Paragraph(f"{self.targets.text()}."), *blocks), self._notes())

    def data(self) -> dict[str, Any]:
        """``results: [{name, m, status, joints: [...], reasons, comparison}]``, numbers as strings."""
        return {
            "robot": self.robot,
            "targets": targets_data(self.targets),
            "limits": limits_data(self.limits),
            "assumptions": list(self.limits.assumptions),
            "results": [set_data(item, self.targets.digits) for item in self.sets],
            "effects": [one.data for one in self.effects],
        }

    def records(self) -> list[dict[str, Any]]:
        """A row a joint of each member."""
        return joint_records(self.data()["results"])

    def _verdict(self) -> str:
        """The worst of the members decides."""
        for status, words in NONE_FOUND.items():
            failed = [str(item.m) for item in self.sets if item.status == status]
            if failed:
                return f"{MARKS[status]} {self.robot}: {words} for m = {', '.join(failed)}"
        return f"✓ {self.robot}: the largest gains within (10p) and (19)"

    def _notes(self) -> tuple[str, ...]:
        tuned = [item for item in self.sets if item.status == TUNED]
        return (
            *LIMITS,
            *([ENDS] if tuned else []),
            *([DAMPED] if tuned and self.targets.damping else []),
            *([LEFT] if any(item.comparison is not None for item in tuned) else []),
            *(f"{text}." for text in self.limits.assumptions),
        )


def _section(item: TunedSet, digits: int) -> Section:
    """The gains of a member, or why there are none."""
    title = f"{MARKS[item.status]} {item.name} (m = {item.m})"
    if item.status != TUNED:
        return Section(f"{title}: {item.status}", (Bullets(item.reasons),))
    compared = () if item.comparison is None else (_compared(item.comparison),)
    return Section(title, (_tuned(item, digits), *compared))


def _tuned(item: TunedSet, digits: int) -> Table:
    damped = any(joint.damping is not None for joint in item.joints)
    rows: list[Sequence[str]] = [
        (
            joint.name,
            decimal_text(joint.kp, digits),
            decimal_text(joint.kv, digits),
            at_least(joint.sum_limit, LIMIT_DIGITS),
            at_least(joint.kv_limit, LIMIT_DIGITS),
            BOUNDS[joint.kp_bound],
            BOUNDS[joint.kv_bound],
            *([] if joint.damping is None else [at_least(joint.damping)]),
        )
        for joint in item.joints
    ]
    heads = (*HEADS, DAMPING_HEAD) if damped else HEADS
    return Table(heads, tuple(map(tuple, rows)), align="lrrrrllr"[: len(heads)])


def _compared(comparison: GainComparison) -> Table:
    rows = tuple(
        (
            joint.name,
            decimal_text(joint.kp),
            decimal_text(joint.kv),
            decimal_text(joint.kp_left),
            f"{at_least(100 * joint.kp_left_share)} %",
            f"{at_least(100 * joint.used)} %",
            ", ".join(BOUNDS[name] for name in joint.broken) or "nothing",
        )
        for joint in comparison.joints
    )
    beside = f"Beside {comparison.name} of {comparison.source}:"
    return Table(COMPARED_HEADS, rows, beside, "lrrrrrl")
