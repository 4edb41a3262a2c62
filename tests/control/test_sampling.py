"""The record of a loop: what a file and options say, in which order they count, and what is refused."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck import robots
from lyapcheck.control.gains import read_gain_file
from lyapcheck.control.sampling import LoopRecord, loop_of_options, record_of, time_text
from lyapcheck.errors import InputError
from lyapcheck.files.loop import LoopEntry

GAINS = "robot = 'buap3'\n[[gains]]\nname = 'a'\nm = 1\nkp = [1, 1, 1]\nkv = [1, 1, 1]\n[loop]\n"
FULL = """\
period = "2.5 ms"
longest = "0.003 s"
delay = 2
velocity = "measured"
filter = [0.5, -0.25]
encoder = "17 bits"
unknown_payload = 2
gravity_error = 5
"""
RECORD = LoopRecord(
    Fraction(1, 400),
    Fraction(3, 1000),
    2,
    "measured",
    (Fraction(1, 2), Fraction(-1, 4)),
    None,
    2**17,
    Fraction(2),
    Fraction(1, 20),
)


def read(folder: Path, lines: str) -> LoopEntry:
    file = folder / "gains.toml"
    file.write_text(GAINS + lines)
    return read_gain_file(file).loop


def test_every_key_is_read_exactly(tmp_path: Path) -> None:
    assert record_of(gain_file=read(tmp_path, FULL)) == RECORD
    assert read(tmp_path, "rate = 400").period == Fraction(1, 400)
    assert read(tmp_path, 'period = "250 us"').period == Fraction(1, 4000)
    assert read(tmp_path, "encoder = 4096").encoder == 4096


def test_an_arm_file_says_it_in_the_same_words(tmp_path: Path) -> None:
    text = robots.arm_file("pelican2").read_text()
    (tmp_path / "arm.toml").write_text(f"{text}\n[loop]\n{FULL}")
    assert record_of(arm=robots.load(tmp_path / "arm.toml").loop) == RECORD


def test_options_say_it_in_the_same_words() -> None:
    said = {
        "period": "2.5 ms",
        "longest": "3 ms",
        "delay": "2",
        "velocity": "measured",
        "filter": "0.5,-0.25",
        "encoder": "17 bits",
        "unknown_payload": "2",
        "gravity_error": "5",
        "rate": None,
    }
    assert record_of(loop_of_options(said)) == RECORD


def test_an_option_goes_before_a_gain_file_and_that_before_an_arm_file() -> None:
    arm = LoopEntry(Fraction(1, 100), Fraction(1, 50), 3, lowpass=Fraction(20), encoder=10)
    file = LoopEntry(Fraction(1, 200), filter=(Fraction(1),))
    result = record_of(LoopEntry(delay=0), file, arm)
    assert result == LoopRecord(Fraction(1, 200), Fraction(1, 200), 0, encoder=10)
    assert record_of() is None
    payload = record_of(LoopEntry(unknown_payload=Fraction(1)))
    assert payload is not None
    assert payload.period is None
    assert not payload.knows_gravity


@pytest.mark.parametrize(("seconds", "text"), [("1/400", "2.5 ms"), ("1/600", "1/600 s"), ("1", "1000 ms")])
def test_a_period_is_printed_exactly(seconds: str, text: str) -> None:
    assert time_text(Fraction(seconds)) == text


BROKEN = [
    ("rate = 0", "must be positive"),
    ('rate = "400 Hz"', "must be a number, in Hz"),
    ("rate = 1e9", "must be a period from"),
    ("rate = nan", "must be a finite decimal"),
    ('rate = 4\nperiod = "2 ms"', "does not go together with rate"),
    ("period = 2.5", "must be a time with its unit"),
    ('period = "0 ms"', "must be a time with its unit"),
    ('period = "2.5 min"', "must be a time with its unit"),
    ('period = "2 ms"\nlongest = "1 ms"', "must not be shorter"),
    ("delay = 0.5", "must be a whole number"),
    ("delay = -1", "must be a whole number"),
    ('velocity = "observer"', "must be one of difference, measured"),
    ("filter = []", "must be 1 to 100 taps"),
    ("filter = [0, 0]", "must be 1 to 100 taps"),
    ("filter = [inf]", "must be 1 to 100 taps"),
    ("filter = 1", "must be 1 to 100 taps"),
    ("filter = [1]\nlowpass = 5", "does not go together with filter"),
    ("lowpass = -5", "must be positive"),
    ('encoder = "0 bits"', "must be bits or counts"),
    ('encoder = "41 bits"', "must be bits or counts"),
    ("encoder = true", "must be bits or counts"),
    ("unknown_payload = -1", "must not be negative"),
    ("gravity_error = 2000", "must be at most 1000 %"),
    ("hold = 1", "is not a known key"),
]


@pytest.mark.parametrize(("lines", "rule"), BROKEN)
def test_what_is_no_loop_is_told_once(tmp_path: Path, lines: str, rule: str) -> None:
    with pytest.raises(InputError, match=rule) as told:
        read(tmp_path, lines)
    assert [problem.line is not None for problem in told.value.problems] == [True]


def test_all_problems_of_a_file_at_once(tmp_path: Path) -> None:
    with pytest.raises(InputError) as told:
        read(tmp_path, "rate = -1\ndelay = 1.5\nencoder = 1\n")
    assert {problem.key for problem in told.value.problems} == {"loop.rate", "loop.delay", "loop.encoder"}


@pytest.mark.parametrize(
    ("options", "key"),
    [({"rate": "fast"}, "--rate"), ({"gravity_error": "5%"}, "--gravity-error"), ({"delay": "x"}, "--delay")],
)
def test_options_are_named_as_they_are_typed(options: dict[str, str], key: str) -> None:
    with pytest.raises(InputError) as told:
        loop_of_options(options)
    assert [problem.key for problem in told.value.problems] == [key]


def test_timing_without_a_period_is_refused_where_it_is_an_option() -> None:
    with pytest.raises(InputError, match="--delay: means nothing without a period"):
        record_of(LoopEntry(delay=2))
    with pytest.raises(InputError, match="must not be shorter"):
        record_of(LoopEntry(longest=Fraction(1, 1000)), LoopEntry(Fraction(1, 400)))


@pytest.mark.parametrize("wrong", [{"unknown_payload": -3}, {"period": float("nan")}, {"within": 0}])
def test_an_entry_takes_numbers_as_typed_and_refuses_what_no_file_may_say(wrong: dict[str, float]) -> None:
    assert LoopEntry(period=0.001, delay=0).period == Fraction(1, 1000)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="positive"):
        LoopEntry(**wrong)  # type: ignore[arg-type]
