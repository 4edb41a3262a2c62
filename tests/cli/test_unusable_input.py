"""What cannot be used is in every format that a program reads: an error there, never an empty document."""

from __future__ import annotations

import csv
import io
import json
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest

from lyapcheck.cli.main import run
from lyapcheck.errors import InputError
from tests.helpers.json_schema import follows
from tests.helpers.urdf_texts import TWO

GOOD = 'robot = "two.urdf"\n[[gains]]\nname = "a"\nm = 1\nkp = [2, 1]\nkv = [0.1, 0.1]\n'
SHORT = GOOD.replace("[2, 1]", "[2]")


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name, text in (("two.urdf", TWO), ("good.toml", GOOD), ("short.toml", SHORT)):
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GITHUB_STEP_SUMMARY", raising=False)
    return tmp_path


COMMANDS = [
    ("gate good.toml short.toml", 1),
    ("gate short.toml", 0),
    ("gate nothing.toml", 0),
    ("gate good.toml --tip nowhere", 0),
    ("robot short.toml", 0),
    ("epsilon short.toml", 0),
    ("bounds short.toml", 0),
    ("simulate short.toml --time 1", 0),
    ("robot two.urdf --fixed elbow", 0),
    ("gate good.toml --nothing", 0),
]


def written(words: str, form: str, capsys: pytest.CaptureFixture[str]) -> tuple[str, InputError]:
    with pytest.raises(InputError) as caught:
        run([*words.split(), "--format", form])
    return capsys.readouterr().out, caught.value


@pytest.mark.usefixtures("place")
@pytest.mark.parametrize(("words", "judged"), COMMANDS)
def test_every_problem_is_in_every_format(
    words: str, judged: int, capsys: pytest.CaptureFixture[str]
) -> None:
    text, error = written(words, "json", capsys)
    told = json.loads(text)
    assert [one["rule"] for one in told["problems"]] == [one.rule for one in error.problems]
    assert len(told["results"]) == judged
    text, error = written(words, "junit", capsys)
    suites = ET.fromstring(text)
    assert [one.get("message") for one in suites.iter("error")] == list(map(str, error.problems))
    assert sum(int(suite.get("errors", "")) for suite in suites) == len(error.problems)
    assert sum(int(suite.get("tests", "")) for suite in suites) == len(error.problems) + judged
    text, error = written(words, "sarif", capsys)
    follows(json.loads(text), "sarif-2.1.0-rtm.5")
    (invocation,) = json.loads(text)["runs"][0]["invocations"]
    assert invocation["executionSuccessful"] is False
    notes: list[dict[str, Any]] = invocation["toolExecutionNotifications"]
    assert [note["message"]["text"] for note in notes] == list(map(str, error.problems))
    text, error = written(words, "github", capsys)
    assert text.count("::error ") == len(error.problems)
    text, _ = written(words, "csv", capsys)
    assert list(csv.DictReader(io.StringIO(text)))


@pytest.mark.usefixtures("place")
def test_a_clean_run_has_no_invocation(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["gate", "good.toml", "--format", "sarif"]) in (0, 3)
    assert "invocations" not in json.loads(capsys.readouterr().out)["runs"][0]


@pytest.mark.usefixtures("place")
def test_others_read_what_is_written(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The parsers of two programs that show such files."""
    import junitparser
    from sarif import loader

    (place / "j.xml").write_text(written(COMMANDS[0][0], "junit", capsys)[0], encoding="utf-8")
    (place / "s.sarif").write_text(written(COMMANDS[0][0], "sarif", capsys)[0], encoding="utf-8")
    suites = junitparser.JUnitXml.fromfile(str(place / "j.xml"))
    suites.update_statistics()
    assert (suites.tests, suites.errors) == (2, 1)
    assert loader.load_sarif_file(str(place / "s.sarif")).get_result_count() == 1


SAID = {
    "gate good.toml --delay 1.5": "--delay = 1.5: must be a whole number from 0 to 1000; write --delay 0",
    "gate good.toml --rate 9 --velocity slow": "--velocity = slow: must be one of difference, measured; "
    "write --velocity difference",
    "gate good.toml --rate 1e9": "--rate = 1e9: must be a period from 0.1 µs to 10 s; "
    "give the rate of the controller",
    "gate good.toml --rate 9 --filter a,b": "--filter = a,b: must be 1 to 100 taps of a filter, numbers that "
    "are not all 0; give one for each past difference, the newest first, such as 0.5, 0.5",
    "simulate good.toml --time 1e9": "--time = 1000000000: must be from 1e-06 to 3600 s; "
    "give seconds, for instance 5",
    "simulate good.toml --time 0": "--time = 0: must be from 1e-06 to 3600 s; give seconds, for instance 5",
    "tune two.urdf --best": "--best: has a meaning with targets only; "
    "add --overshoot, --settle or --rest-error",
    "tune two.urdf --torque 5": "--torque = 5: has 1 value for 2 joints; give 2, separated by commas",
    "gate good.toml --sets none": "--sets: is not an option here; see lyapcheck gate --help",
    "gate good.toml --rat 5": "--rat: is not an option here; did you mean --rate?",
}
"""Command lines with a slip, and what is said: the option and the value as typed, and a repair to type."""


@pytest.mark.usefixtures("place")
@pytest.mark.parametrize(("words", "said"), SAID.items())
def test_an_option_is_named_as_it_was_typed(words: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        run(words.split())
    (problem,) = caught.value.problems
    assert problem.said == said


@pytest.mark.parametrize(
    ("written", "shown"),
    [
        ("kp = [true, 1]", "kp[1] = true: "),
        ("kp = [1, 2024-01-31]", "kp[2] = 2024-01-31: "),
        ('kp = [[2.5, true, "x"], [0, 1]]', 'kp = [[2.5, true, "x"], [0, 1]]: '),
        ("kp = { elbow = 1 }", "kp = { elbow = 1 }: "),
        ('condition = ["10q"]', 'condition = ["10q"]: '),
    ],
)
def test_a_value_is_shown_as_the_file_has_it(place: Path, written: str, shown: str) -> None:
    kept = [line for line in GOOD.splitlines() if line.split()[0] != written.split(maxsplit=1)[0]]
    (place / "good.toml").write_text("\n".join([*kept, written, ""]), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        run(["gate", "good.toml"])
    assert any(problem.said.startswith(f"gains[1].{shown}") for problem in caught.value.problems)


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-32-le"])
def test_text_of_two_bytes_a_letter_is_not_taken_for_toml(place: Path, encoding: str) -> None:
    (place / "good.toml").write_bytes(GOOD.encode(encoding))
    with pytest.raises(InputError, match="file: is not UTF-8 text; save it as UTF-8"):
        run(["gate", "good.toml"])
