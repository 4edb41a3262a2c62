"""Gains in C: which files, how far rounding moves each torque, and what the gate says of the gains."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, partial
from hashlib import sha256
from typing import Any

from lyapcheck import store
from lyapcheck.answers import assumed_line, file_words
from lyapcheck.answers.gate import GateResult, gate
from lyapcheck.answers.gate.certificates import certificates
from lyapcheck.answers.running.holds import NO_LINKS
from lyapcheck.answers.running.sampled import AsRun, SampledCheck, largest
from lyapcheck.check.certificate import About
from lyapcheck.control.conditions import REJECTED, UNDECIDED
from lyapcheck.control.gains import GainFile, GainSet
from lyapcheck.control.judgement import JudgedStatement
from lyapcheck.control.limits import Limits, limits_for
from lyapcheck.control.sampling import LoopRecord, judged_sampled, time_text
from lyapcheck.errors import argument_error
from lyapcheck.export import ANGLES, VECTORS, Controller, c_names
from lyapcheck.export.steps import Unbounded
from lyapcheck.files.decimals import decimal_text, decimal_texts, significant_down
from lyapcheck.lyapunov.numeric import arm_digest
from lyapcheck.output import fields
from lyapcheck.output.answer import Answer
from lyapcheck.output.digits import NONE, at_most
from lyapcheck.output.document import Bullets, Document, Section, Table, command
from lyapcheck.output.fields import Field
from lyapcheck.output.json import laid_out
from lyapcheck.output.text import HEADLINE
from lyapcheck.promise import Promise, promised, told
from lyapcheck.robots import RobotModel

PROOF = "export"
ROUNDING = (
    f"Rounding is a computed bound of |τ_i in C − τ_i|: running errors in balls over all |q_i|, |q_d,i| up "
    f"to {ANGLES[0]} rad and all finite w. Up to 2³⁰ rad it is as the last column says; beyond, C refuses."
)
NOMINAL = "g(q) is that of the arm at its nominal numbers; a payload is not in it."
IDEAL = "The gate judges a controller of infinite rate. NAME.json lists the assumptions of the loop as run."


@dataclass(frozen=True)
class Exported:
    """One gain set in C.

    Args:
        controller: what is computed.
        rounding: N·m, of each joint, for each largest angle of `ANGLES`.
        judged: what the gate says of it.
        proofs: digests of the certificates of that, by their names.
        texts: its C files by name.
        sampled: that the loop is stable at each period up to that of the question; none where it is open.
        reason: why it is.
    """

    controller: Controller
    rounding: tuple[tuple[Fraction, ...], ...]
    judged: GateResult
    proofs: dict[str, str]
    texts: dict[str, str]
    sampled: Promise | None
    reason: str

    def __repr__(self) -> str:
        return f"<Exported: {', '.join(sorted(self.files))}>"

    @cached_property
    def record(self) -> dict[str, Any]:
        """All that is to be known of the files."""
        controller, gains, loop = self.controller, self.controller.gains, self.controller.loop
        proof = self.certificate
        return {
            "name": gains.name,
            "c_name": controller.name,
            "robot": controller.model.name,
            "family": gains.family,
            "m": gains.m,
            "kp": decimal_texts(gains.kp),
            "kv": decimal_texts(gains.kv),
            "limits": decimal_texts(controller.limits),
            "period": None if loop.period is None else decimal_text(loop.period),
            "delay": loop.delay,
            "filter": [*map(decimal_text, loop.filter)],
            "wrapped": controller.wrapped,
            "hold_samples": controller.hold,
            "rounding": [
                {"largest_angle": angle, "bounds": [at_most(bound, 4) for bound in bounds]}
                for angle, bounds in zip(ANGLES, self.rounding, strict=False)
            ],
            "gate": {"verdict": self.judged.spoken, "conditions": [*self.judged.deciding]},
            "certified_period": None if proof is None else decimal_text(proof.statement.period),
            "certified_period_reason": self.reason,
            "period_covered": self.covered,
            "conclusion": None if proof is None else proof.statement.conclusion,
            "supposes": told(self.sampled, [] if proof is None else [*proof.statement.granted]),
            "digests": {
                "arm": arm_digest(controller.model),
                "gains": store.exact(replace(gains, index=0)),
                "certificates": self.proofs
                | ({} if proof is None else {f"{controller.name}_sampled.json": proof.digest}),
            },
            "vectors": VECTORS,
            "files": {name: sha256(text.encode()).hexdigest() for name, text in self.texts.items()},
        }

    @property
    def mark(self) -> str:
        """How the gate's verdict and the loop as it is run came out, the worse of both."""
        verdict = self.judged.verdict
        return "✗" if verdict == REJECTED else "?" if verdict == UNDECIDED else "✓" if self.covered else "!"

    @property
    def runs(self) -> str:
        """What is known of the loop at the period asked for, in a word."""
        if self.sampled is None or not self.covered:
            return self.from_rest or "open"
        what = "stable" if self.certificate.statement.conclusion == "goal" else "comes to rest"
        return self.sampled.says(what + ("" if self.mark == "✓" else " while no motor saturates"))

    @property
    def running(self) -> str:
        """The same in a sentence."""
        if self.sampled is None:
            return f"as run: {self.from_rest or f'no period is proved, {self.reason}'}"
        asked = self.certificate.statement
        what = "stable" if asked.conclusion == "goal" else "comes to rest"
        apart = f", no interval above {decimal_text(asked.stretch)} times it" if asked.stretch > 1 else ""
        words = f"as run: {what} up to {time_text(asked.period)}{apart}"
        return self.sampled.says(f"{words}, exact readings, no motor saturated")

    @property
    def from_rest(self) -> str:
        """Where from the gate shows this very loop to be stable, at its period alone; empty where nowhere."""
        for check in self.judged.checks:
            same = isinstance(check, SampledCheck) and check.record == self.controller.loop
            if same and check.promise is not None and check.narrow:
                return check.promise.says(f"stable {check.narrow}")
        return ""

    @property
    def covered(self) -> bool:
        """Whether the loop is shown to be stable at the period asked for."""
        period = self.controller.loop.period
        return self.sampled is not None and period is not None and period <= self.certificate.statement.period

    @property
    def certificate(self) -> Any:
        """Of the loop as it is run; none where its stability is open."""
        if self.sampled is None:
            return None
        gains, shown = self.controller.gains, self.sampled.shown
        assert isinstance(shown, JudgedStatement)
        says = f"stable as a computer runs it: {gains.name} on {self.controller.model.name}"
        return shown.certificate(About(f"{gains.name}.sampled", says, gains.m, gains.n, PROOF))

    @property
    def files(self) -> dict[str, str]:
        """The files by name, with the JSON."""
        record, name = {"schema": Export.schema} | self.record, self.controller.name
        proof = {} if self.sampled is None else {f"{name}_sampled.json": self.certificate.text()}
        return {**self.texts, f"{name}.json": f"{laid_out(record)}\n", **proof}


