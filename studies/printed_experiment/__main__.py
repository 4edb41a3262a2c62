"""``python -m studies.printed_experiment``: run the study of the paper's gains and write its results."""

from __future__ import annotations

import sys
from pathlib import Path

from lyapcheck._types import SEED
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.output.json import laid_out
from lyapcheck.report.experiment import arm_digest
from lyapcheck.robots import load
from lyapcheck.simulate.printed import PAPER_ARM
from studies.printed_experiment.json import study_json
from studies.printed_experiment.study import study

RESULTS = Path(__file__).with_name("results.json")
GAIN_FILES = ("table2", "table2_pd")


def main() -> None:
    """A minute or two on two cores."""
    model = load(PAPER_ARM)
    sets = [one for name in GAIN_FILES for one in read_gain_file(paper_gain_file(name)).gains]
    result = study(sets, model, seed=SEED, on_progress=_tell)
    assert result is not None, "the paper prints the experiment of its own gains"
    RESULTS.write_text(laid_out({"arm": arm_digest(model)} | study_json(result)) + "\n", encoding="utf-8")


def _tell(fraction: float, note: str) -> None:
    print(f"study: {fraction:4.0%} {note}", file=sys.stderr)


if __name__ == "__main__":
    main()
