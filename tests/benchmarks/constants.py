"""What the certified constants of an arm cost, and how near they are to the largest values found."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from .certificates import EXAMPLES
from .measure import LYAPCHECK, processor_seconds
from .results import ConstantsResult

ARMS = ("px100", "px150", "ur5", "xarm6", "iiwa14", "panda")
NAMES = ("lambda_min", "lambda_max", "k_c", "k_g")


def benchmark(arms: Sequence[str] = ARMS) -> Iterator[ConstantsResult]:
    """The whole command ``robot`` on arms of ``examples/`` or built in, and ``recheck`` of what it wrote."""
    for arm in arms:
        example = EXAMPLES / f"{arm}.toml"
        with tempfile.TemporaryDirectory() as folder:
            line = [LYAPCHECK, "robot", str(example) if example.is_file() else arm]
            line += ["--no-store", "--format", "json"]
            output, seconds = processor_seconds([*line, "--certificates", folder])
            answer = json.loads(output)
            ends = {row["name"]: row["certified"] for row in answer["constants"]}
            gaps = tuple(1 - float(ends[name]["lower"]) / float(ends[name]["upper"]) for name in NAMES)
            _, checked = processor_seconds([LYAPCHECK, "recheck", folder])
            size = (Path(folder) / "k_c.upper.json").stat().st_size
        yield ConstantsResult(arm, answer["n"], gaps, seconds, size, checked)
