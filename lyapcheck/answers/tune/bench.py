"""Which gains meet what is asked at the bench, beside others; what limits them and what was given up."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

from lyapcheck.answers import arm_words, assumed_line
from lyapcheck.answers.gate.stability import LASALLE, SCALAR
from lyapcheck.answers.running import running_sentences, runs_of
from lyapcheck.answers.tune.gain_file import gain_file_text, list_text, set_text
from lyapcheck.answers.tune.trial import BY_19, BY_PROOF, NAMES, Trial, Trials
from lyapcheck.control.conditions import ACCEPTED, REJECTED
from lyapcheck.control.gains import Bounds, GainSet
from lyapcheck.control.sampling import record_of, time_text
from lyapcheck.files.decimals import decimal_text, decimal_texts
from lyapcheck.files.loop import NOTHING, LoopEntry
from lyapcheck.output.answer import Answer
from lyapcheck.output.digits import at_most
from lyapcheck.output.document import Block, Bullets, Document, Paragraph, Section, Table, command
from lyapcheck.output.fields import Field, records, table
from lyapcheck.output.text import HEADLINE
from lyapcheck.promise import all_say
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from pathlib import Path

    from lyapcheck.answers.gate import GateResult
    from lyapcheck.control.conditions import Check
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.fields import Vary

IN_WORDS = {BY_19: "(19)", BY_PROOF: "proof"}
STABLE_BY = {"19": "(19)", SCALAR: "proof", LASALLE: "LaSalle"}
"""The condition of a set that shows stability, in words."""
NONE = "—"
MOST_REMARKS = 3
MOST_NAMED = 3
"""Motions that are named."""
FAR = 100
"""Ratios from here on are not told apart."""
NOTES = (
    "worst: the largest simulated value over its target. A ratio of 1 or less meets all targets.",
    "Simulated motions run until the energy that is left keeps each joint within its band. Dry friction "
    "leaves the error e with k_p |h(e)| = f.",
    "The search is not exhaustive; better gains may exist.",
)
INSIDE = "The gate proves (10i) for the sets that were found: no motor saturates at any state of (11)."
RULES = {"(10i)": "k_p + k_v", "(19)": "k_v"}
"""What keeps which gains from being larger."""
FLAT = (
    "For m ≥ 2 h is flat at the goal: less torque near it, a slower end, and dry friction holds the joint "
    "farther away."
)


@dataclass(frozen=True, eq=False)
class Candidate:
    """A gain set with what it does.

    Args:
        gains: the set, with the conditions by which the gate accepts it; without any where it does not.
        trial: its motions on the whole arm.
        way: how it was asked to be stable.
        held: per joint the conditions that keep its gains from being larger.
        tries: how many sets were tried for it.
        judged: what the gate says of it, with the last of the conditions that may show stability.
    """

    gains: GainSet
    trial: Trial
    way: str
    held: tuple[str, ...] = ()
    tries: int = 0
    judged: GateResult | None = None

    def __repr__(self) -> str:
        return f"<Candidate: {self.gains}>"

    @property
    def result(self) -> GateResult | None:
        """The gate's, if it accepts the set."""
        return self.judged if self.judged is not None and self.judged.verdict == ACCEPTED else None

    @cached_property
    def runs(self) -> tuple[Check, ...]:
        """What the gate says of it as a computer runs it."""
        return () if self.judged is None else runs_of(self.judged)

    @property
    def stable(self) -> str:
        """What shows stability; empty where the gate does not accept the set."""
        return STABLE_BY[self.gains.condition[-1]] if self.result is not None else ""

    @property
    def shown(self) -> str:
        """How stability is shown, in words."""
        if self.result is None:
            broken = [one.id for one in self.runs if one.verdict == REJECTED]
            return f"({broken[0]}) fails" if broken else "no proof of stability was found"
        return self.result.says(f"stable by {self.stable}")


