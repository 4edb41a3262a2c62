"""Reference trajectories: derivatives, bounds for all times, and files that cannot be used."""

from __future__ import annotations

import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from lyapcheck.errors import InputError
from lyapcheck.simulate.reference import MinimumJerk, Reference, Sine, read_reference

RAD = math.pi / 180


def row(*values: object) -> tuple[Fraction, ...]:
    return tuple(Fraction(str(value)) for value in values)


def sine(
    phase: tuple[Fraction, ...] = row(0, 90), frequency: tuple[Fraction, ...] = row("0.5", "0.5")
) -> Sine:
    return Sine(row(20, 30), frequency, phase, row(0, 45))


ALL = {
    "sine": sine(),
    "unequal sines": sine(frequency=row("0.5", "0.3")),
    "minimum jerk": MinimumJerk(row(0, 10, -5), row(45, -45, 90), Fraction(2)),
}


@pytest.mark.parametrize("reference", ALL.values(), ids=ALL)
def test_rates_and_accelerations_are_the_derivatives(reference: Reference):
    """By central differences inside smooth pieces: 1e-7 is far above their error."""
    t = np.linspace(0.1, 4.9, 97) + 1e-3
    h = 1e-5
    before, now, after = (reference.at(t + shift) for shift in (-h, 0.0, h))
    np.testing.assert_allclose((after - before)[:, 0] / (2 * h), now[:, 1], atol=1e-7)
    slope = (after - before)[:, 1] / (2 * h)
    assert np.median(np.abs(slope - now[:, 2])) < 1e-7


@pytest.mark.parametrize("reference", ALL.values(), ids=ALL)
def test_the_bounds_hold_at_all_times_and_are_not_idle(reference: Reference):
    at = reference.at(np.linspace(0.0, 5.0, 20_001))
    bounds = reference.suprema()
    for order, each, norm in (
        (1, bounds.rate, bounds.speed),
        (2, bounds.acceleration, bounds.acceleration_norm),
    ):
        size = np.abs(at[:, order]).max(axis=0)
        assert np.all(size <= np.array(each, float))
        assert np.all(size >= 0.97 * np.array(each, float))
        largest = np.linalg.norm(at[:, order], axis=1).max()
        assert 0.9 * float(norm) <= largest <= float(norm)


def test_the_speed_of_sines_of_one_frequency_is_exact():
    """A circle, phases a quarter apart: ‖q̇_d‖ = Aω at all times; in phase it is √2 as much at its most."""
    circle = Sine(row(10, 10), row(1, 1), row(0, 90), row(0, 0)).suprema().speed
    line = Sine(row(10, 10), row(1, 1), row(0, 0), row(0, 0)).suprema().speed
    assert float(circle) == pytest.approx(10 * RAD * 2 * math.pi, rel=1e-11)
    assert float(line) == pytest.approx(math.sqrt(2) * 10 * RAD * 2 * math.pi, rel=1e-11)


def written(folder: Path, text: str) -> Path:
    place = folder / "reference.toml"
    place.write_text(text, encoding="utf-8")
    return place


def test_files_are_read(tmp_path):
    jerk = read_reference(written(tmp_path, 'kind = "minimum-jerk"\nfrom = [0]\nto = [90]\nduration = 0.5\n'))
    assert jerk.at(np.array([0.25]))[0, 0, 0] == pytest.approx(math.pi / 4)
    assert jerk.duration == 5.0
    wave = read_reference(written(tmp_path, 'kind = "sine"\namplitude = [-10]\nfrequency = [0.25]\n'))
    assert wave.at(np.array([1.0]))[0, 0, 0] == pytest.approx(-10 * RAD)


SINE = 'kind = "sine"\namplitude = [1, 2]\nfrequency = [1, 1]\n'
JERK = 'kind = "minimum-jerk"\nfrom = [0, 0]\nto = [1, 1]\nduration = 1\n'
BAD = [
    ("", ["kind"]),
    ('kind = "circle"\n', ["kind"]),
    ("kind = 3\n", ["kind"]),
    (SINE + "phase = [1]\n", ["phase"]),
    (SINE + "phse = [1, 2]\n", ["phse"]),
    (SINE.replace("[1, 2]", '["a", nan]'), ["amplitude[1]", "amplitude[2]"]),
    (SINE.replace("[1, 1]", "[-1, 1e9]"), ["frequency[1]", "frequency[2]"]),
    (SINE.replace("[1, 2]", "[]"), ["amplitude"]),
    (SINE.replace("[1, 2]", "1"), ["amplitude"]),
    (SINE.replace("[1, 2]", "[true, 1]"), ["amplitude[1]"]),
    (SINE.replace("[1, 2]", "[1e6, 1]"), ["amplitude[1]"]),
    ('kind = "sine"\n', ["amplitude", "frequency"]),
    (JERK.replace("duration = 1", "duration = 0"), ["duration"]),
    (JERK.replace("duration = 1", ""), ["duration"]),
    (JERK.replace("[1, 1]", "[1, 1, 1]"), ["to"]),
]


@pytest.mark.parametrize(("text", "keys"), BAD, ids=range(len(BAD)))
def test_every_problem_of_a_file_is_told(tmp_path, text, keys):
    with pytest.raises(InputError) as refused:
        read_reference(written(tmp_path, text))
    assert sorted(problem.key for problem in refused.value.problems) == sorted(keys)


def test_another_number_of_joints_is_refused(tmp_path):
    with pytest.raises(InputError, match="moves 2 joints, but the arm has 3"):
        read_reference(written(tmp_path, SINE), 3)
