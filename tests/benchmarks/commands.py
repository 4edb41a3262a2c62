"""Whole commands: the gate beside NumPy and the start of Python, and those that nothing compares with."""

import json
import random
import sys
import tempfile
from pathlib import Path

from .measure import ROOT, Disagreement, by_hand, lyapcheck, timed

HEAD = ["command", "wall time", "processor time", "runs", "by hand", "ratio", "what is done by hand"]
ARMS_HEAD = ["arm", "m", "certified ε₀", "falsified", "share", "`epsilon`", "certificate", "`recheck`"]
SETS, SEED = 10_000, 20190301
ARMS = (("ur5", 1), ("panda", 1))


def rows():
    """The gate, then the commands of the main way."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        one, many = folder / "one.toml", folder / "many.toml"
        one.write_text(gain_sets(1), encoding="utf-8")
        many.write_text(gain_sets(SETS), encoding="utf-8")
        yield gate(ROOT / "proofs" / "table2.toml")
        yield gate(many)
        ours = lyapcheck("gate", str(one), runs=25)
        for bare in ("pass", "import flint"):
            yield row(
                "gate, one gain set", ours, timed([sys.executable, "-c", bare], 25), f"python -c '{bare}'"
            )
        yield row("check published.py --m 1", lyapcheck("check", "published.py", "--m", "1"))
        report = folder / "report"
        line = ("report", "--out", str(report), "--no-store")
        yield row("report, m = 1, 2, 3 and PD, cold", lyapcheck(*line, runs=1))
        yield row("recheck of its certificates", lyapcheck("recheck", str(report / "certificates")))


def row(command, ours, theirs=None, about="nothing compares"):
    """One command, beside what is done by hand."""
    times = [f"{ours.seconds:.2f} s", f"{ours.processor:.2f} s", ours.runs]
    if theirs is None:
        return [command, *times, "—", "—", about]
    return [command, *times, f"{theirs.seconds:.2f} s", f"{theirs.seconds / ours.seconds:.2f}", about]


def gate(path):
    """A gain file through the gate; both ways must give the same verdicts."""
    ours = lyapcheck("gate", str(path), "--format", "json")
    theirs = by_hand("gate_numpy.py", str(path))
    count = compare(ours.output, theirs.output)
    return row(f"gate, {count} gain sets", ours, theirs, "NumPy: γ from a grid; the same verdicts")


def compare(ours, theirs):
    """How many verdicts were compared; raises ``Disagreement`` where one differs."""
    verdicts = {row["name"]: row["verdict"] for row in json.loads(ours)["results"]}
    by_name = dict(line.split() for line in theirs.splitlines())
    if verdicts != by_name:
        differ = [name for name in {*verdicts, *by_name} if verdicts.get(name) != by_name.get(name)]
        raise Disagreement(f"lyapcheck and NumPy disagree about {', '.join(sorted(differ)[:5])}")
    return len(verdicts)


def gain_sets(count):
    """A gain file of so many random sets for m = 1 … 12, with three or four decimals; few of many pass."""
    draw = random.Random(SEED)

    def decimal(low, high):
        return f"{draw.uniform(low, high):.{draw.choice((3, 4))}f}"

    blocks = ['robot = "buap3"']
    for i in range(count):
        kp = ", ".join(decimal(*ends) for ends in ((18, 30), (45, 64), (4, 8)))
        kv = ", ".join(decimal(0.15, 0.22) for _ in range(3))
        blocks.append(f'[[gains]]\nname = "set_{i}"\nm = {draw.randint(1, 12)}\nkp = [{kp}]\nkv = [{kv}]')
    return "\n\n".join(blocks) + "\n"


def epsilon(arms=ARMS):
    """The whole command ``epsilon`` on arms of many joints, and ``recheck`` of its certificate."""
    for arm, m in arms:
        with tempfile.TemporaryDirectory() as folder:
            gains = str(ROOT / "examples" / f"{arm}_gains.toml")
            line = ("epsilon", gains, "--m", str(m), "--no-store", "--format", "json")
            ours = lyapcheck(*line, "--certificates", folder, runs=1)
            (result,) = json.loads(ours.output)["results"]
            (proof,) = Path(folder).glob("*.certified.json")
            checked, size = lyapcheck("recheck", str(proof), runs=1), proof.stat().st_size
            low, high = float(result["certified"]), float(result["falsified"])
        cost = [f"{ours.processor:.1f} s", f"{size / 1000:.0f} kB", f"{checked.processor:.2f} s"]
        yield [arm, m, f"{low:.6g}", f"{high:.6g}", f"{low / high:.1%}", *cost]
