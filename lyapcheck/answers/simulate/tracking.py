"""Tracking: one run a gain set along a reference under (21), beside what is promised of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from lyapcheck.answers.simulate.simulation import (
    Simulation,
    breach_record,
    cell,
    lower,
    plain,
    plains,
    row,
    sized,
)
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.digits import NONE, at_most
from lyapcheck.output.document import Block, Bullets, Paragraph, Section, Table
from lyapcheck.tracking.run import TrackingRun

OVERVIEW = (
    "gains",
    "L2 [°]",
    "ε₀",
    "estimated Θ′ ≻ 0 up to",
    "estimated to fall",
    "V(0) [J]",
    "V at end [J]",
    "promises",
)
ESTIMATED = (
    "Estimated: by theory at the arm's nominal numbers, for all times and all motions from this start, "
    "with bounds of M, C and q̇_d that no certificate shows; seen: in one run."
)
PER_JOINT = ("start", "rms", "peak_error", "entered", "final_error", "peak_torque", "torque_limit")
PER_RUN = ("L2", "band", "V_start", "V_end", "accuracy", "work_balance", "seen")


class TrackingRuns(Simulation[TrackingRun]):
    """Runs along a reference, with their indices beside what theory promises."""

    promised = "dV/dt stays below −zᵀΘ'z, each |τ_i| within its bound for (21), every motor within its limit"

    def about(self) -> str:
        """That there was a reference."""
        return ", tracking (21)"

    def opening(self) -> Sequence[Block]:
        """The reference."""
        return [
            Paragraph(f"Reference: {text}.")
            for text in dict.fromkeys(one.reference.sentence for one in self.results)
        ]

    def legend(self) -> Sequence[str]:
        """What is estimated."""
        return (ESTIMATED,)

    def overview(self) -> Table:
        """L2, ε₀ and V of each run."""
        rows = []
        for one in self.results:
            eps0 = lower(one.promise.eps0), lower(one.promise.largest), "yes" if one.promise.falls else "no"
            ends = f"{one.V[0]:.5g}", f"{one.V[-1]:.3g}"
            rows.append((one.name, cell(one.indices.L2, ".4f"), *eps0, *ends, self.mark(one.name)))
        return Table(OVERVIEW, tuple(rows), align="lrrrlrrl")

    def section(self, one: TrackingRun) -> Section:
        """A row a joint, and what is estimated beside what was seen."""
        table = Table(_heads(one), tuple(_rows(one)), align="lrrrrrrrl")
        return Section(f"{self.mark(one.name)} {_headline(one)}".strip(), (table, Bullets(_facts(one))))

    def plain_data(self, one: TrackingRun) -> dict[str, Any]:
        """Rates in rad/s; what is promised is rounded outward."""
        result, motion = one.indices, one.motion
        return {
            "name": one.name,
            "m": one.gains.family.m,
            "robot": one.robot,
            "kind": "tracking",
            "reference": one.reference.sentence,
            "complete": one.complete,
            "time": one.T,
            "reached": plain(motion.t[-1]),
            "start": plains(np.degrees(motion.q[0])),
            "joints": list(one.joints),
            "L2": plain(result.L2),
            "rms": plains(result.rms),
            "peak_error": plains(result.peak_error),
            "final_error": plains(result.final_error),
            "band": plain(math.degrees(one.band)),
            "entered": plains(result.entered),
            "peak_torque": plains(result.peak_torque),
            "torque_limit": list(one.torque_limit),
            "V_start": plain(one.V[0]),
            "V_end": plain(one.V[-1]),
            "accuracy": plain(one.accuracy),
            "work_balance": plain(one.work_balance),
            "seen": {
                "reference_speed": plain(one.seen_speed),
                "error_rate": plain(_error_rate(one)),
                "tightness": plain(one.tightness),
            },
            "promised": _promise(one),
            "breach": None if one.breach is None else one.breach.data,
        }

    def rows_of(self, one: TrackingRun) -> list[dict[str, Any]]:
        """A row a run and joint; names and units as in `data`."""
        data = self.plain_data(one)
        keys = ("name", "m", "robot", "kind", "reference", "complete", "time", "reached")
        promised = data["promised"]
        bounds = promised.pop("torque_bound")
        return [
            {
                **{key: data[key] for key in keys},
                "joint": joint,
                **{key: data[key][i] for key in PER_JOINT},
                "promised_torque": None if bounds is None else bounds[i],
                **{key: data[key] for key in PER_RUN},
                "promised": promised,
                "breach": breach_record(one.breach),
            }
            for i, joint in enumerate(one.joints)
        ]


def _headline(one: TrackingRun) -> str:
    member = "" if one.gains.family.m is None else f" (m = {one.gains.family.m})"
    start = row(np.round(np.degrees(one.motion.q[0]), 9))
    cut = "" if one.complete else f", CUT SHORT at {one.motion.t[-1]:.4g} s"
    return f"{one.name}{member}: from {start}° in {one.T:g} s{cut}"


def _facts(one: TrackingRun) -> tuple[str, ...]:
    speed = up(one.promise.suprema.speed)
    checks = f"accuracy {sized(one.accuracy)} (rad, rad/s) by a second, tighter run"
    if math.isnan(one.accuracy):
        checks = "accuracy unknown: the run was cut short"
    return (
        f"estimated: ‖q̇_d‖ ≤ v_d = {speed} rad/s, seen {at_most(one.seen_speed)}",
        *_promised(one),
        f"{checks}; work balance {sized(one.work_balance)}",
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
    lines.append(
        f"seen: dV/dt ≤ −zᵀΘ'z {'at all' if kept else 'NOT at all'} {one.motion.t.size} samples{share}"
    )
    if promise.torque is not None:
        most, seen = up(promise.torque.error_rate), _error_rate(one)
        lines.append(f"estimated: ‖q̇ − q̇_d‖ ≤ {most} rad/s, seen {at_most(seen)}")
    return lines


def _error_rate(one: TrackingRun) -> float:
    return float(np.max(np.linalg.norm(one.motion.w, axis=1)))


def _heads(one: TrackingRun) -> tuple[str, ...]:
    within = f"within {math.degrees(one.band):g}° from [s]"
    heads = ("joint", "rms [°]", "peak error [°]", within, "final error [°]", "peak torque [N·m]")
    return (*heads, "estimated [N·m]", "limit [N·m]", "inside limit")


def _rows(one: TrackingRun) -> list[tuple[str, ...]]:
    result, torque = one.indices, one.promise.torque
    return [
        (
            joint,
            cell(result.rms[i], "z.4f"),
            cell(result.peak_error[i], "z.3f"),
            cell(result.entered[i], "z.3f"),
            cell(result.final_error[i], "z.4f"),
            cell(result.peak_torque[i], "z.2f"),
            NONE if torque is None else up(torque.total[i]),
            lower(one.torque_limit[i]),
            _inside(one, i),
        )
        for i, joint in enumerate(one.joints)
    ]


def _inside(one: TrackingRun, i: int) -> str:
    """Whether the torque of a joint is estimated to stay inside its motor's limit, or was seen to."""
    limit, torque = one.torque_limit[i], one.promise.torque
    if limit is None:
        return ""
    if one.indices.peak_torque[i] > limit:
        return "NO"
    return "estimated" if torque is not None and torque.total[i] <= limit else "seen"


def _promise(one: TrackingRun) -> dict[str, Any]:
    promise, torque = one.promise, one.promise.torque
    return {
        "reference_speed": _double_above(promise.suprema.speed),
        "reference_acceleration": _double_above(promise.suprema.acceleration_norm),
        "eps0": promise.eps0,
        "largest_eps0": None if promise.largest is None else decimal_text(promise.largest),
        "V_falls": promise.falls,
        "reason": promise.reason,
        "torque_bound": None if torque is None else [_double_above(x) for x in torque.total],
        "error_rate": None if torque is None else _double_above(torque.error_rate),
    }


def _double_above(value: Fraction) -> float:
    """The smallest double that is not below."""
    return Enclosure(value, value).float_upper


def up(value: Fraction) -> str:
    """A bound in four digits, never rounded down."""
    return at_most(max(value, Fraction(0)))
