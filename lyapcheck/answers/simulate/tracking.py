"""Tracking: one run a gain set along a reference under (21), beside what is promised of it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction

import numpy as np

from lyapcheck.answers.simulate import (
    BREACH,
    Simulation,
    accuracy,
    degrees,
    headline,
    lower,
    plain,
    plains,
    row,
    sized,
)
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.digits import NONE, at_most
from lyapcheck.output.document import Block, Bullets, Paragraph, Section
from lyapcheck.output.fields import Field, data, records
from lyapcheck.simulate.tracking import TrackingRun

ESTIMATED = (
    "Estimated: by theory at the arm's nominal numbers, for all times and all motions from this start, "
    "with bounds of M, C and q̇_d that no certificate shows; seen: in one run."
)


def up(value: Fraction | None) -> str:
    """A bound in four digits, never rounded down; a dash where there is none."""
    return NONE if value is None else at_most(max(value, Fraction(0)))


def above(value: Fraction) -> float:
    """The smallest double that is not below."""
    return Enclosure(value, value).float_upper


def all_above(values: Iterable[Fraction]) -> list[float]:
    """The same of each."""
    return list(map(above, values))


def _inside(one: TrackingRun) -> list[str]:
    """Whether the torque of a joint is estimated to stay inside its motor's limit, or was seen to."""
    totals = [None] * len(one.joints) if one.promise.torque is None else one.promise.torque.total
    rows = zip(one.torque_limit, one.indices.peak_torque, totals, strict=True)
    return [
        ""
        if limit is None
        else "NO"
        if peak > limit
        else "estimated"
        if total is not None and total <= limit
        else "seen"
        for limit, peak, total in rows
    ]


YES = {True: "yes", False: "no"}
SEEN = (
    Field("reference_speed", lambda one: plain(one.largest(one.speed))),
    Field("error_rate", lambda one: plain(one.largest(one.w))),
    Field("tightness", "tightness", to=plain),
)
PROMISED = (
    Field("reference_speed", "promise.suprema.speed", to=above),
    Field("reference_acceleration", "promise.suprema.acceleration_norm", to=above),
    Field("eps0", "eps0"),
    Field("largest_eps0", "promise.largest", to=decimal_text),
    Field("V_falls", "promise.falls"),
    Field("reason", "promise.reason"),
    Field("torque_bound", "promise.torque.total", to=all_above, csv=None),
    Field("error_rate", "promise.torque.error_rate", to=above),
)
FIELDS = (
    Field("name", "name", "gains", align="l"),
    Field("m", "m"),
    Field("robot", "robot"),
    Field("kind", "kind"),
    Field("reference", "reference.sentence"),
    Field("complete", "complete"),
    Field("time", "task.T"),
    Field("reached", lambda one: plain(one.t[-1])),
    Field("joints", "joints", "joint", to=list, align="l", each=True, csv="joint"),
    Field("start", lambda one: one.q[0], to=degrees, each=True),
    Field("rms", "indices.rms", "rms [°]", "z.4f", plains, each=True),
    Field("peak_error", "indices.peak_error", "peak error [°]", "z.3f", plains, each=True),
    Field("entered", "indices.entered", "within {band} from [s]", "z.3f", plains, each=True),
    Field("final_error", "indices.final_error", "final error [°]", "z.4f", plains, each=True),
    Field("peak_torque", "indices.peak_torque", "peak torque [N·m]", "z.2f", plains, each=True),
    Field("", "promise.torque.total", "estimated [N·m]", up, all_above, each=True, csv="promised_torque"),
    Field("torque_limit", "torque_limit", "limit [N·m]", lower, list, each=True),
    Field("", _inside, "inside limit", align="l", each=True, csv=None),
    Field("L2", "indices.L2", "L2 [°]", ".4f", plain),
    Field("", "eps0", "ε₀", lower, csv=None),
    Field("", "promise.largest", "estimated Θ′ ≻ 0 up to", lower, csv=None),
    Field("", "promise.falls", "estimated to fall", YES.__getitem__, align="l", csv=None),
    Field("band", lambda one: plain(math.degrees(one.band))),
    Field("V_start", lambda one: one.V[0], "V(0) [J]", ".5g", plain),
    Field("V_end", lambda one: one.V[-1], "V at end [J]", ".3g", plain),
    Field("accuracy", "accuracy", to=plain),
    Field("work_balance", "work_balance", to=plain),
    Field("seen", lambda one: data(SEEN, one)),
    Field("promised", lambda one: data(PROMISED, one), csv=None),
    Field("", lambda one: records(PROMISED, one)[0], csv="promised"),
    *BREACH,
)
"""Angles in degrees, rates in rad/s; what is promised is rounded outward."""


class TrackingRuns(Simulation[TrackingRun]):
    """Runs along a reference, with their indices beside what theory promises."""

    fields = FIELDS
    legend = (ESTIMATED,)
    promised = "dV/dt stays below −zᵀΘ'z, each |τ_i| within its bound for (21), every motor within its limit"

    def motions(self) -> Sequence[str]:
        """That there was a reference."""
        return ("tracking (21)",)

    def opening(self) -> Sequence[Block]:
        """The reference."""
        return [
            Paragraph(f"Reference: {text}.")
            for text in dict.fromkeys(one.reference.sentence for one in self.results)
        ]

    def section(self, one: TrackingRun) -> Section:
        """A row a joint, and what is estimated beside what was seen."""
        head = headline(one, f"from {row(np.round(np.degrees(one.q[0]), 9))}°")
        return Section(f"{self.mark(one.name)} {head}".strip(), (self.by_joint(one), Bullets(_facts(one))))


def _facts(one: TrackingRun) -> tuple[str, ...]:
    speed = up(one.promise.suprema.speed)
    return (
        f"estimated: ‖q̇_d‖ ≤ v_d = {speed} rad/s, seen {at_most(one.largest(one.speed))}",
        *_promised(one),
        f"{accuracy(one)}; work balance {sized(one.work_balance)}",
    )


def _promised(one: TrackingRun) -> list[str]:
    promise = one.promise
    if one.bound is None:
        return [f"no bound of dV/dt or of the torque: {promise.reason}"]
    kept = one.breach is None or not one.breach.promise.startswith("dV/dt")
    share = (
        ""
        if math.isnan(one.tightness)
        else f"; up to {at_most(100 * one.tightness, 3)} % of the fall was estimated"
    )
    lines = [f"V need not fall: {promise.reason}"] if promise.reason else []
    lines.append(f"seen: dV/dt ≤ −zᵀΘ'z {'at all' if kept else 'NOT at all'} {one.t.size} samples{share}")
    if promise.torque is not None:
        most, seen = up(promise.torque.error_rate), one.largest(one.w)
        lines.append(f"estimated: ‖q̇ − q̇_d‖ ≤ {most} rad/s, seen {at_most(seen)}")
    return lines
