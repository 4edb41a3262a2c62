"""What epsilon and bounds promise over ranges holds of the members, and simulated members keep it."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.files.decimals import decimal_text
from tests.promises.draws import FAMILIES, Ranged, arms, asked, drawn, near_the_border, results, shares

SHARES = st.sampled_from([Fraction(1, 10), Fraction(1, 2), Fraction(99, 100)])
"""Of the largest gains that pass."""
LITTLE = Ranged(Fraction(1, 10), Fraction(1, 20), Fraction(1, 2))
"""Dry friction, N·m, of a joint for which none was drawn."""
BUDGET = ("--starts", "1", "--max-boxes", "20", "--jobs", "1", "--no-store")


def with_dry_friction(arm):
    """The same arm, of which nothing is left open about dry friction."""
    return replace(
        arm,
        joints=tuple(joint if joint.coulomb.high else replace(joint, coulomb=LITTLE) for joint in arm.joints),
    )


def files(folder, arm, family, share, at):
    """Gain files of one set, for the arm with its ranges and for a member."""
    whole = near_the_border(folder, arm.written(folder, "arm"), arm.n, family, arm.options, share)
    text = whole.read_text(encoding="utf-8").replace("arm.toml", arm.at(at).written(folder, "member"))
    own = folder / "own.toml"
    own.write_text(text, encoding="utf-8")
    return str(whole), str(own)


def angles(option, n, *values):
    """An option with an angle a joint."""
    return option, ",".join(str(values[i % len(values)]) for i in range(n))


def over_ranges(arm):
    """Options with which the gate proves for all ranges, also where only the file of the arm has some."""
    mass = arm.joints[0].mass
    return arm.options or ("--vary", f"j1_mass={decimal_text(mass.low)}..{decimal_text(mass.high)}")


def the_one(*words):
    """The answer about the one gain set."""
    done = asked(*words)
    assert done.exit_code in (0, 1, 3), (done.exception, done.stderr)
    (one,) = results(done)
    return one


@drawn(2, 30)
@given(arms().map(with_dry_friction), st.sampled_from(FAMILIES), SHARES, shares)
def test_no_member_rests_farther_from_its_goal_than_is_promised_over_ranges(arm, family, share, at):
    still = ("--time", "0.5", *angles("--target", arm.n, 30, -20), *angles("--start", arm.n, 30, -20))
    with TemporaryDirectory() as name:
        whole, own = files(Path(name), arm, family, share, at)
        over = the_one("bounds", whole, *arm.options, *still)
        alone = the_one("bounds", own, *still)
    rows = zip(
        over["disturbance"]["rest"], alone["disturbance"]["rest"], alone["simulated"]["rest"], strict=True
    )
    for wide, narrow, seen in rows:
        if wide is not None:
            assert narrow is not None
            assert narrow <= wide
            assert seen <= wide, "a run let go inside the bound of the member does not rest there"


@drawn(2, 30)
@given(arms(), st.sampled_from(FAMILIES), SHARES, shares)
def test_no_motor_of_a_member_leaves_its_limit_where_the_gate_accepts_10i_over_ranges(arm, family, share, at):
    motion = "--time", "0.3", *angles("--target", arm.n, 170, -90, 40), *angles("--velocity", arm.n, 200, -90)
    with TemporaryDirectory() as name:
        whole, own = files(Path(name), arm, family, share, at)
        if asked("gate", whole, *arm.options, "--condition", "10i").exit_code != 0:
            return
        by_equations = the_one("simulate", own, *motion)
        on_bench = the_one("simulate", own, "--experiment", *motion[:4])
    for run in (by_equations, on_bench):
        assert all(run["inside_limits"]), run
    assert by_equations["breach"] is None


@drawn(2, 30)
@given(arms(2), st.sampled_from(FAMILIES), SHARES, shares)
def test_v_falls_in_motions_of_a_member_for_the_scalar_epsilon_over_ranges(arm, family, share, at):
    motion = "--time", "0.3", *angles("--target", arm.n, 170, -90), *angles("--velocity", arm.n, 2000, -900)
    with TemporaryDirectory() as name:
        whole, own = files(Path(name), arm, family, share, at)
        checks = the_one("gate", whole, *over_ranges(arm), "--condition", "scalar")["checks"]
        (eps0,) = (check["value"] for check in checks if check["id"] == "scalar")
        if eps0 is None:
            return
        run = the_one("simulate", own, *motion, "--eps0", eps0, "--keep-going")
    assert run["breach"] is None or "τ" in run["breach"]["promise"], run["breach"]


@pytest.mark.slow
@drawn(2, 8)
@given(arms(2), st.sampled_from(FAMILIES), SHARES, shares)
def test_no_epsilon_promised_over_ranges_is_falsified_at_a_member(arm, family, share, at):
    with TemporaryDirectory() as name:
        whole, own = files(Path(name), arm, family, share, at)
        over = the_one("epsilon", whole, *arm.options, "--ranges", *BUDGET)
        alone = the_one("epsilon", own, *BUDGET)
    promised = [over["certified"], over["scalar"] if over["scalar_grade"] == "enclosure" else None]
    for eps0 in filter(None, promised):
        assert alone["falsified"] is None or Fraction(eps0) < Fraction(alone["falsified"])
    if over["published"] is not None:
        # certified constants are as sharp as the search for them
        assert float(over["published"]) <= 1.000001 * float(alone["published"])