@dataclass(frozen=True, eq=False)
class BenchTuning(Answer):
    """The best gains that were found for each member and way, and others tried beside them."""

    schema = "lyapcheck/tune/1"

    robot: str
    model: RobotModel
    bench: Trials
    sets: tuple[Candidate, ...]
    missing: tuple[str, ...] = ()
    """Why there is no set for a member or way."""
    assumptions: tuple[str, ...] = ()
    arms: str = ""
    """On which arms each motion was tried, where anything varies."""
    bounds: Bounds = field(default_factory=Bounds)
    """Limits that the user gave in place of the arm's."""
    varies: tuple[Vary, ...] = ()
    loop: LoopEntry = NOTHING
    """What the user said of the loop, before the arm file."""
    out: str = ""
    """The file that is meant to be written; empty if none is."""
    marked: bool = False
    """Whether the best set is written, marked, where none meets the targets."""

    @property
    def scope(self) -> str:
        """What was simulated, in one line."""
        count = len(self.bench.tasks)
        motions = "1 motion" if count == 1 else f"{count} motions"
        without = "without the dry friction of the file"
        if not self.model.dry:
            without = "of an arm file without dry friction"
        record = record_of(self.loop, NOTHING, self.model.loop)
        if record is None or record.period is None:
            return f"{motions} of (11) at an infinite rate, {without}"
        count = max((one.trial.as_run for one in self.sets), default=0)
        runs = f"{count} run{'' if count == 1 else 's'} at {time_text(record.period)}, {record.how}"
        return f"{motions}, {runs}, {without}"

    @property
    def good(self) -> list[Candidate]:
        """The sets that meet the targets, best first."""
        return sorted(filter(self.met, self.sets), key=self._rank)

    @property
    def best(self) -> Candidate | None:
        """The best set that was found, one that the gate accepts if there is any."""
        return min(self.sets, key=self._rank, default=None)

    def _rank(self, one: Candidate) -> tuple[bool, float]:
        return not one.stable, one.trial.worst

    @property
    def lacking(self) -> str:
        """Why a target cannot be judged: dry friction that the arm file does not give; empty if it can."""
        joints = self.model.of_unknown_friction
        if self.bench.wishes.rest_error is None or not joints:
            return ""
        return (
            f"the arm file gives no dry friction of {', '.join(joints)}, so the error at rest is not known; "
            "add coulomb = … to the joint"
        )

    def met(self, one: Candidate) -> bool:
        """Whether a set is proved stable and met all that was asked in every motion, and keeps to it."""
        kept = one.trial.kept and one.trial.worst <= 1
        return bool(one.stable) and kept and not self.lacking

    @property
    def written_sets(self) -> list[Candidate]:
        """The sets of the gain file: those that meet the targets, else the best one if asked for."""
        return self.good or ([self.best] if self.marked and self.best is not None else [])

    @property
    def unwritten(self) -> list[str]:
        """Why there is no gain file."""
        hint = "; --best writes the best one" if self.best is not None else ""
        return [] if self.written_sets else [f"note: no set meets the targets, so none is written{hint}"]

    def gain_file(self, folder: Path | None = None) -> str:
        """`written_sets` as a gain file, which will stand in ``folder``; empty where there are none."""
        head = [f"# Asked: {self.bench.wishes.text()}.", f"# Simulated: {self.scope}."]
        if self.varies:
            options = " ".join(f"--vary {one.text}" for one in self.varies)
            head.append(f"# Gains for ranges of the arm: lyapcheck gate FILE {options}")
        texts, shown = [], partial(list_text, digits=self.bench.digits)
        for one in self.written_sets:
            met = "simulated: meets all targets"
            if not self.met(one):
                met = f"BEST FOUND, MISSES THE TARGETS: {'; '.join(self.missed(one))}"
            texts.append(f"# {met}; {one.shown}\n{set_text(one.gains, shown)}")
        return gain_file_text(head, self.robot, texts, self.bounds, self.loop, folder)

    @property
    def exit(self) -> Exit:
        """0 if some set meets the targets, else 3: the search found none, and proves nothing."""
        return Exit.PROVED if self.good else Exit.UNDECIDED

    def document(self) -> Document:
        """The best set joint by joint; in detail what was asked, all sets, then each by itself."""
        named = [f"{_angles(task.q0)} to {_angles(task.q_d)}" for task in self.bench.tasks]
        tasks = "; ".join(named[:MOST_NAMED])
        if len(named) > MOST_NAMED:
            tasks = f"{len(named)} motions, such as {tasks}"
        if self.bench.quantile < 1:
            tasks += f"; of each number {100 * self.bench.quantile:g} % of the motions count"
        arms = f", each on {self.arms}" if self.arms else ""
        asked = Paragraph(f"Asked: {self.bench.wishes.text()}. Simulated from rest, {tasks}{arms}.")
        assumed = [joint for joint, b in zip(self.model.joints, self.model.viscous, strict=True) if b.assumed]
        friction = f" The viscous friction of {', '.join(assumed)} is assumed." if assumed else ""
        warning = Paragraph(f"Other motions and lower rates may miss the targets.{friction}")
        lines = [*filter(None, (self.lacking,)), *self._given_up(), *self.missing]
        said = (Bullets(tuple(lines)),) if lines else ()
        details = (asked, warning, self._overview(), *said, *(self._section(one) for one in self.sets))
        best, blocks = self.best, list[Block]()
        if best is not None:
            blocks.append(self._joints(best))
        aside = self.arms and self.arms not in self._simulated
        apart = [f"each motion was tried on {self.arms}"] if aside else []
        first = [*apart, *(self.missed(best) if best else ()), *lines, *self.model.doubts][:MOST_REMARKS]
        if first:
            blocks.append(Bullets(tuple(first)))
        flat = [FLAT] if any((one.gains.m or 1) > 1 for one in self.sets) else []
        found = [one.result for one in self.sets]
        promises = [one for result in found if result is not None for one in result.grounds.promises]
        inside = [all_say(promises, INSIDE)] if found and all(found) else []
        notes = (*NOTES, *inside, *flat, *self.assumptions)
        lead, granted = [self._simulated], assumed_line(self.model, self.robot)
        if best is not None and best.result is not None:
            lead.append(best.result.says(f"{best.shown}; no motor can saturate"))
        return Document(self._title(), tuple(blocks), notes, tuple(lead), details, granted, self._next())

    def _next(self) -> str:
        """The gate on what was written; else the same search, to be written."""
        if self.out and self.written_sets:
            return command("gate", self.out)
        arm = arm_words(self.robot)
        if self.best is None:
            return command("robot", *arm)
        given = self.bench.wishes.given.items()
        asked = [
            word for name, x in given for word in (f"--{name.replace('_', '-')}", str(x).removesuffix(".0"))
        ]
        return command("tune", *arm, *asked, *([] if self.good else ["--best"]), "--out", "tuned.toml")

    @property
    def _simulated(self) -> str:
        """What was simulated, with the arms if a line has room for them."""
        motions = f"simulated: {self.scope.rpartition(', ')[0]}"
        with_arms = f"{motions}, each on {self.arms}" if self.arms else motions
        simulated = with_arms if len(with_arms) <= HEADLINE else motions
        arm = f" on {self.model.name}" if self.model.dry else ""  # for which line 1 has no room
        return simulated + arm if len(simulated + arm) <= HEADLINE else simulated

    def data(self) -> dict[str, Any]:
        """``results: [{name, m, way, stable_by, met, worst, joints: [...]}]``, runs to six digits."""
        results = [
            {
                "name": one.gains.name,
                "m": one.gains.m,
                "way": one.way,
                "stable_by": one.stable or None,
                "met": self.met(one),
                "condition": list(one.gains.condition),
                "as_run": running_sentences(one.runs, self.model.joints),
                "worst": _six(one.trial.worst),
                "joints": records(self._fields, one, self.model.n),
            }
            for one in self.sets
        ]
        return {
            "robot": self.robot,
            "asked": self.bench.wishes.given,
            "tasks": [
                {"start": _sixes(map(math.degrees, task.q0)), "goal": _sixes(map(math.degrees, task.q_d))}
                for task in self.bench.tasks
            ],
            "simulated": self.scope,
            "arms": self.arms or None,
            "results": results,
            "missing": list(self.missing),
            "assumptions": list(self.assumptions),
        }

    def records(self) -> list[dict[str, Any]]:
        """A row a joint of each set."""
        return [one | joint for one in self.data()["results"] for joint in one.pop("joints")]

    def _title(self) -> str:
        best = self.best
        if best is None:
            return f"? {self.robot}: no gains"
        if self.good:
            where = "without the dry friction of the file" if self.model.dry else f"on {self.model.name}"
            return f"{self._mark} simulated: {best.gains.name} meets the targets {where}"
        if self.lacking and not self.missed(best):
            met = f"{best.gains.name} meets the targets on {self.model.name}"
            return f"? simulated: whether {met} is open; error at rest unknown"
        return f"? simulated: no set meets the targets on {self.model.name}; the best is {best.gains.name}"

    @property
    def _mark(self) -> str:
        """Of a set that meets the targets, perhaps only without the dry friction of the file."""
        return "!" if self.model.dry else "✓"

    def missed(self, one: Candidate) -> list[str]:
        """The targets that a set misses, with the joints and by which factor; or what else it lacks."""
        return [*self._missed_in_motions(one), *([] if one.stable else [one.shown])]

    def _missed_in_motions(self, one: Candidate) -> list[str]:
        result = []
        for name, ratios in one.trial.ratios.items():
            rows = zip(self.model.joints, ratios, strict=True)
            joints = [f"{joint} {_times(ratio)}" for joint, ratio in rows if ratio > 1]
            if joints:
                result.append(f"misses {NAMES[name][0]}, simulated / target: {', '.join(joints)}")
        if one.trial.unrest:
            result.append(one.trial.unrest)
        elif not one.trial.kept:
            result.append(
                f"after {one.trial.T:g} s the energy left does not exclude that a joint leaves its band"
            )
        return result

    def _overview(self) -> Table:
        """All sets, of each the worst joint."""

        def sign(one: Candidate) -> str:
            return self._mark if self.met(one) else "✗" if one.stable else "?"

        def worst(field: Field) -> Field:
            """The column of a number, of the joint where it is largest."""
            return field._replace(of=lambda one: max(field.found(one), key=_known), each=False)

        fields = (
            Field("", sign, " ", align="l"),
            Field("", "gains.name", "gains", align="l"),
            Field("", "gains.m", "m"),
            Field("", lambda one: one.stable or NONE, "stable by", align="l"),
            Field("", lambda one: one.trial.worst, "worst", _times),
            *(worst(field) for field in self._fields if field.to is _sixes),
        )
        return table(fields, [(one,) for one in self.sets], keys=2)

    def _section(self, one: Candidate) -> Section:
        title = f"{one.gains.name} (m = {one.gains.m}, {one.shown})"
        lines = tuple(self._behind(one)) or ("simulated: all targets are met",)
        lines += tuple(running_sentences(one.runs, self.model.joints))
        return Section(title, (self._joints(one), Bullets(lines)))

    def _joints(self, one: Candidate) -> Table:
        return table(self._fields, [(one, i) for i in range(self.model.n)])

    @cached_property
    def _fields(self) -> tuple[Field, ...]:
        """What is said of each joint of a set."""
        gain = partial(decimal_text, places=self.bench.digits)
        return (
            Field("joint", lambda one: self.model.joints, "joint", align="l", each=True),
            Field("kp", "gains.kp", "k_p", gain, decimal_texts, each=True),
            Field("kv", "gains.kv", "k_v", gain, decimal_texts, each=True),
            Field("overshoot", "trial.overshoot", "overshoot [%]", _up, _sixes, each=True),
            Field("settling", "trial.settled", "settling [s]", _seconds, _sixes, each=True),
            Field("torque_share", "trial.share", "torque / limit", _up, _sixes, each=True),
            Field("rest_error", self._rests, "friction error [°]", _degrees, _sixes, each=True),
            Field(
                "held_by",
                lambda one: one.held or ("",) * self.model.n,
                "limited by" if any(map(any, (one.held for one in self.sets))) else "",
                align="l",
                each=True,
            ),
        )

    def _rests(self, one: Candidate) -> list[float]:
        """The error at rest of each joint; NaN where no dry friction is known."""
        rows = zip(one.trial.rest, self.model.coulomb, strict=True)
        return [math.nan if friction is None else float(error) for error, friction in rows]

    def _behind(self, one: Candidate) -> Iterator[str]:
        """What a set misses, and what stands in the way."""
        yield from (f"simulated: {text}" for text in self._missed_in_motions(one))
        if not one.stable:
            yield one.shown
        for rule, gain in RULES.items() if one.trial.worst > 1 else ():
            rows = zip(self.model.joints, one.held, strict=True)
            if joints := [joint for joint, held in rows if rule in held]:
                yield f"{rule} keeps {gain} of {', '.join(joints)} from being larger"

    def _given_up(self) -> Iterator[str]:
        """What (19) costs for each member, where both ways were tried."""
        for m in dict.fromkeys(one.gains.m for one in self.sets):
            by = {one.way: one for one in self.sets if one.gains.m == m}
            if len(by) == 2:
                a, b = (by[way].trial.worst for way in (BY_19, BY_PROOF))
                if b < 0.95 * a:
                    ratios = f"worst ratio {_times(a)} with (19), {_times(b)} by proof"
                    factor = f" ({_times(a / b)} times as much)" if b else ""
                    yield f"simulated: m = {m}: {ratios}{factor}"


def _angles(values: tuple[float, ...]) -> str:
    return f"({', '.join(f'{math.degrees(x):.4g}' for x in values)})°"


def _six(value: float) -> float | None:
    return float(f"{float(value):.6g}") if math.isfinite(value) else None


def _sixes(values: Iterable[float]) -> list[float | None]:
    return [_six(value) for value in values]


def _known(value: float) -> float:
    return -1.0 if math.isnan(value) else value


def _times(ratio: float) -> str:
    return at_most(float(ratio), 3) if ratio < FAR else f"> {FAR}"


def _up(value: float) -> str:
    return NONE if math.isnan(value) else at_most(value, 3)


def _seconds(value: float) -> str:
    return "no" if math.isinf(value) else _up(value)


def _degrees(value: float) -> str:
    if math.isnan(value) or not value:
        return NONE
    return "anywhere" if math.isinf(value) else at_most(value)
