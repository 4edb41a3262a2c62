"""Storage forms along a chain: bounds of λmin(M), λmax(M) and ‖g‖ for all angles."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path

import numpy as np
import pytest

from lyapcheck.constants import arm_constants
from lyapcheck.constants.storage import storage_bounds
from lyapcheck.constants.storage.bounds import holds, proved
from lyapcheck.constants.storage.exact import rounded
from lyapcheck.constants.storage.hinges import hinges
from lyapcheck.constants.storage.kinetic import kinetic
from lyapcheck.constants.storage.problem import turning_forms
from lyapcheck.constants.storage.program import propose
from lyapcheck.robots import RobotModel, load
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.shares import but
from tests.helpers.urdf_texts import ARMS

LEANING = """
title = "three joints, no two of them parallel, one upside down"
gravity = [0, 0, -9.81]

[[links]]
name = "first"
axis = [0, 0, -1]
origin = [0.1, 0, 0.2]
viscous = 1
mass = 2
com = [0.05, 0.1, -0.2]
inertia = { ixx = 0.03, iyy = 0.04, izz = 0.05, ixy = 0.01, iyz = -0.01 }

[[links]]
name = "second"
axis = [0.6, 0, 0.8]
origin = [0.3, 0.1, 0]
viscous = 1
mass = 1.5
com = [0.2, -0.05, 0.1]
inertia = { ixx = 0.02, iyy = 0.03, izz = 0.025, ixz = 0.005 }

