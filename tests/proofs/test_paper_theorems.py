"""Faults in the paper's theorems as systems, of torque, V, bounds, conditions, h and arm: none is proved."""

import pytest

from lyapcheck.claims import companion, var
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.script import find_script
from tests.helpers.shares import one_in

SOURCE = find_script("every_function.py").read_text(encoding="utf-8")
FOR_ALL = ("regulator", "h_of(2)", "some")
CLASS = ("regulator", "any_function", "some")
GIVEN = ("regulator", "h_of(2)", "given")
MOVING = ("tracking", "h_of(2)", "some")
FAULTS = {
    "the sign of the damping": (FOR_ALL, "K_p @ h - K_v @ k", "K_p @ h + K_v @ k"),
    "gravity at the goal alone": (FOR_ALL, "- K_v @ k + goal.gravity", "- K_v @ k + goal.gravity_at_goal"),
    "the sign of the cross term": (FOR_ALL, "shifted = w - ε * h", "shifted = w + ε * h"),
    "V without potential": (FOR_ALL, " + K_p.entries @ h.U", ""),
    "friction that may vanish": (FOR_ALL, 'constant_goal("positive")', 'constant_goal("any")'),
    "a bound without the slope": (CLASS, "β * (h.slope + h.share)", "β * h.share"),
    "a bound with λmin for λmax": (CLASS, "B.max + k.secant", "B.min + k.secant"),
    "the condition dropped": (GIVEN, '"given": {"where": where}', '"given": {}'),
    "another theorem": (MOVING, "return uniform(loop", "return exponential(loop"),
    "an upper bound too low": (MOVING, "below=β / 2", "below=goal.mu / 2"),
    "(21) without B q̇_d": (MOVING, " + B @ goal.velocity", ""),
    "a bound with half of v_d": (
        MOVING,
        "rate - ε**2 * D * a**2 - ε * D * a * b",
        "rate - ε**2 * D * a**2 - ε * D * a * b / 2",
    ),
    "ρ too small": (FOR_ALL, "(gamma, rho, secant_bound)))", "(gamma, gamma, secant_bound)))"),
    "h with the other sign": (
        FOR_ALL,
        "member(h(m, x), potential(m, x)",
        "member(-h(m, x), -potential(m, x)",
    ),
}
"""What is asked, and what is exchanged in the script."""


def altered(tmp_path, right, wrong, asked):
    assert SOURCE.count(right) == 1, right
    source = SOURCE.replace(right, wrong)
    source = source[: source.index('proof.section("Every function')].replace(
        "    Proof,\n", "    Proof,\n    exponential,\n    lasalle,\n"
    )
    path = tmp_path / "altered.py"
    path.write_text(source, encoding="utf-8")
    script = companion(str(path))
    name, function, eps0 = asked
    functions = script.any_function if function == "any_function" else script.h_of(2)
    return getattr(script, name)(functions, eps0)


@pytest.mark.usefixtures("few_tries")
@pytest.mark.parametrize("name", one_in(10, FAULTS))
def test_a_planted_fault_is_not_proved(tmp_path, name):
    asked, right, wrong = FAULTS[name]
    try:
        stable = altered(tmp_path, right, wrong, asked)
    except ValueError as error:
        assert "is no constant or size of this system" in str(error)  # noqa: PT017
        return
    assert propose(stable).verdict.value != "proved"


FAMILY = companion("every_function.py")


def test_a_theorem_for_one_class_is_one_for_all_members():
    """One statement for every n and every function; it has no number of either."""
    stable = FAMILY.regulator(FAMILY.any_function)
    assert "every n" in stable.text()
    assert all(f.member is None for f in stable.argument.system.functions)
    assert propose(stable).verdict.value == "proved"
    x = var("x")
    linear = FAMILY.regulator(FAMILY.member(x, x**2 / 2))
    assert propose(linear).verdict.value != "proved", "h = x has no bound"
