"""URDF files: what is read, how the chain is chosen, and dynamics against an independent recursion."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck import robots
from lyapcheck.errors import InputError
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.urdf.rotations import OF, Roundings, from_rpy, tidy, unit
from tests.helpers.newton_euler import Arm, rpy
from tests.helpers.shares import one_in
from tests.helpers.urdf_texts import ARMS, TWO, generic

decimals = st.decimals(-7, 7, places=6).map(Fraction)
directions = st.tuples(decimals, decimals, decimals).filter(any)


def load(folder: Path, text: str, tip: str | None = None, name: str = "arm.urdf") -> robots.RobotModel:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return robots.load(file, tip)


def at_zero(arm: robots.RobotModel) -> tuple[list[list[Fraction]], list[Fraction]]:
    sin, cos = [Fraction(0)] * arm.n, [Fraction(1)] * arm.n
    return arm.at(sin, cos, Fraction).mass(), arm.at(sin, cos, Fraction).gravity()


def test_decimals_are_read_exactly(tmp_path: Path) -> None:
    arm = load(tmp_path, TWO)
    assert (arm.name, arm.title, arm.joints) == ("arm", "two (URDF)", ("shoulder", "elbow"))
    mass, gravity = at_zero(arm)
    lower = Fraction("0.02") + Fraction("1.5") * Fraction("0.04")
    tool = Fraction("0.001") + Fraction("0.25") * Fraction("0.16")
    assert mass[1][1] == lower + tool
    assert gravity[1] == -Fraction("9.81") * (
        Fraction("1.5") * Fraction("0.2") + Fraction("0.25") * Fraction("0.4")
    )


def test_friction_limits_and_their_lines(tmp_path: Path) -> None:
    arm = load(tmp_path, TWO)
    assert [number.value for number in arm.viscous] == [Fraction(1, 2), Fraction(1, 4)]
    assert arm.coulomb[0] is not None
    assert arm.coulomb[0].value == Fraction(1, 10)
    assert arm.coulomb[1] is None
    assert arm.torque_limit[0] is not None
    assert arm.torque_limit[0].value == 20
    assert arm.torque_limit[1] is None
    assert arm.viscous[0].source == "arm.urdf, line 24"
    assert arm.numbers["upper_mass"].source == "arm.urdf, line 5"


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('mass value="0.25"', 'mass value="0"', "an inertia and no mass, as the file gives: tool"),
        ('izz="0.02"', 'izz="9"', "a principal moment above the sum of the others: upper, lower"),
    ],
)
def test_bodies_that_cannot_be_are_told(tmp_path: Path, old: str, new: str, told: str) -> None:
    assert old in TWO
    assert told not in "\n".join(load(tmp_path, TWO).assumptions)
    assert told in "\n".join(load(tmp_path, TWO.replace(old, new)).assumptions)


def test_a_fixed_joint_is_the_same_as_one_heavier_link(tmp_path: Path) -> None:
    """The tool merged by hand: masses, centre and inertia of two bodies about their common centre."""
    both, com = Fraction("1.75"), (Fraction("0.3") + Fraction("0.1")) / Fraction("1.75")
    moment = (
        Fraction("0.021")
        + Fraction("1.5") * (Fraction("0.2") - com) ** 2
        + Fraction("0.25") * (Fraction("0.4") - com) ** 2
    )
    old, merged = load(tmp_path, TWO), load(tmp_path, TWO, "lower")
    assert (old.mass, old.potential) == (merged.mass, merged.potential)
    mass, _ = at_zero(old)
    assert mass[1][1] == moment + both * com**2


@pytest.mark.slow
@pytest.mark.parametrize(("file", "tip", "n"), one_in(2, [("ur5", None, 6), ("panda", "panda_hand", 7)]))
def test_real_arms_move_as_newton_and_euler_say(file: str, tip: str | None, n: int) -> None:
    path = ARMS / f"{file}.urdf"
    arm = robots.load(path, tip)
    assert arm.n == n
    compare(arm, Arm(path, arm.joints))


@pytest.mark.parametrize("n", one_in(3, [3, 1, 2, 4, 7, 12]))
def test_odd_arms_move_as_newton_and_euler_say(tmp_path: Path, n: int) -> None:
    arm = load(tmp_path, generic(n, seed=n))
    compare(arm, Arm(tmp_path / "arm.urdf", arm.joints))


def compare(arm: robots.RobotModel, other: Arm) -> None:
    """M, g and C w within 1e-12 of the torques of the recursion."""
    model, rng, n = NumericModel(arm), np.random.default_rng(7), arm.n
    for _ in range(10):
        q, w = rng.uniform(-3, 3, n), rng.uniform(-2, 2, n)
        rest = np.zeros(n)
        gravity = other.torque(q, rest, rest)
        mass = np.array([other.torque(q, rest, unit_) - gravity for unit_ in np.eye(n)]).T
        coriolis = other.torque(q, w, rest) - gravity
        for mine, theirs in (
            (model.gravity(q), gravity),
            (model.mass(q), mass),
            (model.coriolis(q, w) @ w, coriolis),
        ):
            assert np.max(np.abs(mine - theirs)) <= 1e-12 * max(1.0, np.max(np.abs(theirs)))


# The chain -------------------------------------------------------------------------------------------------


def test_a_tip_is_for_urdf_files_only() -> None:
    with pytest.raises(InputError, match="buap3 is built in"):
        robots.load("buap3", "tool")


# Rotations -------------------------------------------------------------------------------------------------


@given(st.tuples(decimals, decimals, decimals))
def test_rotations_are_exactly_orthogonal_and_close(angles: tuple[Fraction, Fraction, Fraction]) -> None:
    turn = from_rpy(angles, "here", Roundings())
    check_rotation(turn)
    assert np.allclose(np.array(turn, dtype=float), rpy([float(x) for x in angles]), atol=2e-15, rtol=0)


def check_rotation(turn: object) -> None:
    rows = [list(row) for row in turn]  # type: ignore[attr-defined]
    assert all(sum(rows[i][k] * rows[j][k] for k in range(3)) == (i == j) for i in range(3) for j in range(3))


@given(st.lists(st.tuples(decimals, decimals, decimals), min_size=2, max_size=4))
def test_shortened_rotations_stay_orthogonal_and_close(
    angles: list[tuple[Fraction, Fraction, Fraction]],
) -> None:
    turn = from_rpy(angles[0], "here", Roundings())
    for more in angles[1:]:
        turn = OF.product(turn, from_rpy(more, "here", Roundings()))
    short = tidy(turn)
    check_rotation(short)
    assert max(
        abs(a - b) for x, y in zip(turn, short, strict=True) for a, b in zip(x, y, strict=True)
    ) < Fraction(1, 10**15)


@given(directions)
def test_axes_have_length_exactly_one(direction: tuple[Fraction, Fraction, Fraction]) -> None:
    x = unit(direction, "here", Roundings())
    assert sum(part * part for part in x) == 1
    size = np.linalg.norm([float(part) for part in direction])
    assert np.allclose([float(part) for part in x], [float(part) / size for part in direction], atol=1e-15)


@pytest.mark.parametrize(
    ("angle", "exact"),
    [("1.570796327", True), ("-1.57079632679", True), ("3.14159", False), ("1.5708", False)],
)
def test_angles_written_as_right_ones_are_right(angle: str, exact: bool) -> None:
    roundings = Roundings()
    turn = from_rpy((Fraction(0), Fraction(0), Fraction(angle)), "here", roundings)
    image = OF.apply(turn, (Fraction(1), Fraction(0), Fraction(0)))
    assert (set(map(abs, image)) == {Fraction(0), Fraction(1)}) == exact
    assert bool(roundings.rounded) != exact


# Arm files that name a URDF file ----------------------------------------------------------------------------

OVERLAY = """\
title = "two joints and their friction"
urdf = "two.urdf"
tip = "tool"
gravity = [0, 0, -1.62]

