"""Gains in C: which files, how far rounding moves each torque, and what the gate says of the gains."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from hashlib import sha256
from typing import Any

from lyapcheck import store
from lyapcheck.answers.gate import GateResult, gate
from lyapcheck.answers.gate.certificates import certificates
from lyapcheck.control.gains import GainFile
from lyapcheck.control.limits import limits_for
from lyapcheck.errors import argument_error
from lyapcheck.export.controller import ANGLES, VECTORS, Controller, Sampling, c_names
from lyapcheck.export.rounding import Unbounded
from lyapcheck.files.decimals import decimal_text
from lyapcheck.lyapunov.numeric import arm_digest
from lyapcheck.output.answer import Answer
from lyapcheck.output.digits import at_most
from lyapcheck.output.document import Document, Paragraph, Section, Table
from lyapcheck.output.json import laid_out
from lyapcheck.robots import RobotModel

NO_PERIOD = "nothing judges a sampled loop here: the gains are judged for a controller of infinite rate"
ROUNDING = (
    f"Rounding is a computed bound of |τ_i in C − τ_i|: running errors in balls over all |q_i|, |q_d,i| up "
    f"to {ANGLES[0]} rad and all finite w. Up to 2³⁰ rad it is as the last column says; beyond, C refuses."
)
NOMINAL = "g(q) is that of the arm at its nominal numbers; a payload is not in it."
COMPILE = "next: cc -std=c99 -O2 {name}.c {name}_test.c -lm -o {name}_test && ./{name}_test"


@dataclass(frozen=True)
class Exported:
    """One gain set in C.

    Args:
        controller: what is computed.
        rounding: N·m, of each joint, for each largest angle of `ANGLES`.
        judged: what the gate says of it.
        texts: its C files by name.
    """

    controller: Controller
    rounding: tuple[tuple[Fraction, ...], ...]
    judged: GateResult
    texts: dict[str, str]

    @cached_property
    def record(self) -> dict[str, Any]:
        """All that is to be known of the files."""
        controller, gains = self.controller, self.controller.gains
        sampling = controller.sampling
        return {
            "name": gains.name,
            "c_name": controller.name,
            "robot": controller.model.name,
            "family": gains.family,
            "m": gains.m,
            "kp": [*map(decimal_text, gains.kp)],
            "kv": [*map(decimal_text, gains.kv)],
            "limits": [None if limit is None else decimal_text(limit) for limit in controller.limits],
            "rate": decimal_text(1 / sampling.period),
            "filter": [*map(decimal_text, sampling.filter)],
            "wrapped": sampling.wrapped,
            "hold_samples": sampling.hold,
            "rounding": [
                {"largest_angle": angle, "bounds": [at_most(bound, 4) for bound in bounds]}
                for angle, bounds in zip(ANGLES, self.rounding, strict=True)
            ],
            "gate": {"verdict": self.judged.spoken, "conditions": [*self.judged.deciding]},
            "certified_period": None,
            "certified_period_reason": NO_PERIOD,
            "digests": {
                "arm": arm_digest(controller.model),
                "gains": store.exact(replace(gains, index=0)),
                "certificates": {
                    name: one.digest for name, one in certificates([self.judged]).certificates.items()
                },
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
                controller.model.joints, controller.limits, *self.rounding, strict=True
            )
        )
        verdict = Paragraph(f"gate: {self.judged.spoken_standing} ({', '.join(self.judged.deciding)})")
        return Section(f"{controller.gains.name}: {', '.join(self.files)}", (Table(heads, rows), verdict))

    @property
    def files(self) -> dict[str, str]:
        """The files by name, with the JSON."""
        record = {"schema": Export.schema} | self.record
        return {**self.texts, f"{self.controller.name}.json": f"{laid_out(record)}\n"}


@dataclass(frozen=True)
class Export(Answer):
    """Gain sets in C."""

    schema = "lyapcheck/export/1"

    sets: tuple[Exported, ...]

    def document(self) -> Document:
        """The largest rounding, then set by set."""
        worst = max(bound for one in self.sets for bound in one.rounding[0])
        count = f"{len(self.sets)} gain set{'s' if len(self.sets) > 1 else ''} in C"
        title = f"{count}: rounding moves no torque by more than {at_most(worst, 3)} N·m (computed)"
        period = "Stability is judged for a controller of infinite rate, not for that of NAME_step."
        following = COMPILE.format(name=self.sets[0].controller.name)
        return Document(
            title, tuple(one.section() for one in self.sets), (ROUNDING, NOMINAL, period, following)
        )

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
                **{f"rounding_{a}": at_most(x, 4) for a, x in zip(ANGLES, bounds, strict=True)},
            }
            for one in self.sets
            for joint, limit, *bounds in zip(
                one.controller.model.joints, one.controller.limits, *one.rounding, strict=True
            )
        ]


def export(gain_file: GainFile, model: RobotModel, sampling: Sampling, robot: str | None = None) -> Export:
    """Each gain set of a file as C99, with its bound of rounding.

    Args:
        gain_file: the gains.
        model: the arm; uncertain parameters are at their nominal values.
        sampling: how ``NAME_step`` is called.
        robot: an arm that replaces the one the file names.

    Raises:
        InputError: a family that is not written in C, no limits to judge by, or a bound that there is not.

    Soundness: the bound is computed in balls, outward (``lyapcheck.export``); no certificate shows it.
    """
    limits = limits_for(gain_file, robot)
    arm = model.fixed()
    result = []
    for gains, name in zip(gain_file.gains, c_names([one.name for one in gain_file.gains]), strict=True):
        controller = Controller(gains, arm, limits.torque, sampling, name)
        try:
            rounding = tuple(controller.rounding(angle) for angle in ANGLES)
        except Unbounded as reason:
            rule = f"has no bound of rounding: {reason}"
            raise argument_error("gains", gains.name, rule, "choose numbers of a usual size") from None
        (judged,) = gate(replace(gain_file, gains=(gains,)), robot)
        result.append(Exported(controller, rounding, judged, controller.texts()))
    return Export(tuple(result))
