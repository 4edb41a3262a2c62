"""Which gains meet what is asked at the bench, beside others; what limits them and what was given up."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from lyapcheck.answers.simulate.numbers import cell
from lyapcheck.answers.tune.response.trial import Trial
from lyapcheck.answers.tune.response.wishes import BY_19, BY_PROOF, NAMES, Trials
from lyapcheck.control.gains import GainSet
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Bullets, Document, Paragraph, Section, Table
from lyapcheck.verdicts import Exit

IN_WORDS = {BY_19: "(19)", BY_PROOF: "proof"}
OVERVIEW = ("", "gains", "m", "stable by", "worst", "overshoot", "settles", "torque", "friction leaves")
HEADS = (
    "joint",
    "k_p",
    "k_v",
    "overshoot [%]",
    "settles [s]",
    "torque share",
    "friction leaves [°]",
    "held by",
)
NONE = "—"
NOTES = (
    "worst: the largest of what was seen over what was asked; at most 1 where all is met.",
    "Motions are those of the closed loop (11) in floating point, without dry friction, watched until the "
    "energy that is left keeps every joint within its band; what dry friction leaves is k_p |h(e)| = f. That "
    "no gains do better is not proved: a search ended.",
    "(10p) holds for every set that was found: no motor saturates at any state.",
)
RULES = ("(10p)", "(19)")
FLAT = (
    "For m ≥ 2 h is flat at the goal: less torque near it, a slower end, and dry friction holds the joint "
    "farther away."
)


@dataclass(frozen=True, eq=False)
class Candidate:
    """A gain set with what it does.

    Args:
        gains: the set.
        trial: its motions on the whole arm.
        way: how it was asked to be stable; empty for a set from elsewhere.
        stable: by which condition the gate accepts it; empty where it does not.
        held: per joint the conditions that keep its gains from being larger.
        source: where a set from elsewhere is from.
    """

    gains: GainSet
    trial: Trial
    way: str = ""
    stable: str = ""
    held: tuple[str, ...] = ()
    source: str = ""


@dataclass(frozen=True, eq=False)
class BenchTuning(Answer):
    """The best gains that were found for each member and way, and others tried beside them."""

    schema = "lyapcheck/tune/1"

    robot: str
    joints: tuple[str, ...]
    bench: Trials
    sets: tuple[Candidate, ...]
    missing: tuple[str, ...] = ()
    """Why there is no set for a member or way."""
    assumptions: tuple[str, ...] = ()
    arms: int = 1
    """How many values of what is uncertain were tried."""

    @property
    def own(self) -> list[Candidate]:
        """The sets that were found here."""
        return [one for one in self.sets if one.way]

    def met(self, one: Candidate) -> bool:
        """Whether a set is proved stable and met all that was asked in every motion, and keeps to it."""
        return bool(one.stable) and one.trial.kept and one.trial.worst(self.bench.wishes) <= 1

    @property
    def exit(self) -> Exit:
        """0 if some set meets what was asked, else 3: the search found none, and proves nothing."""
        return Exit.PROVED if any(map(self.met, self.own)) else Exit.UNDECIDED

    def document(self) -> Document:
        """What was asked, all sets beside each other, then each by itself."""
        tasks = "; ".join(f"{_angles(task.q0)} to {_angles(task.q_d)}" for task in self.bench.tasks)
        arms = f", each on {self.arms} arms" if self.arms > 1 else ""
        asked = Paragraph(f"Asked: {self.bench.wishes.text()}. From rest, {tasks}{arms}.")
        lines = [*self._given_up(), *self.missing]
        said = (Bullets(tuple(lines)),) if lines else ()
        blocks = (asked, self._overview(), *said, *(self._section(one) for one in self.own))
        flat = [FLAT] if any((one.gains.m or 1) > 1 for one in self.sets) else []
        return Document(self._title(), blocks, (*NOTES, *flat, *self.assumptions))

    def data(self) -> dict[str, Any]:
        """``results: [{name, m, way, stable_by, met, worst, joints: [...]}]``, runs to six digits."""
        return {
            "robot": self.robot,
            "asked": self.bench.wishes.given,
            "tasks": [
                {"start": _degrees_of(task.q0), "goal": _degrees_of(task.q_d)} for task in self.bench.tasks
            ],
            "arms": self.arms,
            "results": [self._data(one) for one in self.sets],
            "missing": list(self.missing),
            "assumptions": list(self.assumptions),
        }

    def records(self) -> list[dict[str, Any]]:
        """A row a joint of each set."""
        rows = []
        for one in self.data()["results"]:
            head = {key: value for key, value in one.items() if key != "joints"}
            rows += [head | joint for joint in one["joints"]]
        return rows

    def _title(self) -> str:
        good = [one for one in self.own if self.met(one)]
        if good:
            best = min(good, key=lambda one: one.trial.worst(self.bench.wishes))
            return f"✓ {self.robot}: {best.gains.name} meets what was asked"
        if not self.own:
            return f"? {self.robot}: no gains"
        best = min(self.own, key=lambda one: one.trial.worst(self.bench.wishes))
        worst = best.trial.worst(self.bench.wishes)
        return (
            f"? {self.robot}: what was asked is not reached; {best.gains.name} comes within {worst:.2f} times"
        )

    def _overview(self) -> Table:
        rows = []
        for one in self.sets:
            trial, worst = one.trial, one.trial.worst(self.bench.wishes)
            rows.append(
                (
                    ("✓" if self.met(one) else "✗" if one.stable else "?") if one.way else "",
                    one.gains.name + (f", {one.source}" if one.source else ""),
                    NONE if one.gains.m is None else str(one.gains.m),
                    one.stable or NONE,
                    f"{worst:.2f}" if worst < 100 else "> 100",
                    f"{_most(trial.overshoot):.0f} %",
                    _seconds(_most(trial.settled, none_is_worst=True)),
                    f"{100 * _most(trial.share):.0f} %",
                    _degrees(float(max(trial.rest))),
                )
            )
        return Table(OVERVIEW, tuple(rows), align="llrlrrrrr", keys=2)

    def _section(self, one: Candidate) -> Section:
        digits = self.bench.digits
        rows = [
            (
                joint,
                decimal_text(one.gains.kp[i], digits),
                decimal_text(one.gains.kv[i], digits),
                cell(float(one.trial.overshoot[i]), ".1f"),
                _seconds(float(one.trial.settled[i])),
                cell(float(one.trial.share[i]), ".2f"),
                _degrees(float(one.trial.rest[i])),
                one.held[i],
            )
            for i, joint in enumerate(self.joints)
        ]
        title = f"{one.gains.name} (m = {one.gains.m}, stable by {one.stable or 'nothing that was found'})"
        lines = tuple(self._missed(one)) or ("all that was asked is met",)
        return Section(title, (Table(HEADS, tuple(rows), align="lrrrrrrl"), Bullets(lines)))

    def _missed(self, one: Candidate) -> Iterator[str]:
        """What a set does not meet, and what stands in the way."""
        wishes = self.bench.wishes
        for name, ratios in one.trial.ratios(wishes).items():
            joints = [
                f"{joint} {ratio:.2f}" for joint, ratio in zip(self.joints, ratios, strict=True) if ratio > 1
            ]
            if joints:
                yield f"{NAMES[name]} beyond what was asked, times: {', '.join(joints)}"
        held = {rule: [j for j, h in zip(self.joints, one.held, strict=True) if rule in h] for rule in RULES}
        if not one.trial.kept:
            yield f"after {one.trial.T:g} s the energy left does not exclude that a joint leaves its band"
        if one.trial.worst(wishes) > 1:
            for rule, joints in held.items():
                if joints:
                    gain = "k_p + k_v" if rule == "(10p)" else "k_v"
                    yield f"{rule} keeps {gain} of {', '.join(joints)} from being larger"

    def _given_up(self) -> Iterator[str]:
        """What (19) costs for each member, where both ways were tried."""
        wishes = self.bench.wishes
        for m in dict.fromkeys(one.gains.m for one in self.own):
            by = {one.way: one for one in self.own if one.gains.m == m}
            if len(by) == 2:
                a, b = (by[way].trial.worst(wishes) for way in (BY_19, BY_PROOF))
                if b < 0.95 * a:
                    yield f"m = {m}: (19) costs a factor of {a / b:.1f} ({a:.2f} to {b:.2f} by proof)"

    def _data(self, one: Candidate) -> dict[str, Any]:
        trial = one.trial
        return {
            "name": one.gains.name,
            "m": one.gains.m,
            "source": one.source or None,
            "way": one.way or None,
            "stable_by": one.stable or None,
            "met": self.met(one),
            "worst": _six(trial.worst(self.bench.wishes)),
            "joints": [
                {
                    "joint": joint,
                    "kp": decimal_text(one.gains.kp[i]),
                    "kv": decimal_text(one.gains.kv[i]),
                    "overshoot": _six(trial.overshoot[i]),
                    "settling": _six(trial.settled[i]),
                    "torque_share": _six(trial.share[i]),
                    "rest_error": _six(trial.rest[i]),
                    "held_by": one.held[i] if one.held else "",
                }
                for i, joint in enumerate(self.joints)
            ],
        }


def _angles(values: tuple[float, ...]) -> str:
    return f"({', '.join(f'{math.degrees(x):g}' for x in values)})°"


def _degrees_of(values: tuple[float, ...]) -> list[float | None]:
    return [_six(math.degrees(x)) for x in values]


def _six(value: float) -> float | None:
    return float(f"{float(value):.6g}") if math.isfinite(value) else None


def _most(values: Any, none_is_worst: bool = False) -> float:
    known = [float(x) for x in values if not math.isnan(x)]
    return math.nan if not known or (none_is_worst and len(known) < len(values)) else max(known)


def _seconds(value: float) -> str:
    return "no" if math.isnan(value) else f"{value:.2f} s"


def _degrees(value: float) -> str:
    return "anywhere" if math.isinf(value) else f"{value:.1f}°" if value else NONE