@dataclass(frozen=True)
class Export(Answer):
    """Gain sets in C."""

    schema = "lyapcheck/export/1"

    sets: tuple[Exported, ...]

    file: GainFile
    model: RobotModel
    robot: str

    def document(self) -> Document:
        """The verdicts, then a set joint by joint, or all sets."""
        if not self.sets:
            return Document("no gain sets in C", next=command("init", "bench"))
        one, several = self.sets[0], len(self.sets) > 1
        period = time_text(one.controller.loop.period or Fraction(0))
        open_ = [each.controller.gains.name for each in self.sets if each.runs == "open"]
        worst = max((each.mark for each in self.sets), key="✓!?✗".index)
        if several:
            tally = Counter(each.judged.spoken for each in self.sets)
            gate = ", ".join(f"{count} {verdict}" for verdict, count in tally.items())
            title = f"{worst} {len(self.sets)} gain sets in C; gate: {gate}; open at {period}: {len(open_)}"
            said = f"open at {period}, as a computer runs it: {', '.join(open_)}"
            lead, longer = [said] * bool(open_) if len(said) <= HEADLINE else [], []
        else:
            gate = one.judged.spoken_standing
            title = f"{worst} {one.controller.gains.name} in C; gate: {gate}; run at {period}: {one.runs}"
            fits = len(one.running) <= HEADLINE
            lead = [one.running if fits else f"{one.running.partition(', ')[0]}; more below"]
            longer = [] if fits else [one.running]
        bound = at_most(max(max(each.rounding[0]) for each in self.sets), 3)
        lead.append(f"rounding moves no torque by more than {bound} N·m (computed, up to {ANGLES[0]} rad)")
        names = [each.controller.name for each in self.sets]
        remarks = (
            *longer,
            f"files: {', '.join(one.files)}" if not several else f"files of each set: {', '.join(names)}",
            f"test: cc -std=c99 -O2 {names[0]}.c {names[0]}_test.c -lm -o run && ./run",
        )
        first = fields.table(SETS, [(each,) for each in self.sets]) if several else _by_joint(one)
        details = [Section(each.controller.gains.name, (_by_joint(each),)) for each in self.sets]
        supposed = Bullets(tuple(f"{each.controller.gains.name}: {each.running}" for each in self.sets))
        return Document(
            title,
            (first, Bullets(remarks)),
            (ROUNDING, NOMINAL, IDEAL),
            tuple(lead),
            (*(details if several else ()), supposed),
            assumed_line(self.model, self.robot),
            self._next(worst),
        )

    def _next(self, worst: str) -> str:
        words = file_words(self.file, self.robot)
        loop = self.sets[0].controller.loop
        unknown = any(check.reason == NO_LINKS for check in self.sets[0].judged.checks)
        if worst == "✗" or loop.period is None or unknown:
            return command("gate", *words)
        rate = decimal_text(1 / loop.period)
        timing = ["--period", f"{decimal_text(loop.period)} s"] if "/" in rate else ["--rate", rate]
        return command("simulate", *words, *timing)

    def data(self) -> dict[str, Any]:
        """``results``: a record a set, which is also its file ``NAME.json``."""
        return {"results": [one.record for one in self.sets]}

    def records(self) -> Sequence[dict[str, Any]]:
        """A row a joint."""
        return [row for one in self.sets for row in fields.records(FIELDS, one, one.controller.model.n)]


