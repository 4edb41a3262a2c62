"""What supports a report: ε₀, constants, gate, runs, and what all of it rests on."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from lyapcheck.answers.tune.answer import Effect, effect_section
from lyapcheck.kernel.coq import GRADE
from lyapcheck.output.document import Block, Bullets, Code, Document, Figure, Paragraph, Section, Table
from lyapcheck.report.model import KINDS, EpsilonRow, Report, RunRow
from lyapcheck.report.plots_of_runs import file_stem
from lyapcheck.report.text import fixed, joined

DIGITS = 12
"""Of constants: more than anybody compares by eye; report.json has all."""


def figure(report: Report, name: str, caption: str) -> Iterator[Figure]:
    """A drawing by its name, where the report has it."""
    if f"{name}.svg" in report.figures:
        yield Figure(f"figures/{name}.svg", caption)


def four_epsilons(report: Report) -> Iterator[Block]:
    """The four ε₀ of each gain set, why one is missing, and their drawing."""
    rows = tuple(
        (row.name, *(row.eps0(kind) or "–" for kind in KINDS), row.ratio or "–", _weighted(row))
        for row in report.epsilon
    )
    heads = ("gains", "published (18)", "scalar", "certified", "falsified", "certified/falsified", "ε₀Λ")
    yield Table(
        heads,
        rows,
        "Published: the end of (18). Scalar: from two norms. The next has a certificate for this arm; of the "
        "last a state with dV/dt > 0 is known. ε₀Λ: with weights, y = w − εΛh, the largest product with a "
        "certificate. Rounded to the safe side, at nominal numbers.",
    )
    missing = [(row.name, kind, text) for row in report.epsilon for kind, text in row.reasons.items()]
    if missing:
        what = {"weighted": "larger ε₀Λ"}
        said = (f"{name}, no {what.get(kind, f'{kind} ε₀')}: {text}" for name, kind, text in missing)
        yield Bullets(tuple(said))
    yield from figure(report, "epsilon", "The four ε₀ of each gain set")


def _weighted(row: EpsilonRow) -> str:
    """ε₀Λ of a gain set in a cell; a dash where no weights were sought."""
    if not row.weighted:
        return "–"
    return f"diag({', '.join(row.weighted)})" if "weighted" in row.certificates else "Λ = I"


def evidence(report: Report) -> Iterator[Section]:
    """Constants, gate and runs."""
    constants = _told(replace(report.table, digits=DIGITS).document())
    drawn = figure(report, "family", "The bounded functions and their derivatives")
    yield Section("The family and its constants", (*constants, *drawn))
    yield Section("The gate", tuple(_told(report.gate.document())))
    yield Section("The closed loop", tuple(_runs(report)))
    # what m does in these runs, where each member has one gain set
    members = {row.m: row for row in report.runs if row.m is not None and row.complete}
    if len(members) > 1 and len(members) == sum(row.m is not None and row.complete for row in report.runs):
        first = members[min(members)]
        effects = [_effect(m, row) for m, row in sorted(members.items())]
        section = effect_section(effects, first.target, first.time)
        yield replace(section, blocks=(*section.blocks, Paragraph(OWN_GAINS)))


def _told(document: Document) -> Iterator[Block]:
    """An answer in its own words."""
    yield from (*document.blocks, *document.details)
    if document.notes:
        yield Bullets(document.notes)


def _runs(report: Report) -> Iterator[Block]:
    rows = tuple(
        (
            row.name,
            fixed(row.L2, 3),
            fixed(row.printed["L2"], 3) if row.printed else "–",
            joined(row.settling),
            joined(row.overshoot, 1),
            joined(row.peak_torque, 1),
            "never rose" if row.V_decreases else "rose",
        )
        for row in report.runs
    )
    heads = ("gains", "L2 [°]", "measured L2 [°]", "settling [s]", "overshoot [%]", "peak torque [N·m]", "V")
    yield Table(heads, rows, "Reference simulation of (11), in floating point")
    yield from figure(report, "indices", "The L2 index (20), simulated and measured")
    for row in report.runs:
        yield from figure(report, f"{file_stem(row.name)}_errors", f"{row.name}: position errors")


OWN_GAINS = (
    "Each m has the gains of its own gain set. Floating point, one motion; lyapcheck tune --m compares "
    "members at the largest gains of each."
)


def _effect(m: int, row: RunRow) -> Effect:
    known = [peak / most for peak, most in zip(row.peak_torque, row.torque_limit, strict=True) if most]
    return Effect(
        m,
        math.nan if row.L2 is None else row.L2,
        max(abs(error) for error in row.final_error if error is not None),
        max(known, default=math.nan),
        row.top_speed,
        math.inf if row.rest is None else row.rest,
    )


def rests(report: Report) -> Iterator[Section]:
    """What is assumed, certificates, versions and seed."""
    versions = ", ".join(f"{name} {version}" for name, version in report.versions.items())
    assumed = tuple(report.robot.assumptions)
    blocks: list[Block] = [Bullets(assumed)] if assumed else [Paragraph("Nothing is assumed about the arm.")]
    if report.certificates:
        words = f"{len(report.certificates)} certificates; the small checker judges them again with"
        blocks += [Paragraph(words), Code("lyapcheck recheck certificates/*/"), *_kernel(report)]
    boxes = {row.boxes for row in report.epsilon}
    budget = f" Budget for ε₀: {max(boxes)} boxes a gain set." if boxes else ""
    blocks.append(Paragraph(f"Computed with {versions}. Seed {report.seed}.{budget}"))
    yield Section(f"What this rests on: {report.robot.title}", tuple(blocks))


def known(report: Report) -> Iterator[Section]:
    """What was known before the paper, and what is new."""
    if not report.own:
        yield Section("What was known, and what is new", (Bullets(report.notes.known[1:]),))


def _kernel(report: Report) -> Iterator[Block]:
    """What the grade ``kernel`` means, and which verdicts have it."""
    rows = [row for row in report.every_claim if row.decided]
    kernel = [row for row in rows if row.grade == GRADE]
    if kernel:
        yield Paragraph(
            "Grade kernel: a theorem of Coq's kernel too, printed from the claim's own data, "
            "on golden axioms; what its words mean stands on one page, formal/Definitions.v. So it is for "
            f"{len(kernel)} of {len(rows)} verdicts. With Coq installed, it judges them anew by"
        )
        yield Code("lyapcheck recheck --kernel certificates/*/")
