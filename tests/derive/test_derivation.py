"""h, h', γ, ρ, V and dV/dt from U_m: what is printed, what the checker says of it, and planted faults."""

import doctest
import json
from dataclasses import replace
from xml.etree import ElementTree as ET

import pytest
import sympy as sp

import lyapcheck
from lyapcheck import answers, robots
from lyapcheck import derive as lyapunov
from lyapcheck.answers.derive import rows
from lyapcheck.derive import written_arm
from lyapcheck.derive.family import Member, S, X, member, positive_roots
from lyapcheck.errors import InputError
from lyapcheck.output.document import Document
from lyapcheck.output.text import Depth, View
from tests.family.same_function import hyperbolic_printed, same_function
from tests.helpers.command import lyapcheck as run
from tests.helpers.shares import one_in

MEMBERS = (1, 2, 3, 8)
ARMS = ("pendulum1", "reyes-kelly2", "buap3")


@pytest.mark.parametrize("m", MEMBERS)
def test_the_derived_formulas_are_the_printed_ones(m):
    printed, derived = hyperbolic_printed(X, m), member(m)
    assert derived.h == printed.h
    assert same_function(derived.dh, printed.dh, X, m)


@pytest.mark.parametrize("m", MEMBERS[1:])
def test_the_polynomials_are_those_of_the_places_of_gamma_and_rho(m):
    u, derived = sp.Symbol("u"), member(m)
    gamma = u**m - 2 * m * u - (2 * m - 1)
    rho = u ** (2 * m) - 2 * m**2 * u ** (m + 1) - (2 * m - 1) * (m + 2) * u**m + 2 * m**2 * u
    assert derived.gamma_polynomial == sp.Poly(gamma, u, domain="QQ")
    assert derived.rho_polynomial == sp.Poly(rho + (2 * m - 1) * (m - 1), u, domain="QQ")
    assert [len(positive_roots(p)) for p in (derived.gamma_polynomial, derived.rho_polynomial)] == [1, 2]


def test_another_potential_is_not_agreed_to():
    """h of twice the potential; and ρ of a polynomial whose roots are elsewhere."""
    wrong = rows.of_member(Member(2, 2 * member(2).potential))
    assert [row.agree for row in wrong] == [False] * 4
    u, right = sp.Symbol("u"), member(2)
    moved = rows.largest(right, "gamma", "h", right.h, sp.Poly(u**2 - 4 * u - 2, u))
    assert moved.verdict == "proved"
    assert not moved.agree


@pytest.mark.parametrize("n", [1, 2, 3])
def test_v_and_its_derivative_are_those_that_the_checker_proves(n):
    assert [row.agree for row in rows.of_loop(n)] == [True, True]


@pytest.mark.parametrize("term", one_in(5, range(11)))
def test_a_changed_term_is_found(term, monkeypatch):
    """By SymPy in entries, and by the checker for every n."""
    from lyapcheck.answers.derive import rows as statements

    right = lyapunov.terms_15

    def wrong(x):
        return [-t if k == term else t for k, t in enumerate(right(x))]

    for module in (lyapunov, statements):
        monkeypatch.setattr(module, "terms_15", wrong)
    row = rows.of_loop(2)[1]
    assert not row.holds
    assert row.verdict != "proved"


@pytest.mark.parametrize("name", ARMS)
def test_on_an_arm_the_chain_rule_gives_the_same(name):
    model = robots.load(name)
    arm = written_arm(model)
    assert [row.agree for row in rows.of_arm(model, arm)] == [True]
    if model.n > 1:  # with one joint and constant inertia there is nothing to double
        assert not replace(arm, C=2 * arm.C).derivation().sum_is_rate()


def test_only_powers_over_the_denominator_are_read():
    with pytest.raises(sp.PolynomialError):
        member(2).top(1 / S, 1)


def test_the_example_of_the_documentation_is_true():
    assert doctest.testmod(answers.derive).failed == 0


def test_formulas_are_typeset_in_every_format():
    found = lyapcheck.derivation([1, 2], robot="reyes-kelly2")
    assert found.agreed
    assert found.n == 2
    page = found.written("html")
    equations = [ET.fromstring(f"<math{part.split('</math>')[0]}</math>") for part in page.split("<math")[1:]]
    assert len(equations) == sum(len(formulas) for _, formulas in found.parts)
    assert r"\[" in found.written("latex")
    assert r"h_{2}(x) = \frac{\sinh^{3}{\left(x \right)} \cosh{\left(x \right)}}" in found.written("latex")
    assert "```math\nV = " in found.written("markdown")
    text = found.written("text", View(Depth.VERBOSE))
    assert "sinh (x)⋅cosh(x)" in text
    assert max(map(len, text.splitlines())) <= 100  # accents are letters of no width
    assert Document("report", (found.section(),)).blocks[0].title.startswith("What SymPy derives")


def test_the_command_writes_its_rows(in_this_process):
    done = run("derive", "--m", "1", "--n", "1", "--format", "json")
    assert done.returncode == 0
    answer = json.loads(done.stdout)
    assert answer["schema"] == "lyapcheck/derive/1"
    assert answer["agree"]
    assert {row["claim"] for row in answer["results"]} == {"14", "8", "", "12", "15"}
    assert all(row["statement"] for row in answer["results"])
    assert answer["formulas"][1]["sympy"] == "sinh(x)*cosh(x)/(sinh(x)**2 + 1)"


@pytest.mark.parametrize(
    ("asked", "key"), [({"m": 0}, "m"), ({"m": 500}, "m"), ({"n": 0}, "n"), ({"robot": "none"}, "robot")]
)
def test_what_cannot_be_derived_is_refused(asked, key):
    with pytest.raises(InputError) as refused:
        lyapcheck.derivation(**asked)
    assert key in str(refused.value)