[[links]]
name = "third"
axis = [0.48, 0.6, 0.64]
origin = [0, 0.4, 0.1]
viscous = 1
mass = 0.7
com = [0.1, 0.1, 0.3]
inertia = { ixx = 0.004, iyy = 0.005, izz = 0.006 }
"""


def arm_of(name: str, folder: Path) -> RobotModel:
    if name == "leaning":
        file = folder / "leaning.toml"
        file.write_text(LEANING, encoding="utf-8")
        return load(file)
    if name in ("ur5", "panda"):
        return load(ARMS / f"{name}.urdf", "panda_hand" if name == "panda" else None)
    return load(name)


def walked(arm: RobotModel, q: np.ndarray, x: np.ndarray) -> tuple[float, float]:
    """q̇ᵀMq̇ and q̇ᵀg, link by link in the frames of the hinges."""
    bodies, fall = hinges(arm.chain)
    twist, free, energy, power = np.zeros(6), rounded(fall), 0.0, 0.0
    for hinge, angle, rate in zip(bodies, q, x, strict=True):
        c, s = np.cos(angle), np.sin(angle)
        back = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
        twist = np.kron(np.eye(2), back) @ rounded(hinge.carry) @ twist
        twist[2] += rate
        free = back @ rounded(hinge.turn) @ free
        energy += twist @ rounded(hinge.body) @ twist
        moved = float(hinge.mass) * twist[3:] + np.cross(twist[:3], rounded(hinge.moment))
        power -= free @ moved
    return energy, power


@pytest.mark.parametrize("name", but(["leaning", "pelican2"], ["leaning", "pelican2", "ur5", "panda"]))
def test_the_frames_of_the_hinges_carry_the_same_arm(name: str, tmp_path: Path) -> None:
    arm = arm_of(name, tmp_path)
    model, rng = NumericModel(arm), np.random.default_rng(1)
    for _ in range(5):
        q, x = rng.uniform(-3, 3, arm.n), rng.normal(size=arm.n)
        energy, power = walked(arm, q, x)
        assert energy == pytest.approx(x @ model.mass(q) @ x, rel=1e-11)
        assert power == pytest.approx(x @ model.gravity(q), rel=1e-11, abs=1e-11)


@pytest.mark.parametrize("vectors", [1, 2, 3])
def test_turning_forms_are_all_that_turns_leave_alone(vectors: int) -> None:
    """They span the kernel of P ↦ KᵀP + PK on symmetric matrices, K being the rate of turning."""
    n = 3 * vectors
    rate = np.kron(np.eye(vectors), np.array([[0, -1, 0], [1, 0, 0], [0, 0, 0]]))
    forms = turning_forms(vectors)
    assert all(not np.any(rate.T @ form + form @ rate) for form in forms)
    assert np.linalg.matrix_rank([form.ravel() for form in forms]) == len(forms)
    symmetric = [np.eye(n)[[i]].T @ np.eye(n)[[j]] for i in range(n) for j in range(i + 1)]
    images = [(rate.T @ (e + e.T) + (e + e.T) @ rate).ravel() for e in symmetric]
    assert len(forms) == len(symmetric) - np.linalg.matrix_rank(images)


@pytest.mark.parametrize("name", but(["leaning", "pelican2"], ["leaning", "pelican2", "ur5", "panda"]))
def test_no_state_lies_outside_and_some_come_close(name: str, tmp_path: Path) -> None:
    arm = arm_of(name, tmp_path)
    found = {key: make() for key, make in storage_bounds(arm.chain).items() if key != "k_c"}
    shown = {c.name: c for c in arm_constants(arm, 300, names=("lambda_min", "lambda_max", "k_g"))}
    model = NumericModel(arm)
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (1000, arm.n))
    values, weights = np.linalg.eigvalsh(model.mass(q)), model.gravity(q)
    assert values.min() >= found["lambda_min"]
    assert values.max() <= found["lambda_max"]
    assert np.linalg.norm(weights, axis=1).max() <= found["k_g"]
    for i in range(arm.n):
        assert np.abs(weights[:, i]).max() <= found[f"k_g{i + 1}"]
    # of the weight the forms can say less, where no axis is parallel to another
    for key in ("lambda_min", "lambda_max") if name == "leaning" else ("lambda_min", "lambda_max", "k_g"):
        inside = shown[key].enclosure.upper if key == "lambda_min" else shown[key].enclosure.lower
        assert abs(found[key] - inside) <= F(1, 100) * inside


def test_one_joint_has_its_moment_and_its_weight(tmp_path: Path) -> None:
    """I + m l² and m g l."""
    file = tmp_path / "one.toml"
    link = "mass = 2\nviscous = 1\naxis = [0, 1, 0]\norigin = [0, 0, 0]\ncom = [0.5, 0, 0]\ninertia = 0.1"
    file.write_text(f'title = "one"\ngravity = [0, 0, -10]\n[[links]]\nname = "a"\n{link}\n')
    found = {key: make() for key, make in storage_bounds(load(file).chain).items()}
    assert found["k_c"] is None
    assert float(found["lambda_min"]) == pytest.approx(0.6, rel=1e-6)
    assert float(found["lambda_max"]) == pytest.approx(0.6, rel=1e-6)
    assert float(found["k_g1"]) == pytest.approx(10, rel=1e-4)


# What must not be accepted -----


def test_a_smaller_constant_does_not_hold(tmp_path: Path) -> None:
    for sign in (1, -1):
        problem = kinetic(hinges(arm_of("ur5", tmp_path).chain)[0], sign)
        proposal = proved(problem)
        assert not holds(problem, replace(proposal, kappa=proposal.kappa - 0.01 * abs(proposal.kappa)))


def test_forms_of_other_joints_do_not_hold(tmp_path: Path) -> None:
    problem = kinetic(hinges(arm_of("ur5", tmp_path).chain)[0], 1)
    proposal = proved(problem)
    assert not holds(problem, replace(proposal, coefficients=np.roll(proposal.coefficients, 1, axis=0)))
    assert not holds(problem, replace(proposal, coefficients=0 * proposal.coefficients))


def test_forms_that_turns_change_would_prove_something_false(tmp_path: Path) -> None:
    """With any form allowed the program bounds M at q = 0 only; turning forms are what holds for all q."""
    arm = arm_of("leaning", tmp_path)
    problem = kinetic(hinges(arm.chain)[0], 1)
    every = [e + e.T for e in (np.outer(a, b) for a in np.eye(6) for b in np.eye(6))]
    kappa = propose(replace(problem, forms=every), 0.0).kappa
    model = NumericModel(arm)
    assert kappa == pytest.approx(np.linalg.eigvalsh(model.mass(np.zeros(3)))[-1], rel=1e-4)
    q = np.random.default_rng(0).uniform(-3, 3, (500, 3))
    assert np.linalg.eigvalsh(model.mass(q)).max() > 1.05 * kappa
