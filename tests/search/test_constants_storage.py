"""Storage forms along a chain: bounds of λmin(M), λmax(M) and ‖g‖ for all angles."""

from dataclasses import replace
from fractions import Fraction as F

import numpy as np
import pytest

from lyapcheck.check.kinds.chain import (
    NoTorque,
)
from lyapcheck.check.loop.storage import invariant_form
from lyapcheck.check.verify import verify
from lyapcheck.constants import arm_constants, extreme
from lyapcheck.constants.storage import doubles, storage_proof, unit_rows
from lyapcheck.robots import load
from lyapcheck.robots.numeric import NumericModel
from tests.helpers import arm_texts
from tests.helpers.shares import but
from tests.helpers.stated import outcome
from tests.helpers.urdf_texts import ARMS

FIRST = {"ixx": 0.03, "iyy": 0.04, "izz": 0.05, "ixy": 0.01, "iyz": -0.01}
SECOND = {"ixx": 0.02, "iyy": 0.03, "izz": 0.025, "ixz": 0.005}
THIRD = {"ixx": 0.004, "iyy": 0.005, "izz": 0.006}
LEANING = arm_texts.arm_of(
    ("first", (0, 0, -1), (0.1, 0, 0.2), 2, (0.05, 0.1, -0.2), FIRST, 1),
    ("second", (0.6, 0, 0.8), (0.3, 0.1, 0), 1.5, (0.2, -0.05, 0.1), SECOND, 1),
    ("third", (0.48, 0.6, 0.64), (0, 0.4, 0.1), 0.7, (0.1, 0.1, 0.3), THIRD, 1),
)
"""No two of the joints are parallel, and one is upside down."""


def arm_of(name, folder):
    if name == "leaning":
        file = folder / "leaning.toml"
        file.write_text(LEANING, encoding="utf-8")
        return load(file)
    if name in ("ur5", "panda"):
        return load(ARMS / f"{name}.urdf", "panda_hand" if name == "panda" else None)
    return load(name)


@pytest.mark.parametrize("vectors", [1, 2, 3])
def test_turning_forms_are_all_that_turns_leave_alone(vectors):
    """They span the kernel of P ↦ KᵀP + PK on symmetric matrices, K being the rate of turning."""
    n = 3 * vectors
    rate = np.kron(np.eye(vectors), np.array([[0, -1, 0], [1, 0, 0], [0, 0, 0]]))
    forms = [doubles(invariant_form(row, vectors)) for row in unit_rows(vectors * (3 * vectors + 1) // 2)]
    assert all(not np.any(rate.T @ form + form @ rate) for form in forms)
    assert np.linalg.matrix_rank([form.ravel() for form in forms]) == len(forms)
    symmetric = [np.eye(n)[[i]].T @ np.eye(n)[[j]] for i in range(n) for j in range(i + 1)]
    images = [(rate.T @ (e + e.T) + (e + e.T) @ rate).ravel() for e in symmetric]
    assert len(forms) == len(symmetric) - np.linalg.matrix_rank(images)
    with pytest.raises(ValueError, match="another number of coefficients"):
        invariant_form([F(0)] * (len(forms) + 1), vectors)


@pytest.mark.parametrize("name", but(["pelican2"], ["leaning", "pelican2", "ur5", "panda"]))
def test_no_state_lies_outside_and_some_come_close(name, tmp_path):
    arm = arm_of(name, tmp_path)
    names = ["lambda_min", "lambda_max", "k_g", *(f"k_g{i + 1}" for i in range(arm.n))]
    result = {name: storage_proof(arm.chain, name).bound for name in names}
    shown = {c.name: c for c in arm_constants(arm, 300, names=("lambda_min", "lambda_max", "k_g"))}
    model = NumericModel(arm)
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (1000, arm.n))
    values, weights = np.linalg.eigvalsh(model.mass(q)), model.gravity(q)
    assert values.min() >= result["lambda_min"]
    assert values.max() <= result["lambda_max"]
    assert np.linalg.norm(weights, axis=1).max() <= result["k_g"]
    for i in range(arm.n):
        assert np.abs(weights[:, i]).max() <= result[f"k_g{i + 1}"]
    # of the weight the forms can say less, where no axis is parallel to another
    for key in ("lambda_min", "lambda_max") if name == "leaning" else ("lambda_min", "lambda_max", "k_g"):
        inside = shown[key].enclosure.upper if key == "lambda_min" else shown[key].enclosure.lower
        assert abs(result[key] - inside) <= F(1, 100) * inside


# What must not be accepted -----


NAMES = ("lambda_min", "lambda_max", "k_g")


@pytest.mark.parametrize("name", NAMES)
def test_a_posture_refutes_what_is_too_sharp_and_nothing_else(name, tmp_path):
    arm = arm_of("leaning", tmp_path)
    shown, (witness, inner) = storage_proof(arm.chain, name), extreme(arm, name)
    assert outcome(shown.statement, witness) == "refused"
    more = F(1001, 1000) if name == "lambda_min" else F(999, 1000)
    result = verify(shown.at_end(inner * more), witness)
    assert (result.verdict, result.grade) == ("refuted", "enclosure")


def test_joints_without_torque_are_shown_exactly(tmp_path):
    arm = arm_of("ur5", tmp_path)
    result = storage_proof(arm.chain, "k_g5", still=True)
    assert result.bound == 0
    assert verify(result.statement, result.proof).grade == "exact"
    assert storage_proof(arm.chain, "k_g4", still=True) is None
    leaning = replace(result.statement, fall=(F(0), F(1), F(-9)), joints=(1,))
    assert outcome(leaning, NoTorque()) == "refused"