def _by_joint(one: Exported) -> Table:
    parts = [field for field in FIELDS if field.each]
    return fields.table(parts, [(one, i) for i in range(one.controller.model.n)])


def _limit(limit: Fraction | None) -> str:
    return NONE if limit is None else decimal_text(limit)


def _rounding(k: int, one: Exported) -> tuple[Fraction, ...]:
    return one.rounding[k]


ROUNDED = ("rounding [N·m]", "up to 2³⁰ rad [N·m]")
"""Heads of the bounds for each largest angle."""
FIELDS = (
    Field("name", "controller.gains.name"),
    Field("c_name", "controller.name"),
    Field("joint", "controller.model.joints", "joint", align="l", each=True),
    Field("limit", "controller.limits", "limit [N·m]", _limit, decimal_texts, each=True),
    *(
        Field(
            f"rounding_{angle}",
            partial(_rounding, k),
            head,
            partial(at_most, digits=4),
            lambda bounds: [at_most(bound, 4) for bound in bounds],
            each=True,
        )
        for k, (angle, head) in enumerate(zip(ANGLES, ROUNDED, strict=True))
    ),
)
"""Of a joint of a set."""
SETS = (
    Field("", "controller.gains.name", "gains", align="l"),
    Field("", "judged.spoken_standing", "gate", align="l"),
    Field("", "runs", "as run", align="l"),
    Field("", lambda one: max(one.rounding[0]), "rounding [N·m]", partial(at_most, digits=4)),
)
"""Of a set."""


def export(
    gain_file: GainFile,
    model: RobotModel,
    loop: LoopRecord,
    *,
    wrapped: bool = False,
    hold: int = 3,
) -> Export:
    """Each gain set of a file as C99, with its bound of rounding.

    Args:
        gain_file: the gains.
        model: the arm; uncertain parameters are at their nominal values.
        loop: how ``NAME_step`` is called; with a period, and velocities by differences.
        wrapped: whether readings jump at a full turn.
        hold: samples without a good reading for which the last torque is sent.

    Raises:
        InputError: a family that is not written in C, no limits to judge by, or a bound that there is not.

    Soundness: the bound is computed in balls, outward (``lyapcheck.export``); no certificate shows it.
    """
    limits = limits_for(gain_file, model)
    arm = model.fixed()
    result = []
    for gains, name in zip(gain_file.gains, c_names([one.name for one in gain_file.gains]), strict=True):
        controller = Controller(gains, arm, limits.torque, loop, name, wrapped, hold)
        try:
            rounding = tuple(controller.rounding[angle] for angle in ANGLES)
        except Unbounded as reason:
            rule = f"has no bound of rounding: {reason}"
            raise argument_error("gains", gains.name, rule, "choose numbers of a usual size") from None
        (judged,) = gate(replace(gain_file, gains=(gains,)), model)
        period = _certified_period(gains, replace(limits, model=model), loop, gain_file.bounds.viscous_min)
        proofs = {name: one.digest for name, one in certificates([judged])[0].items()}
        result.append(Exported(controller, rounding, judged, proofs, controller.texts(), *period))
    return Export(tuple(result), gain_file, model, model.address)


def _certified_period(
    gains: GainSet, limits: Limits, loop: LoopRecord, viscous_min: Fraction | None
) -> tuple[Promise | None, str]:
    """That the loop is stable at each period up to one just below all that (S) shows; or why it is open."""
    try:
        asked = AsRun(gains, limits, loop, viscous_min).question()
    except ValueError as error:
        return None, str(error)
    most, _, why = largest(asked, limits.joints)
    if most is None:
        return None, why.removeprefix("(S) shows no period: ")
    asked = replace(asked, period=significant_down(most[1] * Fraction(9999, 10000), 4))
    return promised(asked, judged_sampled(asked))
