"""A short run of the fuzzing, and that it finds what it looks for."""

from __future__ import annotations

from pathlib import Path

import pytest

from lyapcheck import robots
from lyapcheck.errors import InputError

from .mutations import SEEDS
from .run import limited, run


def test_no_garbled_file_ends_in_another_error(tmp_path: Path) -> None:
    outcome = run(400, tmp_path)
    assert not outcome.failures, "\n".join(outcome.failures)
    assert outcome.accepted > 12
    assert outcome.refused > 120


@pytest.mark.slow
def test_many_garbled_files(tmp_path: Path) -> None:
    outcome = run(25_000, tmp_path, seed=5)
    assert not outcome.failures, "\n".join(outcome.failures)


@pytest.mark.parametrize("name", sorted(SEEDS))
def test_the_seeds_themselves_are_arms(tmp_path: Path, name: str) -> None:
    for seed, content in SEEDS.items():
        (tmp_path / seed).write_bytes(content)
    assert robots.load(tmp_path / name).n in (1, 2)


def test_a_reader_with_a_slip_is_found(tmp_path: Path) -> None:
    def slips(file: Path) -> None:
        if b"axis" not in file.read_bytes():
            raise KeyError("axis")
        raise InputError([])

    outcome = run(300, tmp_path, read=slips)
    assert outcome.failures
    assert outcome.refused
    assert "KeyError" in outcome.failures[0]
    assert len(list(tmp_path.glob("failure*"))) == len(outcome.failures)


def test_a_reader_that_hangs_is_found(tmp_path: Path) -> None:
    def hangs(file: Path) -> None:
        while True:
            pass

    outcome = run(1, tmp_path, read=hangs, seconds=0.05)
    assert "TimeoutError" in outcome.failures[0]


def test_a_reader_that_hoards_is_found() -> None:
    with pytest.raises(MemoryError), limited(5):
        bytearray(4_000_000_000)


def test_the_same_seed_gives_the_same_files(tmp_path: Path) -> None:
    def seen() -> list[bytes]:
        contents: list[bytes] = []
        run(20, tmp_path, read=lambda file: contents.append(file.read_bytes()))
        return contents

    assert seen() == seen()
