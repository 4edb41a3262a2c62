"""Which gains an arm admits: the largest of each member of the family, and what forbids larger ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any

from lyapcheck.answers import arm_words, assumed_line
from lyapcheck.answers.running import running_sentences
from lyapcheck.answers.tune.gain_file import gain_file_text, list_text, set_text
from lyapcheck.answers.tune.targets import Targets
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.control.gains import DECIDING, Bounds, GainSet
from lyapcheck.control.limits import Limits
from lyapcheck.files.decimals import decimal_text, decimal_texts
from lyapcheck.files.loop import NOTHING, LoopEntry
from lyapcheck.output.answer import Answer
from lyapcheck.output.digits import at_least, ends
from lyapcheck.output.document import Block, Bullets, Document, Paragraph, Section, Table, command
from lyapcheck.output.fields import Field, data, table
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from pathlib import Path

    from lyapcheck.control.conditions import Check

TUNED, INFEASIBLE, UNDECIDED = "tuned", "infeasible", "undecided"
BOUNDS = {"10p": "(10p)", "19": "(19)", "damping": "damping"}
MARKS = {TUNED: "✓", INFEASIBLE: "✗", UNDECIDED: "?"}
MOST_REASONS = 3
NONE_FOUND = {
    INFEASIBLE: "no gains in steps of {} N·m within (10p), (19) and the targets",
    UNDECIDED: "its limits are not known, so no gains",
}
LIMITS = ("(10p): k_p + k_v < (τmax − k_g)/(√n γ), N·m.", "(19): k_v < λmin(B)/(√n γ), N·m.")
ENDS = "One unit more in the last place of a gain breaks what it ends at."
DAMPED = (
    "ζ: estimated: the least damping ratio of the joint alone over all ranges of the arm, with the steepest "
    "secant of h in its place."
)
HEAD = (
    "# The largest gains that meet (10p) and (19), with {}.",
    "# One unit more in the last place of any gain breaks what its comment names.",
)
NAMES = BOUNDS | {"damping": "the damping ratio"}


@dataclass(frozen=True)
class TunedJoint:
    """The gains of one joint and what forbids larger ones.

    Args:
        name: of the joint.
        kp: N·m, exact.
        kv: N·m, exact.
        sum_limit: what (10p) keeps k_p + k_v below, N·m.
        kv_limit: what (19) keeps k_v below, N·m.
        kp_bound: ``10p`` or ``damping``: what one unit more of k_p would break.
        kv_bound: ``19`` or ``10p``: what one unit more of k_v would break.
        damping: the damping ratio from below, where one was asked for.
    """

    name: str
    kp: Fraction
    kv: Fraction
    sum_limit: Enclosure
    kv_limit: Enclosure
    kp_bound: str
    kv_bound: str
    damping: Fraction | None = None


@dataclass(frozen=True)
class TunedSet:
    """The gains for one member; ``reasons`` says why there are none, ``runs`` what the loop makes of them."""

    name: str
    m: int
    status: str
    joints: tuple[TunedJoint, ...] = ()
    reasons: tuple[str, ...] = ()
    program: str = ""
    runs: tuple[Check, ...] = ()
    rejected: bool = False
    """Whether there are gains within the limits that the gate rejects."""

    def __repr__(self) -> str:
        return f"<TunedSet: {self.gains or '; '.join(self.reasons)}>"

    @property
    def gains(self) -> GainSet | None:
        """As the gate reads them."""
        if self.status != TUNED:
            return None
        kp, kv = tuple(j.kp for j in self.joints), tuple(j.kv for j in self.joints)
        return GainSet(self.name, self.m, kp, kv, condition=DECIDING)


ASKED = (
    Field("digits", "digits"),
    *(Field(key, key, to=decimal_texts) for key in ("peak_share", "kv_share", "damping")),
)
TUNED_TO = (
    Field("torque", "torque", to=decimal_texts),
    Field("gravity", "gravity", to=decimal_texts),
    Field("viscous_min", "viscous_min", to=decimal_text),
)
"""N·m and N·m·s/rad."""


def of_joint(digits: int, damped: bool) -> tuple[Field, ...]:
    """What is said of a joint, its gains with so many decimal places."""
    gain = partial(decimal_text, places=digits)
    limit, to = partial(at_least, digits=6), partial(ends, digits=20)  # six as the gate shows them
    return (
        Field("joint", "name", "joint", align="l"),
        Field("kp", "kp", "k_p", gain, gain),
        Field("kv", "kv", "k_v", gain, gain),
        Field("sum_limit", "sum_limit", "(10p) limit", limit, to),
        Field("kv_limit", "kv_limit", "(19) limit", limit, to),
        Field("kp_bound", "kp_bound", "k_p ends at", BOUNDS.__getitem__, align="l"),
        Field("kv_bound", "kv_bound", "k_v ends at", BOUNDS.__getitem__, align="l"),
        Field("damping", "damping", "ζ" if damped else "", at_least, decimal_text),
    )


@dataclass(frozen=True)
class Tuning(Answer):
    """Tuned gains of one arm for several members of the family.

    Args:
        robot: the name of the arm.
        title: its title.
        targets: the targets, one value per joint.
        limits: the limits of the search, with the reserve of torque subtracted.
        bounds: limits that the gain file must repeat, because they differ from the arm's.
        sets: one gain set per order m.
        loop: the sampled loop from the user, which replaces the arm file's.
    """

    schema = "lyapcheck/tune/1"

    robot: str
    title: str
    targets: Targets
    limits: Limits
    bounds: Bounds
    sets: tuple[TunedSet, ...]
    loop: LoopEntry = NOTHING

    @property
    def exit(self) -> Exit:
        """0 if every member has gains, else 2 if one provably has none, else 3."""
        result = {item.status for item in self.sets}
        if INFEASIBLE in result:
            return Exit.USAGE
        return Exit.UNDECIDED if UNDECIDED in result or not result else Exit.PROVED

    def document(self) -> Document:
        """The largest gains joint by joint; in detail a table a member."""
        joints = self.limits.joints
        blocks: list[Block] = [_section(item, self.targets.digits, joints) for item in self.sets]
        cells: list[tuple[str, ...]] = [
            ("k_p / k_v [N·m]", *joints),
            *(
                (item.name, *(f"{decimal_text(x.kp)} / {decimal_text(x.kv)}" for x in item.joints))
                for item in self.sets
                if item.joints
            ),
        ]
        found = len(cells) > 1
        if len(cells) <= len(joints):  # a narrow terminal leaves out columns, and must not leave out joints
            cells = list(zip(*cells, strict=True))
        heads, *rows = cells
        short: list[Block] = [Table(heads, tuple(rows))] if found else []
        reasons = (reason for item in self.sets for reason in item.reasons)
        said = list(dict.fromkeys((*reasons, *self.limits.gravity_notes, *self.limits.doubts)))
        if said:
            short.append(Bullets(tuple(said[:MOST_REASONS])))
        details = (Paragraph(f"{self.targets.text()}."), *blocks)
        model, arm = self.limits.model, arm_words(self.robot)
        assumed = "; ".join(self.limits.assumptions) if model is None else assumed_line(model, self.robot)
        member = self.sets[0].m if self.sets else 1
        then = command("tune", *arm, "--m", member, "--overshoot", "5", "--settle", "2")
        if not any(item.joints or item.rejected for item in self.sets):  # no targets help
            then = command("robot", *arm, "-v")
        lead = (self._hardly,) if self._hardly else ()
        notes = (
            *LIMITS,
            *([ENDS] if found else []),
            *([DAMPED] if found and self.targets.damping else []),
            *(f"{text}." for text in self.limits.assumptions),
        )
        return Document(self._verdict(), tuple(short), notes, lead, details, assumed, then)

    def gain_file(self, folder: Path | None = None) -> str:
        """The sets that were found as a gain file, which will stand in ``folder``; empty where none was."""
        texts, shown = [], partial(list_text, digits=self.targets.digits)
        for item in self.sets:
            if item.gains is not None:
                ends = [[NAMES[getattr(one, f"{key}_bound")] for one in item.joints] for key in ("kp", "kv")]
                texts.append(set_text(item.gains, shown, [f"; {', '.join(each)}" for each in ends]))
        head = [line.format(self.targets.text()) for line in HEAD]
        return gain_file_text(head, self.robot, texts, self.bounds, self.loop, folder)

    @property
    def unwritten(self) -> list[str]:
        """Why members are not in the gain file."""
        return [f"no gains for m = {one.m}: {reason}" for one in self.sets for reason in one.reasons]

    def data(self) -> dict[str, Any]:
        """``results: [{name, m, status, joints: [...], reasons}]``, numbers as strings."""
        return {
            "robot": self.robot,
            "targets": data(ASKED, self.targets),
            "limits": data(TUNED_TO, self.limits),
            "assumptions": list(self.limits.assumptions),
            "results": [self._set(item) for item in self.sets],
        }

    def records(self) -> list[dict[str, Any]]:
        """A row a joint of each member; a row a member that has no gains."""
        rows = []
        for item in self.data()["results"]:
            head = {key: item[key] for key in ("name", "m", "status")}
            rows += [head | joint for joint in item["joints"]]
            if not item["joints"]:
                rows.append(head | {"reasons": "; ".join(item["reasons"])})
        return rows

    def _set(self, item: TunedSet) -> dict[str, Any]:
        fields = of_joint(self.targets.digits, False)
        return {
            "name": item.name,
            "m": item.m,
            "status": item.status,
            "reasons": list(item.reasons),
            "joints": [data(fields, joint) for joint in item.joints],
            "program": item.program or None,
            "as_run": running_sentences(item.runs, self.limits.joints),
        }

    def _verdict(self) -> str:
        """The worst of the members decides."""
        for status, words in NONE_FOUND.items():
            failed = [str(item.m) for item in self.sets if item.status == status]
            if failed:
                rejected = any(item.rejected for item in self.sets if item.status == status)
                said = "the gate rejects the largest gains within (10p) and (19)" if rejected else words
                said = said.format(decimal_text(Fraction(1, 10**self.targets.digits)))
                return f"{MARKS[status]} {self.robot}: {said} for m = {', '.join(failed)}"
        return f"{'!' if self._hardly else '✓'} {self.robot}: the largest gains within (10p) and (19)"

    @property
    def _hardly(self) -> str:
        """That some gains hardly damp the arm; empty where none do."""
        from lyapcheck.answers.gate.friction import swinging

        model, sets = self.limits.model, [item.gains for item in self.sets if item.gains is not None]
        found = [swinging(gains, model) for gains in sets] if model is not None else []
        return next(filter(None, found), "")


def _section(item: TunedSet, digits: int, joints: Sequence[str]) -> Section:
    """The gains of a member, or why there are none."""
    title = f"{MARKS[item.status]} {item.name} (m = {item.m})"
    if item.status != TUNED:
        return Section(f"{title}: {item.status}", (Bullets(item.reasons),))
    damped = any(joint.damping is not None for joint in item.joints)
    rows = table(of_joint(digits, damped), [(joint,) for joint in item.joints])
    said = tuple(running_sentences(item.runs, joints))
    return Section(title, (rows, *([Bullets(said)] if said else [])))
