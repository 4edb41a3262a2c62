"""Gains in C: which files, how far rounding moves each torque, and what the gate says of the gains."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from hashlib import sha256
from typing import Any

from lyapcheck import asked, store
from lyapcheck.answers.gate import GateResult, gate
from lyapcheck.answers.gate.certificates import certificates
from lyapcheck.answers.running.sampled import periods_text
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.control.gains import GainFile, GainSet
from lyapcheck.control.judgement import JudgedStatement
from lyapcheck.control.limits import Limits, limits_for
from lyapcheck.control.sampled import judged_sampled, largest_period, require_sampled
from lyapcheck.control.sampling import LoopRecord
from lyapcheck.errors import argument_error
from lyapcheck.export.controller import ANGLES, VECTORS, Controller, c_names
from lyapcheck.export.steps import Unbounded
from lyapcheck.files.decimals import decimal_text, significant_down
from lyapcheck.lyapunov.numeric import arm_digest
from lyapcheck.output.answer import Answer
from lyapcheck.output.digits import at_most
from lyapcheck.output.document import Document, Paragraph, Section, Table
from lyapcheck.output.json import laid_out
from lyapcheck.promise import Promise, promised, told
from lyapcheck.robots import RobotModel
from lyapcheck.robots.dynamics import TooManyTerms

PROOF = "export"
ROUNDING = (
    f"Rounding is a computed bound of |τ_i in C − τ_i|: running errors in balls over all |q_i|, |q_d,i| up "
    f"to {ANGLES[0]} rad and all finite w. Up to 2³⁰ rad it is as the last column says; beyond, C refuses."
)
NOMINAL = "g(q) is that of the arm at its nominal numbers; a payload is not in it."
IDEAL = "The gate judges a controller of infinite rate. What the line below it supposes stands in NAME.json."
COMPILE = "next: cc -std=c99 -O2 {name}.c {name}_test.c -lm -o {name}_test && ./{name}_test"


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
            "kp": [*map(decimal_text, gains.kp)],
            "kv": [*map(decimal_text, gains.kv)],
            "limits": [None if limit is None else decimal_text(limit) for limit in controller.limits],
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

    def section(self) -> Section:
        """Joint by joint."""
        controller, heads = self.controller, ("joint", "limit [N·m]", "rounding [N·m]", "up to 2³⁰ rad [N·m]")
        rows = tuple(
            (joint, "—" if limit is None else decimal_text(limit), *(at_most(x, 4) for x in bounds))
            for joint, limit, *bounds in zip(
                controller.model.joints, controller.limits, *self.rounding, strict=False
            )
        )
        verdict = Paragraph(f"gate: {self.judged.spoken_standing} ({', '.join(self.judged.deciding)})")
        sampled = Paragraph(self._sampled_text())
        return Section(
            f"{controller.gains.name}: {', '.join(self.files)}", (Table(heads, rows), verdict, sampled)
        )

    def _sampled_text(self) -> str:
        if self.sampled is None:
            return f"as run: stability is open; {self.reason}"
        loop, question = self.controller.loop, self.certificate.statement
        what = "stable at the goal" if question.conclusion == "goal" else "comes to rest"
        run = loop.text if self.covered else loop.how
        words = f"as run ({run}): {what} {periods_text(question)}, while no motor saturates"
        return self.sampled.says(words) + ("" if self.covered else "; at the period asked for it is open")

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
        assert shown.proof is not None
        says = f"stable as a computer runs it: {gains.name} on {self.controller.model.name}"
        about = About(f"{gains.name}.sampled", says, gains.m, gains.n, PROOF)
        return Certificate(about, shown.statement, shown.shown, shown.grade, shown.proof)

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

    def document(self) -> Document:
        """The largest rounding, then set by set."""
        bounds = [bound for one in self.sets for row in one.rounding[:1] for bound in row]
        worst = max(bounds, default=Fraction(0))
        count = f"{len(self.sets)} gain set{'s' if len(self.sets) > 1 else ''} in C"
        title = f"{count}: rounding moves no torque by more than {at_most(worst, 3)} N·m (computed)"
        following = [COMPILE.format(name=one.controller.name) for one in self.sets[:1]]
        open_ = ", ".join(one.controller.gains.name for one in self.sets if not one.covered)
        said = f"as a computer runs it, stability at the period asked for is open: {open_}"
        sections = tuple(one.section() for one in self.sets)
        return Document(title, sections, (ROUNDING, NOMINAL, IDEAL, *following), (said,) if open_ else ())

    def data(self) -> dict[str, Any]:
        """``results``: a record a set, which is also its file ``NAME.json``."""
        return {"results": [one.record for one in self.sets]}

    def records(self) -> Sequence[dict[str, Any]]:
        """A row a joint."""
        return [
            {
                "name": one.controller.gains.name,
                "c_name": one.controller.name,
                "joint": joint,
                "limit": None if limit is None else decimal_text(limit),
                **{f"rounding_{a}": at_most(x, 4) for a, x in zip(ANGLES, bounds, strict=False)},
            }
            for one in self.sets
            for joint, limit, *bounds in zip(
                one.controller.model.joints, one.controller.limits, *one.rounding, strict=False
            )
        ]


def export(
    gain_file: GainFile,
    model: RobotModel,
    loop: LoopRecord,
    robot: str | None = None,
    *,
    wrapped: bool = False,
    hold: int = 3,
) -> Export:
    """Each gain set of a file as C99, with its bound of rounding.

    Args:
        gain_file: the gains.
        model: the arm; uncertain parameters are at their nominal values.
        loop: how ``NAME_step`` is called; with a period, and velocities by differences.
        robot: an arm that replaces the one the file names.
        wrapped: whether readings jump at a full turn.
        hold: samples without a good reading for which the last torque is sent.

    Raises:
        InputError: a family that is not written in C, no limits to judge by, or a bound that there is not.

    Soundness: the bound is computed in balls, outward (``lyapcheck.export``); no certificate shows it.
    """
    limits = limits_for(gain_file, robot)
    arm = model.fixed()
    result = []
    for gains, name in zip(gain_file.gains, c_names([one.name for one in gain_file.gains]), strict=True):
        controller = Controller(gains, arm, limits.torque, loop, name, wrapped, hold)
        try:
            rounding = tuple(controller.rounding(angle) for angle in ANGLES)
        except Unbounded as reason:
            rule = f"has no bound of rounding: {reason}"
            raise argument_error("gains", gains.name, rule, "choose numbers of a usual size") from None
        (judged,) = gate(replace(gain_file, gains=(gains,)), robot)
        period = _certified_period(gains, model, limits, loop)
        proofs = {name: one.digest for name, one in certificates([judged]).certificates.items()}
        result.append(Exported(controller, rounding, judged, proofs, controller.texts(), *period))
    return Export(tuple(result))


def _certified_period(
    gains: GainSet, model: RobotModel, limits: Limits, loop: LoopRecord
) -> tuple[Promise | None, str]:
    """That the loop is stable at each period up to one just below all that (S) shows; or why it is open."""
    run = require_sampled(loop)
    least = [number.bounds[0] for number in model.viscous]
    conclusion = "goal" if loop.knows_gravity and not model.dry else "rest"
    try:
        question = asked.sampled(gains, run, least, model, conclusion=conclusion)
    except TooManyTerms:
        question = asked.sampled(gains, run, least, None, limits.gravity, conclusion)
    most = largest_period(question)
    if most is None:
        return None, "L k_v of a joint is not below its friction, so that no period is shown"
    question = replace(question, period=significant_down(most * Fraction(9999, 10000), 4))
    return promised(question, judged_sampled(question))
