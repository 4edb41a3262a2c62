"""Every committed certificate against the oracle: nothing against what is proved, a point against others."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest
from mpmath import mp

from lyapcheck.check.codec import from_json
from lyapcheck.check.kinds.constant import Constant
from lyapcheck.check.kinds.resting import Resting
from lyapcheck.check.numbers.balls import hyperbolic_constants
from lyapcheck.check.statement import Proof, Statement, Witness
from lyapcheck.claims import expr, for_all, implies, nonnegative, positive, sinh, sqrt, var
from tests import oracle
from tests.claims.test_claims import PROVED, REFUTED
from tests.helpers.committed import texts
from tests.oracle.numbers import supremum

NONE_OF_ITS_OWN = {"GateAccepted", "ChainDecreasing"}
"""They are accepted for reasons that are statements themselves."""


def committed():
    """The certificates, each statement once, by kind and verdict, with all files of these."""
    found, seen = {}, set()
    for place, text in texts().items():
        data = json.loads(text)
        key = json.dumps(data["statement"])
        if key not in seen:
            seen.add(key)
            found.setdefault(f"{data['statement']['kind']} {data['verdict']}", []).append((place, data))
    return found


COMMITTED = committed()


def test_every_kind_has_an_oracle():
    assert {name.split()[0] for name in COMMITTED} - NONE_OF_ITS_OWN <= oracle.known()


QUICK = {
    *(
        "Agrees proved",
        "ChainGravityBelow proved",
        "ChainIdentity proved",
        "Constant proved",
        "MassAbove proved",
    ),
    *("CoriolisAtRest proved", "RateOfMass proved", "EveryN proved", "ForSmall proved", "Resting proved"),
}


def slow_but(quick, names):
    return [name if quick(name) else pytest.param(name, marks=pytest.mark.slow) for name in sorted(names)]


@pytest.mark.parametrize(
    "name", slow_but(QUICK.__contains__, (name for name in COMMITTED if name.endswith("proved")))
)
def test_there_is_no_objection_to_what_is_proved(name):
    for place, data in COMMITTED[name]:
        assert oracle.objection(from_json(Statement, data["statement"], "statement"), 1) is None, place


def point_of(proof):
    """The point, entries or state of a witness."""
    point = {name: str(value) for name, value in getattr(proof, "point", ())}
    if hasattr(proof, "n"):
        point["n"] = str(proof.n)
    for letter in "qew":
        point |= {f"{letter}{k + 1}": str(x) for k, x in enumerate(getattr(proof, letter, ()))}
    return point


@pytest.mark.parametrize(
    "name",
    slow_but(
        lambda name: name[0] in "BCEG" and not name.startswith("ChainCoriolis"),
        (name for name in COMMITTED if name.endswith("refuted")),
    ),
)
def test_what_is_refuted_has_an_objection_or_a_point(name):
    for place, data in COMMITTED[name]:
        statement = from_json(Statement, data["statement"], "statement")
        if type(statement).__name__ in NONE_OF_ITS_OWN:
            continue
        proof = from_json(Proof, data["proof"], "proof")
        if isinstance(proof, Witness):
            assert oracle.confirms(statement, point_of(proof)) is not False, place
        assert oracle.objection(statement, 1) or oracle.confirms(statement, point_of(proof)), place


@pytest.mark.slow
def test_more_than_the_falsified_eps0_has_an_objection_and_a_hundredth_has_none_at_the_state():
    for place, data in COMMITTED["Decreasing refuted"]:
        statement = from_json(Statement, data["statement"], "statement")
        point = point_of(from_json(Proof, data["proof"], "proof"))
        if "w1" not in point:
            continue
        assert oracle.objection(replace(statement, eps0=statement.eps0 * Fraction(102, 100)), 1), place
        assert oracle.confirms(statement, point)
        assert not oracle.confirms(replace(statement, eps0=statement.eps0 / 100), point)


def test_a_bound_of_the_rest_that_is_a_little_stronger_is_broken():
    """artanh(6/20) and artanh(2/8) are 0.310 and 0.255."""
    held = ("tanh", None, (Fraction(20), Fraction(8)), (Fraction(6), Fraction(2)))
    third = Fraction(1, 3)
    assert oracle.objection(Resting(*held, (third, third))) is None
    assert oracle.objection(Resting(*held, (Fraction(3, 10), third))) is not None


# Statements by hand -----------------------------------------------------------------------------------------

x, a, b = var("x"), var("a"), var("b")
FALSE = REFUTED | {
    "equality at an end that is a root": for_all(x**2 - 1 > 0, 1),
    "a millionth": for_all(x / (1 + x**2) <= "0.499999"),
    "roots": Constant(sqrt(2) * sqrt(3) < sqrt(6)),
    "equality at a zero": implies(nonnegative("a", "b"), (), expr(0) < a + b),
}
UNDEFINED = {
    "a pole inside": for_all(1 / x**2 > 0, -1, 1),
    "a simple pole at an irrational number": for_all((x**3 - 2) / (x**3 - 2) > 0, 0, 2),
    "a double pole at a root": for_all(1 / (x**2 - 2) ** 2 > -1, 0, 2),
    "a hypothesis on which nothing rests": implies(positive("a"), (1 / (a - 1) < 0,), expr(0) < 1),
}
TRUE = PROVED | {
    "a pole outside": for_all(1 / (x - 1) ** 2 > 0, 1, open_low=True),
    "roots": Constant(sqrt(2) * sqrt(3) <= sqrt(6)),
    "a high power is small, not zero": for_all(expr(1) < 1 + sinh(x) ** 12, 0, open_low=True),
    "a border that rounding only seems to cross": implies(
        positive("a", "b"), (a < sqrt(3) * b,), a / sqrt(3) < b
    ),
    "a false hypothesis": implies(positive("a"), (a < 0,), a < -1),
    "a divisor that is positive": implies(positive("a", "b"), (), expr(0) < 1 / (a + b)),
}


@pytest.mark.parametrize(("table", "what"), [(FALSE, "false"), (UNDEFINED, "undefined"), (TRUE, None)])
def test_the_oracle_knows_what_is_true(table, what):
    found = {name: oracle.objection(one) for name, one in table.items()}
    assert {name for name, one in found.items() if (one and one.what) != what} == set()


def test_a_witness_is_a_point_of_the_domain_where_all_is_defined():
    claim = for_all((x - 5) / (x - 5) > x, 0, 10)
    assert oracle.confirms(claim, {"x": "7"})
    assert not any(oracle.confirms(claim, {"x": at}) for at in ("5", "11", "1/2"))


def test_an_unknown_kind_is_no_problem():
    assert oracle.objection(object()) is None
    assert oracle.confirms(object(), {}) is None


@pytest.mark.parametrize("m", [2, 3, 5])
def test_the_oracle_has_its_own_constants_and_they_agree(m):
    certified = hyperbolic_constants(m)
    with mp.workdps(60):
        own = {name: Fraction(str(supremum(name, m, 60))) for name in ("gamma", "rho", "L")}
    for name, enclosure in (("gamma", certified.gamma), ("rho", certified.rho), ("L", certified.L)):
        assert abs(own[name] - enclosure.mid) < Fraction(1, 10**25), name
