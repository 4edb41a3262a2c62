"""Which judged statements answer a question: each direction of each field, turned round."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator
from dataclasses import fields, replace
from fractions import Fraction
from typing import Any

import pytest

from lyapcheck.check import kinds
from lyapcheck.check.covers import ROWS, require_covered
from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.kinds.gate_accepted import GateAccepted, GateParts
from lyapcheck.check.kinds.gravity import GravityBelow, GravityOfPotential
from lyapcheck.check.kinds.inertia import Bisection, HarmonicSizes, MassAbove, MassBelow, PostureWitness
from lyapcheck.check.kinds.link_bounds import ChainDecreasing
from lyapcheck.check.kinds.resting import Resting
from lyapcheck.check.kinds.sampled import SampledStable, ShortPeriod
from lyapcheck.check.kinds.sampled_from_rest import SampledFromRest
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Statement
from lyapcheck.check.verify import verify
from lyapcheck.control.judgement import judged_statement
from lyapcheck.promise import Promise, promised
from tests.helpers.words_of_proof import GUARDED, promises_as_seen

F = Fraction
SINE, COSINE = (1, 0, 0), (0, 1, 0)
"""Exponents of s1, c1 and one parameter."""
MASS = (((((0, 0, 1), F(1)), ((0, 1, 0), F(1, 2))),),)
"""M(q) = p + ½ cos q."""
RANGE = ((F(2), F(3)),)
NONE, UNIT = (F(0),) * 3, tuple(tuple(F(i == k) for k in range(3)) for i in range(3))
LINKS = (RigidLink(UNIT[2], NONE, F(1), UNIT[0], UNIT, UNIT),)
HEAVY = (RigidLink(UNIT[2], NONE, F(2), UNIT[0], UNIT, UNIT),)
SHOWN: dict[str, Statement] = {
    "MassAbove": MassAbove(MASS, RANGE, F(1)),
    "MassBelow": MassBelow(MASS, RANGE, F(4)),
    "GravityBelow": GravityBelow(1, (((SINE, F(5)),),), RANGE, F(6)),
    "GravityOfPotential": GravityOfPotential((((SINE, F(5)),),), ((COSINE, F(-5)),), RANGE),
    "GateAccepted": GateAccepted(
        1,
        (((SINE, F(5)),),),
        ((COSINE, F(-5)),),
        RANGE,
        (F(5),),
        RANGE,
        (F(20),),
        "hyperbolic",
        1,
        (F(5),),
        (F(1),),
        ("10i", "19"),
        (MassAbove(MASS, RANGE, F(1)),),
    ),
    "Decreasing": Decreasing(MASS, RANGE, RANGE, "hyperbolic", 1, (F(5),), (F(1),), F(1, 10), ()),
    "ChainDecreasing": ChainDecreasing(HEAVY, RANGE, "hyperbolic", 1, (F(5),), (F(1),), F(1, 10)),
    "Resting": Resting("hyperbolic", 1, (F(5),), (F(1),), (F(1, 3),)),
    "SampledStable": SampledStable(
        *("hyperbolic", 1, (F(5),), (F(1, 10),), (F(1),), (), (), (), MASS, ((COSINE, F(-5)),), RANGE),
        *(F(1, 38), F(2), 1, (F(1),), "goal"),
    ),
    "SampledFromRest": SampledFromRest(
        *("hyperbolic", 1, (F(5),), (F(1),), RANGE, MASS, ((COSINE, F(-5)),), RANGE, F(1, 100), 1, F(90))
    ),
}
EASIER: dict[str, Any] = {
    "parameters": ((F(9, 4), F(11, 4)),),
    "viscous": ((F(9, 4), F(11, 4)),),
    "MassAbove.low": F(1, 2),
    "MassBelow.high": F(5),
    "GravityBelow.high": F(7),
    "GateAccepted.limits": (F(21),),
    "GateAccepted.conditions": ("10i",),
    "GateAccepted.stability": (MassAbove(MASS, RANGE, F(1, 2)),),
    "within": F(60),
    "Resting.torque": (F(1, 2),),
    "Resting.errors": (F(1, 2),),
    "viscous_min": (F(2),),
    "SampledStable.period": F(1, 50),
    "stretch": F(3, 2),
}
"""Other values of a question that what is shown answers all the same."""
HARDER: dict[str, Any] = {
    "parameters": ((F(2), F(4)),),
    "viscous": ((F(1), F(3)),),
    "MassAbove.low": F(3, 2),
    "MassBelow.high": F(3),
    "GravityBelow.high": F(5),
    "GateAccepted.limits": (F(19),),
    "SampledStable.k_g": (F(6),),
    "viscous_min": (F(1, 2),),
    "links": LINKS,
    "fall": (F(0), F(0), F(-9)),
    "period": F(1, 10),
    "stretch": F(3),
    "delay": 0,
    "taps": (F(1, 2),),
    "conclusion": "rest",
    "k_g": (F(4),),
    "conditions": ("10p", "10i", "19"),
    "stability": (MassAbove(MASS, RANGE, F(2)),),
    "within": F(91),
    "Resting.torque": (F(2),),
    "Resting.errors": (F(1, 4),),
    "mass": (((((0, 0, 1), F(1)),),),),
    "gravity": (((SINE, F(4)),),),
    "potential": ((COSINE, F(-4)),),
    "joints": 2,
    "family": "tanh",
    "m": 2,
    "kp": (F(6),),
    "kv": (F(2),),
    "eps0": F(1, 20),
    "coupling": (F(1),),
}
"""Values of which nothing is shown, as the other side of each direction."""


def of(table: dict[str, Any]) -> Iterator[tuple[Statement, Statement, str]]:
    for kind, shown in SHOWN.items():
        for one in fields(shown):  # type: ignore[arg-type]
            key = f"{kind}.{one.name}" if f"{kind}.{one.name}" in table else one.name
            if key in table:
                yield shown, replace(shown, **{one.name: table[key]}), f"{kind}.{one.name}"  # type: ignore[type-var]


@pytest.mark.parametrize(
    ("shown", "asked", "field"), [*of(EASIER)], ids=lambda x: x if isinstance(x, str) else ""
)
def test_an_easier_question_is_answered_and_not_the_other_way_round(
    shown: Statement, asked: Statement, field: str
) -> None:
    require_covered(shown, asked)
    with pytest.raises(Refused, match=field):
        require_covered(asked, shown)


@pytest.mark.parametrize(
    ("shown", "asked", "field"), [*of(HARDER)], ids=lambda x: x if isinstance(x, str) else ""
)
def test_a_harder_question_is_not(shown: Statement, asked: Statement, field: str) -> None:
    with pytest.raises(Refused, match=field):
        require_covered(shown, asked)


def test_every_field_of_the_examples_is_tried_in_every_direction() -> None:
    tried = {field for _, _, field in of(HARDER)}
    assert tried == {f"{kind}.{one.name}" for kind, one_of in SHOWN.items() for one in fields(one_of)}  # type: ignore[arg-type]


def test_every_kind_with_directions_has_one_for_each_field() -> None:
    known: dict[str, type[Statement]] = {}
    for module in pkgutil.iter_modules(kinds.__path__):
        known |= vars(importlib.import_module(f"{kinds.__name__}.{module.name}"))
    for kind, rows in ROWS.items():
        assert set(rows) == {one.name for one in fields(known[kind])}, kind  # type: ignore[arg-type]


def test_a_kind_without_directions_answers_itself_alone() -> None:
    from lyapcheck.check.kinds.decreasing import DampingBelow

    one = DampingBelow(MASS, RANGE, RANGE, "hyperbolic", 1, (F(5),), (F(1),), ("num", "1"))
    require_covered(one, one)
    with pytest.raises(Refused, match="no directions"):
        require_covered(one, replace(one, viscous=EASIER["viscous"]))
    with pytest.raises(Refused, match="asked for as MassBelow"):
        require_covered(SHOWN["MassAbove"], SHOWN["MassBelow"])


def test_an_error_without_a_bound_answers_no_bound() -> None:
    shown = replace(SHOWN["Resting"], errors=(None,))  # type: ignore[type-var]
    require_covered(SHOWN["Resting"], shown)
    with pytest.raises(Refused, match=r"Resting\.errors"):
        require_covered(shown, SHOWN["Resting"])


def test_a_motor_without_a_limit_is_asked_less_and_shows_nothing() -> None:
    shown = SHOWN["GateAccepted"]
    unlimited = replace(shown, limits=(None,))  # type: ignore[type-var]
    require_covered(shown, unlimited)
    with pytest.raises(Refused, match=r"GateAccepted\.limits"):
        require_covered(unlimited, shown)


@pytest.mark.parametrize(
    "others",
    [
        {"conditions": ("19", "10i")},
        {"stability": ()},
        {"stability": (MassAbove(MASS, RANGE, F(1)),) * 2},
        {"stability": (MassAbove(MASS, RANGE, F(1)), MassBelow(MASS, RANGE, F(4)))},
        {"stability": (MassBelow(MASS, RANGE, F(4)),)},
    ],
)
def test_a_verdict_answers_its_conditions_in_order_and_each_part_in_its_place(others: dict[str, Any]) -> None:
    with pytest.raises(Refused):
        require_covered(SHOWN["GateAccepted"], replace(SHOWN["GateAccepted"], **others))  # type: ignore[type-var]


@pytest.mark.parametrize("field", ["parameters", "viscous", "GateAccepted.limits", "GateAccepted.conditions"])
def test_the_directions_of_the_gate_are_those_of_its_proofs(field: str) -> None:
    """At the border: what is shown is proved, so is each easier question, and a harder one is refused."""
    shown = replace(  # type: ignore[type-var]
        SHOWN["GateAccepted"],
        gravity=((((1, 0, 1), F(5, 3)),),),
        potential=(((0, 1, 1), F(-5, 3)),),
        limits=(F(11),),
        kv=(F(199, 100),),
        kp=(F(4),),
        stability=(),
    )
    name = field.rpartition(".")[2]
    border = GateParts((HarmonicSizes(),), 30, ())
    easier = {"GateAccepted.limits": (F(12),), "GateAccepted.conditions": ("19",)} | {
        key: EASIER[key] for key in ("parameters", "viscous")
    }
    harder = {"GateAccepted.limits": (F(21, 2),), "GateAccepted.conditions": ("10p", "10i", "19")} | {
        key: HARDER[key] for key in ("parameters", "viscous")
    }
    assert verify(shown, border).verdict == "proved"
    assert verify(replace(shown, **{name: easier[field]}), border).verdict == "proved"
    if field == "GateAccepted.conditions":  # of one joint (10p) and (10i) differ at equality alone
        shown = replace(shown, limits=(F(5) + F(599, 100),))
    with pytest.raises(Refused):
        verify(replace(shown, **{name: harder[field]}), border)


@pytest.mark.parametrize("field", ["k_g", "viscous_min", "period", "stretch"])
def test_the_directions_of_the_sampled_loop_are_those_of_its_proofs(field: str) -> None:
    """At the border: (S) reads 1 > 2·(0.1 + 3/2·T·10), so that T < 2/75."""
    shown: Any = SHOWN["SampledStable"]
    border = ShortPeriod((F(5),), (HarmonicSizes(),))
    if field == "k_g":  # a premise, of any arm
        none: dict[str, Any] = dict.fromkeys(("mass", "potential", "parameters"), ())
        shown, border = replace(shown, k_g=(F(5),), **none), ShortPeriod((), ())
    easier = replace(
        shown,
        **{field: (F(4),) if field == "k_g" else EASIER.get(f"SampledStable.{field}", EASIER.get(field))},
    )
    harder = replace(shown, **{field: HARDER.get(f"SampledStable.{field}", HARDER[field])})
    require_covered(shown, easier)
    assert verify(shown, border).verdict == verify(easier, border).verdict == "proved"
    for refused in (lambda: require_covered(shown, harder), lambda: verify(harder, border)):
        with pytest.raises(Refused):
            refused()


def test_each_part_of_a_conjunction_answers_the_part_of_its_name() -> None:
    low, high = SHOWN["MassAbove"], SHOWN["MassBelow"]
    both = AllOf((("low", low), ("high", high)))
    require_covered(both, AllOf((("low", replace(low, low=F(1, 2))), ("high", high))))  # type: ignore[type-var]
    for asked in (
        AllOf((("low", replace(low, low=F(3, 2))), ("high", high))),  # type: ignore[type-var]
        AllOf((("high", high), ("low", low))),
        AllOf((("low", low),)),
    ):
        with pytest.raises(Refused):
            require_covered(both, asked)


@pytest.mark.parametrize(
    ("easier", "harder", "p"),
    [
        ({"parameters": EASIER["parameters"]}, {"parameters": ((F(1), F(3)),)}, F(1)),
        ({"low": F(1, 2)}, {"low": F(8, 5)}, F(2)),
    ],
)
def test_what_covers_is_followed_by_proofs(easier: dict[str, Any], harder: dict[str, Any], p: F) -> None:
    """An answer to a harder question must not be had: the checker itself refutes it, at q ≈ π."""
    shown = MassAbove(MASS, RANGE, F(7, 5))
    assert (
        verify(shown, Bisection()).verdict
        == verify(replace(shown, **easier), Bisection()).verdict
        == "proved"
    )
    at = PostureWitness((F(22, 7),), (p,), (F(1),))
    assert verify(replace(shown, **harder), at).verdict == "refuted"


def test_a_promise_is_about_what_was_asked() -> None:
    shown = judged_statement(SHOWN["MassAbove"], [Bisection()])
    promise = Promise(replace(SHOWN["MassAbove"], low=F(1, 2)), shown)  # type: ignore[type-var]
    assert promise.says("λmin(M) is at least 0.5, proved") == "λmin(M) is at least 0.5, proved"
    with promises_as_seen():
        assert not GUARDED.search(
            promise.says("At most, at least: PROVED, certified, accepted, every, stable")
        )
    harder, reason = promised(replace(SHOWN["MassAbove"], low=F(3, 2)), shown)  # type: ignore[type-var]
    assert (harder, "MassAbove.low" in reason) == (None, True)
    undecided = judged_statement(replace(SHOWN["MassAbove"], low=F(2)), [])  # type: ignore[type-var]
    assert promised(undecided.statement, undecided)[0] is None
