"""A file of another kind than the command reads is named as what it is, in one line."""

from pathlib import Path

import pytest

from tests.helpers.command import invoke

EXAMPLES = Path(__file__).parents[2] / "examples"
FILES = {
    "an arm file": EXAMPLES / "ur5.toml",
    "a gain file": EXAMPLES / "ur5_gains.toml",
    "the plan of a sweep": EXAMPLES / "sweep_plan.toml",
}
READERS = {"robot": "an arm file", "gate": "a gain file", "sweep": "the plan of a sweep"}


@pytest.mark.parametrize("given", FILES)
@pytest.mark.parametrize("command", READERS)
def test_a_file_of_another_kind(command, given):
    wanted = READERS[command]
    if given != wanted:
        result = invoke(command, str(FILES[given]))
        assert result.exit_code == 2
        assert f"{FILES[given]}: file: is {given}, not {wanted}; give the" in str(result.exception)
