"""Run all benchmarks and write reports/benchmarks.md."""

import os
import platform
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from . import batches, commands, throughput, tuning

OUT = Path(__file__).parents[2] / "reports" / "benchmarks.md"
PACKAGES = ("lyapcheck", "numpy", "scipy", "casadi", "python-flint", "cvxpy", "clarabel", "numba", "diffrax")
HEAD = """# Benchmarks

Written by `make bench`; all numbers are of one run on one machine:

{machine}

Where the load is above the number of processors, wall times say as much of other work as of the commands:
then ratios and processor times are what to read.
"""
COMMANDS = """## Commands

The whole process, start of the interpreter included, median of the runs. By hand means a script in
`tests/benchmarks/by_hand`, or a Python that does nothing else, timed in the same way; the ratio is by hand ÷
lyapcheck, so more than 1 means that lyapcheck is faster. No by-hand way comes with a proof.
"""
EPSILON = """## ε₀ of arms of many joints

The whole command `epsilon` and `recheck` of its certificate, processor time, for the gains in `examples/`.
"""
RATES = """## V and dV/dt

States per second, median of the runs after one that warms up (lyapcheck's loops are compiled once a
computer). States are random, gains are those of Table 2, m = 2. CasADi's C is compiled with `-Ofast
-march=native` together with an OpenMP loop over the states; numba runs `prange` with `fastmath` over loops of
scalars. The ratio is to lyapcheck.
"""
BATCHES = """## Many runs at once

Five seconds of the three-joint arm with tau_m2 of Table 2 from random positions, relative tolerance 1e-9 a
step. Wall time, median of three after one that warms up (compiling not counted). The difference is that of
final states, rad and rad/s, from lyapcheck's at 1e-13.
"""
TUNING = """## Gains for targets

The worst simulated value over its target: overshoot 10 % (buap3: 5 %), settled within 2 s (1.5 s), 0.9 of
each torque limit, in a motion of 45° of every joint by (11). Evolution is SciPy's, population 15, 400
evaluations, seed 0, over the same sets and from the same rule of thumb: 98 % of (10i), damping ratio 0.9.
Below 1.02 `tune` is as good. Processor times of the search alone.
"""


def description():
    """A line a fact: the interpreter, the processors, the versions."""
    return [
        f"{platform.python_implementation()} {platform.python_version()} on {platform.system()}, "
        f"{platform.machine()}, {os.cpu_count()} processors, load {os.getloadavg()[1]:.1f} when it ended",
        ", ".join(filter(None, map(_package, PACKAGES))),
    ]


def _package(name):
    try:
        return f"{name} {version(name)}"
    except PackageNotFoundError:
        return ""


def table(head, rows):
    """Cells as Markdown."""
    return [f"| {' | '.join(map(str, cells))} |" for cells in (head, ["---"] * len(head), *rows)]


def markdown(sections):
    """The whole document, of (text, head, rows)."""
    lines = [HEAD.format(machine="\n".join(f"- {line}" for line in description()))]
    for text, head, rows in sections:
        lines += [text, *table(head, rows), ""]
    return "\n".join(lines)


def shown(rows):
    """The rows, each told as soon as it is measured."""
    for row in rows:
        print(f"bench: {' | '.join(map(str, row))}", file=sys.stderr, flush=True)
        yield row


def main():
    """Measure, then write the document in one piece."""
    parts = (
        (COMMANDS, commands.HEAD, commands.rows()),
        (EPSILON, commands.ARMS_HEAD, commands.epsilon()),
        (RATES, throughput.HEAD, throughput.rows()),
        (BATCHES, batches.HEAD, batches.rows()),
        (TUNING, tuning.HEAD, tuning.rows()),
    )
    sections = [(text, head, list(shown(rows))) for text, head, rows in parts]
    OUT.write_text(markdown(sections), encoding="utf-8")


if __name__ == "__main__":
    main()