[[joints]]
name = "elbow"
viscous = { value = 0.75, assumed = true, note = "a guess" }
torque_limit = 9
encoder = 4096
"""


def test_an_arm_file_adds_what_the_urdf_lacks(tmp_path: Path) -> None:
    (tmp_path / "two.urdf").write_text(TWO)
    (tmp_path / "arm.toml").write_text(OVERLAY)
    arm = robots.load(tmp_path / "arm.toml")
    assert (arm.name, arm.title) == ("arm", "two joints and their friction")
    assert [number.value for number in arm.viscous] == [Fraction(1, 2), Fraction(3, 4)]
    assert arm.encoder == (None, 4096)
    assert arm.torque_limit[1] is not None
    assert "elbow_viscous = 0.75 N·m·s/rad is assumed: a guess" in arm.assumptions
    assert not any("gravity" in sentence for sentence in arm.assumptions)
    assert at_zero(arm)[1][1] == -Fraction("1.62") * Fraction("0.4")


def test_an_arm_file_around_a_urdf_without_a_title_lacks_that_alone(tmp_path: Path) -> None:
    (tmp_path / "arm.toml").write_text('urdf = "two.urdf"\n')
    with pytest.raises(InputError) as caught:
        robots.load(tmp_path / "arm.toml")
    assert [(problem.key, problem.rule) for problem in caught.value.problems] == [("title", "is missing")]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            '"elbow"',
            '"elbo"',
            "arm.toml:7: joints[1].name = elbo: is no joint of this chain; did you mean elbow?",
        ),
        ('"two.urdf"', '"three.urdf"', "three.urdf: file: cannot be read"),
        ('"two.urdf"', '"two.toml"', "arm.toml:2: urdf = two.toml: must be the path of a file of a robot"),
        ('"two.urdf"', '""', "arm.toml:2: urdf: must be a non-empty text"),
        ('"tool"', '"tol"', "two.urdf:2: tip = tol: is no link of this file; name one, for instance tool"),
        ("0.75", "-1", "joints[1].viscous = { value = -1"),
        ("encoder", "encodr", "joints[1].encodr = 4096: is not a known key here; did you mean encoder?"),
        ("[0, 0, -1.62]", "[0, 0, { value = -1.6, low = -2, high = -1 }]", "gravity"),
        ("[[joints]]", "[model]\n[[joints]]", "model = {}: is not a known key here"),
        (
            "encoder = 4096",
            'encoder = 4096\n[[joints]]\nname = "elbow"',
            "joints[2].name = elbow: is given twice",
        ),
    ],
)
def test_broken_arm_files_around_a_urdf(tmp_path: Path, old: str, new: str, expected: str) -> None:
    (tmp_path / "two.urdf").write_text(TWO)
    assert old in OVERLAY
    (tmp_path / "arm.toml").write_text(OVERLAY.replace(old, new))
    with pytest.raises(InputError) as caught:
        robots.load(tmp_path / "arm.toml")
    assert expected in str(caught.value)
