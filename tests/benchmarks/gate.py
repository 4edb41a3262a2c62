"""gate beside a NumPy script, beside the start of Python and of python-flint, and on 10,000 gain sets."""

from __future__ import annotations

import json
import random
import statistics
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from .measure import LYAPCHECK, PROOFS, Disagreement, by_hand, in_turn, lyapcheck
from .results import CommandResult

TABLE2 = str(PROOFS / "table2.toml")
SETS = 10_000
SEED = 20190301


def benchmarks() -> Iterator[CommandResult]:
    """All of them."""
    yield benchmark()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "gains.toml"
        path.write_text(gain_sets(1), encoding="utf-8")
        yield start(str(path), "pass", "`python -c pass`: the start of Python alone")
        yield start(str(path), "import flint", "`python -c 'import flint'`: the checker's arithmetic alone")
    yield many()


def benchmark(runs: int = 5) -> CommandResult:
    """Table 2 through the gate; both ways must give the same verdicts."""
    ours = lyapcheck("gate", TABLE2, runs=runs)
    theirs = by_hand("gate_numpy.py", TABLE2, runs=runs)
    exact = lyapcheck("gate", TABLE2, "--format", "json", runs=1)
    count = compare(exact.output, theirs.output)
    return CommandResult(
        command="lyapcheck gate proofs/table2.toml",
        seconds=ours.seconds,
        runs=ours.runs,
        by_hand="NumPy: γ from a grid, so from below",
        by_hand_seconds=theirs.seconds,
        agreement=f"the same {count} verdicts; by hand no margins and no largest values",
    )


def start(path: str, floor: str, about: str, runs: int = 25) -> CommandResult:
    """A file of one gain set beside a Python that only runs ``floor``, in turn on the same machine."""
    pairs = in_turn([LYAPCHECK, "gate", path], [sys.executable, "-c", floor], runs)
    ours, bare = (statistics.median(times) for times in zip(*pairs, strict=True))
    ratio = statistics.median(one / other for one, other in pairs)
    return CommandResult(
        command="lyapcheck gate, one gain set",
        seconds=ours,
        runs=runs,
        by_hand=about,
        by_hand_seconds=bare,
        agreement=f"{ratio:.1f} times as long, processor time, median of pairs run in turn",
    )


def many(sets: int = SETS, runs: int = 5) -> CommandResult:
    """A file of many gain sets, each different; both ways must give the same verdicts."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "gains.toml"
        path.write_text(gain_sets(sets), encoding="utf-8")
        ours = lyapcheck("gate", str(path), "--format", "json", runs=runs)
        theirs = by_hand("gate_numpy.py", str(path), runs=runs)
    count = compare(ours.output, theirs.output)
    return CommandResult(
        command=f"lyapcheck gate --format json, {sets} gain sets in one file",
        seconds=ours.seconds,
        runs=ours.runs,
        by_hand="NumPy: γ from a grid, once for each m",
        by_hand_seconds=theirs.seconds,
        agreement=f"the same {count} verdicts; by hand no line, no margin and no largest value",
    )


def gain_sets(count: int) -> str:
    """A gain file of so many random sets for m = 1 … 12, with three or four decimals; few of many pass."""
    draw = random.Random(SEED)
    blocks = ['robot = "buap3"']
    for i in range(count):
        kp = ", ".join(_decimal(draw, *ends) for ends in ((18, 30), (45, 64), (4, 8)))
        kv = ", ".join(_decimal(draw, 0.15, 0.22) for _ in range(3))
        blocks.append(f'[[gains]]\nname = "set_{i}"\nm = {draw.randint(1, 12)}\nkp = [{kp}]\nkv = [{kv}]')
    return "\n\n".join(blocks) + "\n"


def _decimal(draw: random.Random, low: float, high: float) -> str:
    return f"{draw.uniform(low, high):.{draw.choice((3, 4))}f}"


def compare(ours: str, theirs: str) -> int:
    """How many verdicts were compared.

    Raises:
        Disagreement: a verdict differs.
    """
    verdicts = {row["name"]: row["verdict"] for row in json.loads(ours)["results"]}
    by_name = dict(line.split() for line in theirs.splitlines())
    if verdicts != by_name:
        differ = [name for name in {*verdicts, *by_name} if verdicts.get(name) != by_name.get(name)]
        raise Disagreement(f"lyapcheck and NumPy disagree about {', '.join(sorted(differ)[:5])}")
    return len(verdicts)
