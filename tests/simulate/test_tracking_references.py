"""Reference trajectories: derivatives, bounds for all times, and files that cannot be used."""

from __future__ import annotations

import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from lyapcheck.errors import InputError
from lyapcheck.simulate.reference import MinimumJerk, Recorded, Reference, Sine
from lyapcheck.simulate.reference_file import read_reference

RAD = math.pi / 180


def row(*values: object) -> tuple[Fraction, ...]:
    return tuple(Fraction(str(value)) for value in values)


def sine(
    phase: tuple[Fraction, ...] = row(0, 90), frequency: tuple[Fraction, ...] = row("0.5", "0.5")
) -> Sine:
    return Sine(row(20, 30), frequency, phase, row(0, 45))


def recorded(spline: str) -> Recorded:
    t = np.linspace(1.0, 6.0, 12)
    return Recorded(t, np.column_stack((np.sin(t), np.cos(2 * t), 0.1 * t)), spline)


ALL = {
    "sine": sine(),
    "unequal sines": sine(frequency=row("0.5", "0.3")),
    "minimum jerk": MinimumJerk(row(0, 10, -5), row(45, -45, 90), Fraction(2)),
    "cubic": recorded("cubic"),
    "quintic": recorded("quintic"),
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
def test_two_derivatives_are_continuous(reference: Reference):
    """Where the splines have their knots and the minimum jerk its ends, too."""
    places = np.concatenate((np.linspace(0.0, 5.0, 12)[1:-1], [2.0]))
    gap = reference.at(places + 1e-9) - reference.at(places - 1e-9)
    assert np.max(np.abs(gap)) < 1e-6


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


def test_the_minimum_jerk_is_at_rest_at_both_ends():
    motion = MinimumJerk(row(0), row(90), Fraction(2))
    ends = motion.at(np.array([0.0, 2.0, 7.0]))[:, :, 0]
    np.testing.assert_allclose(ends, [[0, 0, 0], [math.pi / 2, 0, 0], [math.pi / 2, 0, 0]], atol=1e-15)
    assert float(motion.suprema().speed) == pytest.approx(15 / 8 * (math.pi / 2) / 2, rel=1e-11)
    assert float(motion.suprema().acceleration_norm) == pytest.approx(
        10 / math.sqrt(3) * (math.pi / 2) / 4, rel=1e-11
    )


def test_a_spline_goes_through_its_samples_and_gives_polynomials_back():
    t = np.array([0.0, 0.4, 1.1, 1.7, 2.0, 3.0, 3.2])
    for spline, degree in (("cubic", 3), ("quintic", 5)):
        truth = np.polynomial.Polynomial(np.arange(1.0, degree + 2.0) / 10)
        motion = Recorded(t, truth(t)[:, None], spline)
        fine = np.linspace(0.0, 3.2, 50)
        np.testing.assert_allclose(motion.at(fine)[:, 0, 0], truth(fine), rtol=1e-9)
        np.testing.assert_allclose(motion.at(fine)[:, 2, 0], truth.deriv(2)(fine), rtol=1e-7, atol=1e-8)


@example(values=[0.0] * 6 + [2.2e-311], gaps=[1.0] * 12)
@given(
    values=st.lists(st.floats(-3, 3), min_size=7, max_size=12),
    gaps=st.lists(st.floats(0.05, 2.0), min_size=12, max_size=12),
)
def test_the_bounds_of_any_spline_hold(values, gaps):
    t = np.cumsum(gaps)[: len(values)]
    for spline in ("cubic", "quintic"):
        motion = Recorded(t, np.array(values)[:, None], spline)
        at = np.abs(motion.at(np.linspace(0.0, motion.span, 3000))[:, 1:, 0]).max(axis=0)
        bounds = motion.suprema()
        assert at[0] <= float(bounds.speed)
        assert at[1] <= float(bounds.acceleration_norm)


def written(folder: Path, text: str, samples: str = "") -> Path:
    if samples:
        (folder / "motion.csv").write_text(samples, encoding="utf-8")
    place = folder / "reference.toml"
    place.write_text(text, encoding="utf-8")
    return place


def test_files_are_read(tmp_path):
    jerk = read_reference(written(tmp_path, 'kind = "minimum-jerk"\nfrom = [0]\nto = [90]\nduration = 0.5\n'))
    assert jerk.at(np.array([0.25]))[0, 0, 0] == pytest.approx(math.pi / 4)
    assert jerk.duration == 5.0
    wave = read_reference(written(tmp_path, 'kind = "sine"\namplitude = [-10]\nfrequency = [0.25]\n'))
    assert wave.at(np.array([1.0]))[0, 0, 0] == pytest.approx(-10 * RAD)


def test_recordings_may_be_in_degrees_and_start_at_any_time(tmp_path):
    rows = "\n".join(f"{k / 2 + 3},x,{10 * k}" for k in range(6))
    text = 'kind = "recorded"\nfile = "motion.csv"\n'
    motion = read_reference(written(tmp_path, text, f"t [s],note,q1 [deg]\n{rows}\n"), 1)
    assert motion.span == motion.duration == 2.5
    assert motion.at(np.array([1.25]))[0, :2, 0] == pytest.approx([25 * RAD, 20 * RAD])


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
    ('kind = "recorded"\n', ["file"]),
    ('kind = "recorded"\nfile = "none.csv"\n', ["file"]),
    ('kind = "recorded"\nfile = "none.csv"\nspline = "linear"\n', ["file", "spline"]),
]


@pytest.mark.parametrize(("text", "keys"), BAD, ids=range(len(BAD)))
def test_every_problem_of_a_file_is_told(tmp_path, text, keys):
    with pytest.raises(InputError) as refused:
        read_reference(written(tmp_path, text))
    assert sorted(problem.key for problem in refused.value.problems) == sorted(keys)


HEAD = "t,q1 [rad]\n"
BAD_SAMPLES = [
    ("", ["header", "header"]),
    ("t,q1\n0,1\n", ["header"]),
    ("q1 [rad]\n0\n", ["header"]),
    ("t,q2 [rad]\n0,1\n", ["header"]),
    (HEAD + "0,0\n1,1\n", ["file"]),
    (HEAD + "0,0\n1,1\n1,2\n3,4\n5,x\n", ["q1", "t"]),
    (HEAD + "0,0\n1\ninf,2\n3,4\n5,nan\n", ["q1", "q1", "t"]),
    (HEAD + '0,"1\n', ["file"]),
]


@pytest.mark.parametrize(("samples", "keys"), BAD_SAMPLES, ids=range(len(BAD_SAMPLES)))
def test_every_problem_of_a_recording_is_told(tmp_path, samples, keys):
    (tmp_path / "motion.csv").write_text(samples, encoding="utf-8")
    with pytest.raises(InputError) as refused:
        read_reference(written(tmp_path, 'kind = "recorded"\nfile = "motion.csv"\n'))
    assert sorted(problem.key for problem in refused.value.problems) == keys


def test_another_number_of_joints_is_refused(tmp_path):
    with pytest.raises(InputError, match="moves 2 joints, but the arm has 3"):
        read_reference(written(tmp_path, SINE), 3)
