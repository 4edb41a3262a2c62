"""``python -m studies.gain_map``: prove and simulate every place of the map, and write it down."""

from __future__ import annotations

from pathlib import Path

from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.output.json import laid_out
from lyapcheck.report.experiment import arm_digest
from lyapcheck.report.gain_map import BOXES, gain_map
from lyapcheck.report.plain import plain
from lyapcheck.robots import load
from lyapcheck.simulate.printed import PAPER_ARM
from lyapcheck.simulate.task import PAPER_TASK

RESULTS = Path(__file__).with_name("results.json")


def main() -> None:
    """A few minutes."""
    model = load(PAPER_ARM)
    sets = {one.m: one for one in read_gain_file(paper_gain_file()).gains if one.m is not None}
    cells = gain_map(model, sets, PAPER_TASK.q_d)
    result = {"arm": arm_digest(model), "boxes": BOXES, "map": [plain(one) for one in cells]}
    RESULTS.write_text(laid_out(result) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
