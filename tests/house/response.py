"""The picture of the README, from its own commands: ``python -m tests.house.response`` draws it again."""

import csv
import math
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from matplotlib.figure import Figure

PICTURE = Path(__file__).parents[2] / "docs" / "response.png"
TARGETS = ("--overshoot", "5", "--settle", "1.5", "--rest-error", "3")
BEFORE, AFTER = "#c2571a", "#00796b"


def run(folder, *words):
    """A command that must succeed."""
    subprocess.run([sys.executable, "-m", "lyapcheck", *words], cwd=folder, check=True, capture_output=True)


def motion(folder, *targets):
    """Time, shoulder angle in degrees and size of its torque in N·m, with the gains that ``tune`` finds."""
    run(folder, "tune", "arm.toml", "--m", "1", *targets, "--out", "tuned.toml")
    run(folder, "simulate", "tuned.toml", "--target", "45,45", "--csv", "run.csv")
    rows = list(csv.DictReader((folder / "run.csv").read_text(encoding="utf-8").splitlines()))
    columns = [[float(row[name]) for row in rows] for name in ("t [s]", "q1 [rad]", "tau1 [N.m]")]
    return columns[0], [math.degrees(angle) for angle in columns[1]], [abs(torque) for torque in columns[2]]


def main():
    """Run the commands and draw both motions."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        run(folder, "init")
        before, after = motion(folder), motion(folder, *TARGETS)
    figure = Figure(figsize=(6.8, 2.9), layout="constrained", dpi=200)  # letters that a phone shows
    angle, torque = figure.subplots(1, 2)
    for panel, column, unit in ((angle, 1, "shoulder angle [°]"), (torque, 2, "shoulder torque, size [N·m]")):
        panel.plot(before[0], before[column], color=BEFORE, label="tuning rule of the paper")
        panel.plot(after[0], after[column], color=AFTER, linewidth=2.2, label="tuned by lyapcheck")
        panel.set(xlabel="time [s]", ylabel=unit, xlim=(0, 4))
        panel.spines[["top", "right"]].set_visible(False)
    angle.axhline(45, color="gray", linestyle=":", linewidth=1)
    angle.text(3.98, 46.5, "goal", color="gray", ha="right", va="bottom")
    angle.legend(frameon=False, loc="lower right")
    torque.axhline(80, color="black", linestyle="--", linewidth=1)
    torque.text(3.98, 77, "motor limit 80 N·m,\nnever exceeded (proved)", ha="right", va="top")
    torque.set_ylim(0, 86)
    figure.savefig(PICTURE)


if __name__ == "__main__":
    main()
