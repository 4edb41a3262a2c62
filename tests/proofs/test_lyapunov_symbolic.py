"""The published derivation, decided again: (12) = (13), (14) = dV/dt, (15) = (14), and planted faults."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
import sympy as sp
from flint import fmpq_mpoly

from tests.helpers.shares import one_in
from tests.proofs.derivation.generators import generators, total
from tests.proofs.derivation.printed import PRINTED_14, PRINTED_15, STEPS, Term, step_holds, sum_of
from tests.proofs.derivation.symbolic import (
    lyapunov_12,
    lyapunov_13,
    printed_14,
    printed_15,
    rate,
    sympy_rate,
)

JOINTS = [1, 2, 3, 4]


@pytest.mark.parametrize("n", [*JOINTS, 7])
def test_12_equals_13(n: int) -> None:
    assert lyapunov_12(n) == lyapunov_13(n)


@pytest.mark.parametrize("n", JOINTS)
def test_14_and_15_are_the_derivative(n: int) -> None:
    assert printed_14(n) == rate(n)
    assert printed_15(n) == rate(n)


@pytest.mark.parametrize("n", JOINTS)
@pytest.mark.parametrize("step", STEPS, ids=lambda step: "+".join(map(str, step[0])))
def test_each_named_step_from_14_to_15(step: tuple[tuple[int, ...], int | None], n: int) -> None:
    assert step_holds(step, n)


def test_terms_9_and_13_do_not_cancel_but_leave_one() -> None:
    assert not step_holds(((9, 13), None), 2)


def test_steps_use_every_term_once() -> None:
    assert sorted(number for numbers, _ in STEPS for number in numbers) == list(range(1, 17))
    assert sorted(left for _, left in STEPS if left) == list(range(1, 12))


@pytest.mark.parametrize("term", PRINTED_14, ids=lambda term: str(term.number))
def test_a_turned_sign_in_14_is_found(term: Term) -> None:
    assert _changed(PRINTED_14, term, sign=-term.sign) != rate(2)


@pytest.mark.parametrize("term", PRINTED_15, ids=lambda term: str(term.number))
def test_a_turned_sign_in_15_is_found(term: Term) -> None:
    assert _changed(PRINTED_15, term, sign=-term.sign) != rate(2)


def test_transposing_c_is_found_from_two_joints_on() -> None:
    fifth = PRINTED_15[4]
    assert _changed(PRINTED_15, fifth, matrix="C") != rate(2)
    assert _changed(PRINTED_15, fifth, n=1, matrix="C") == rate(1)


def test_a_lost_power_of_the_denominator_is_found() -> None:
    assert _changed(PRINTED_15, PRINTED_15[8], factors=("half", "eps")) != rate(2)


@pytest.mark.parametrize("n", one_in(2, [2, 3]))
def test_sympy_differentiation_by_time_gives_the_same(n: int) -> None:
    values = _point(n)
    assert sympy_rate(n).subs(values) == _sympy(n, rate(n)).subs(values)


def test_normal_form_uses_the_relations_of_r() -> None:
    ring = generators(1)
    r, ri, s, one = ring["r"], ring["ri"], ring["s"], ring.ring.constant(1)
    assert ring.normal_form(r * ri) == one
    assert ring.normal_form(s + s * r) == one
    assert ring.normal_form(ri * s**2 * r**2) == ring.normal_form(s - s**2)


def test_rates_of_what_has_none_are_refused() -> None:
    ring = generators(2)
    with pytest.raises(ValueError, match="no rate is known for d1"):
        ring.rate(ring["d1"])
    with pytest.raises(ValueError, match="at least one joint"):
        generators(0)


def _changed(terms: tuple[Term, ...], term: Term, n: int = 2, **change: Any) -> fmpq_mpoly:
    return sum_of(tuple(replace(t, **change) if t is term else t for t in terms), n)


def _sympy(n: int, value: fmpq_mpoly) -> Any:
    r, names = sp.Symbol("r"), generators(n).names
    meaning = {"s": 1 / (1 + r), "ri": 1 / r}
    symbols = [meaning.get(name, sp.Symbol(name)) for name in names]
    terms = value.to_dict().items()
    return sum(
        sp.Rational(int(c.p), int(c.q)) * sp.Mul(*[symbols[k] ** p for k, p in enumerate(powers) if p])
        for powers, c in terms
    )


def _point(n: int) -> dict[Any, Any]:
    """Random rationals, with the a that (11) gives for them."""
    chance = random.Random(1)
    values = {name: Fraction(chance.randint(1, 30), chance.randint(1, 9)) for name in generators(n).names}
    joints = range(n)

    def at(name: str, *places: int) -> Any:
        value = values[name + "_".join(str(i + 1) for i in places)]
        return sp.Rational(value.numerator, value.denominator)

    M = sp.Matrix(n, n, lambda i, j: at("M", min(i, j), max(i, j)))
    torque = [
        at("kp", i) * at("h", i)
        - at("kv", i) * at("g", i)
        - at("b", i) * at("w", i)
        - total([at("C", i, j) * at("w", j) for j in joints], sp.Integer(0))
        for i in joints
    ]
    a = M.LUsolve(sp.Matrix(torque))
    point = {sp.Symbol(name): sp.Rational(v.numerator, v.denominator) for name, v in values.items()}
    return point | {sp.Symbol(f"a{i + 1}"): a[i] for i in joints}
