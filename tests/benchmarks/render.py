"""Measurements as Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from .results import (
    CertificateResult,
    CommandResult,
    ConstantsResult,
    Cost,
    ManyResult,
    RateResult,
    RunsResult,
)

HEAD = """# Benchmarks

Written by `make bench`; all numbers are of one run on one machine:

{machine}

Where the load is above the number of processors, wall times say as much of other work as of the commands:
then ratios, and processor times where a row has them, are what to read.

## Commands

Wall time of the whole process, start of the interpreter included, median of the runs. By hand means a script
in `tests/benchmarks/by_hand`, timed in the same way; the ratio is by hand ÷ lyapcheck, so more than 1 means
that lyapcheck is faster. Where a row says so it is processor time of the whole process. No by-hand way comes
with a proof.
"""

RATES = """
## V and dV/dt

States per second, median of the runs after one that warms up (lyapcheck's loops are compiled once a
computer). States are random, gains are those of Table 2, m = 2; CasADi's states are CasADi matrices before
the clock starts. CasADi's C is compiled with `-Ofast -march=native` together with an OpenMP loop over the
states; numba runs `prange` with `fastmath` over loops of scalars. The ratio is to lyapcheck.
"""

CERTIFICATES = """
## Certificates of ε₀

What it takes to prove dV/dt < 0 at every state for a share of the falsified ε₀: boxes that the search looked
at / its seconds / seconds of the trusted checker for the same boxes, in balls, on both processors. Each share
starts from nothing. Gains are those of Table 2 (of the joints the arm has; for m = 4 and 5 those of m = 3).
A dash: not proved with so many boxes. A user's own way, a million random states, proves nothing; see
`epsilon` above.
"""

MANY_JOINTS = """
With more joints boxes of (q, e) are too many: from n = 1 to 2 to 3 their number grows tenfold or more each
time. There M and its rates are bounded along the links, and boxes are those of |e| alone. The gains are those
beside the arms in `examples/`. Processor time of the whole command `epsilon`, falsifier, search and checker,
and of `recheck` of its certificate, the start of Python included.
"""

CONSTANTS = """
## Constants of an arm

How far apart the certified ends of a constant are, relative to the upper one: one end is shown by a posture,
the other by forms along the links. Processor time of the whole command `robot`, which decides Properties 2.1
to 2.8, too, and of `recheck` of all that it wrote. A user's own way, the largest value at many postures,
gives one end only, and no proof of the other.
"""

BATCHES = """
## Many runs at once

Five seconds of the three-joint arm with tau_m2 of Table 2 from random positions, relative tolerance 1e-9 a
step. Wall time, median of three after one that warms up (compiling not counted). lyapcheck also samples each
run 501 times and takes its indices; by hand only the final state comes out. The difference is that of final
states, rad and rad/s, from lyapcheck's at 1e-13.
"""


def markdown(
    machine: Sequence[str],
    commands: Sequence[CommandResult],
    rates: Sequence[RateResult],
    certificates: Sequence[CertificateResult],
    many: Sequence[ManyResult],
    constants: Sequence[ConstantsResult] = (),
    batches: Sequence[RunsResult] = (),
) -> str:
    """The whole document."""
    parts = [HEAD.format(machine="\n".join(f"- {line}" for line in machine))]
    parts += _commands(commands)
    parts += [CERTIFICATES, *_certificates(certificates), MANY_JOINTS, *_many_joints(many)]
    parts += [CONSTANTS, *_constants(constants)]
    parts += [RATES, *_rates(rates), BATCHES, *_batches(batches)]
    return "\n".join(parts) + "\n"


def _commands(results: Sequence[CommandResult]) -> list[str]:
    rows = [
        [
            f"`{result.command}`" if "," not in result.command else result.command,
            _seconds(result.seconds),
            str(result.runs),
            "—" if result.by_hand_seconds is None else _seconds(result.by_hand_seconds),
            "—" if result.by_hand_seconds is None else f"{result.by_hand_seconds / result.seconds:.2f}",
            result.by_hand or "nothing compares",
            result.agreement or "—",
        ]
        for result in results
    ]
    return _table(
        ["command", "wall time", "runs", "by hand", "ratio", "what is done by hand", "agreement"], rows
    )


def _seconds(seconds: float) -> str:
    return f"{seconds:.2f} s" if seconds >= 0.1 else f"{1000 * seconds:.0f} ms"


def _rates(results: Sequence[RateResult]) -> list[str]:
    rows = []
    for result in results:
        best = next(iter(result.rates.values()))
        for way, rate in result.rates.items():
            subject = [result.function, f"{result.arm} (n = {result.joints})"]
            rows.append([*subject, way, f"{rate:.2e}", f"{rate / best:.4f}", f"{result.difference:.0e}"])
    return _table(["function", "arm", "way", "states/s", "ratio", "largest difference"], rows)


def _certificates(results: Sequence[CertificateResult]) -> list[str]:
    shares = [f"{cost.share:.1%}" for cost in results[0].costs] if results else []
    rows = [
        [f"{result.arm} (n = {result.joints})", str(result.m), f"{result.falsified:.6g}"]
        + [_cost(cost) for cost in result.costs]
        for result in results
    ]
    return _table(["arm", "m", "falsified ε₀", *shares], rows)


def _many_joints(results: Sequence[ManyResult]) -> list[str]:
    rows = [
        [
            f"{result.arm} (n = {result.joints})",
            str(result.m),
            f"{result.certified:.6g}",
            f"{result.falsified:.6g}",
            f"{result.certified / result.falsified:.1%}",
            _seconds(result.seconds),
            f"{result.bytes / 1000:.0f} kB",
            _seconds(result.checked),
        ]
        for result in results
    ]
    head = ["arm", "m", "certified ε₀", "falsified", "share", "`epsilon`", "certificate", "`recheck`"]
    return _table(head, rows)


def _constants(results: Sequence[ConstantsResult]) -> list[str]:
    rows = [
        [
            f"{result.arm} (n = {result.joints})",
            *(f"{gap:.2%}" for gap in result.gaps),
            _seconds(result.seconds),
            f"{result.bytes / 1000:.0f} kB",
            _seconds(result.checked),
        ]
        for result in results
    ]
    return _table(
        ["arm", "λmin(M)", "λmax(M)", "k_c", "k_g", "`robot`", "certificate of k_c", "`recheck`"], rows
    )


def _batches(results: Sequence[RunsResult]) -> list[str]:
    rows = [
        [
            result.way,
            str(result.runs),
            f"{result.rate:.0f}",
            f"{result.rate / results[0].rate:.3f}",
            f"{result.difference:.0e}",
        ]
        for result in results
    ]
    return _table(["way", "runs", "runs/s", "ratio", "difference"], rows)


def _cost(cost: Cost) -> str:
    if cost.checked is None:
        return f"— ({cost.boxes})"
    return f"{cost.boxes} / {cost.searched:.2f} s / {cost.checked:.2f} s"


def _table(head: list[str], rows: list[list[str]]) -> list[str]:
    lines = [head, ["---"] * len(head), *rows]
    return [f"| {' | '.join(cells)} |" for cells in lines]
