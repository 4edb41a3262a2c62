"""Attacks on the checker: false or undefined statements, and texts that say something else, must not pass."""

from fractions import Fraction as F

import pytest

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About, judged
from lyapcheck.check.judgement import shortened
from lyapcheck.check.kinds.all_of import AllOf, OnePart
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.constant import Constant, ExactNumbers
from lyapcheck.check.kinds.coriolis import CoriolisBelow
from lyapcheck.check.kinds.decreasing import DampingBelow
from lyapcheck.check.kinds.every_n import EntriesWitness, EveryN
from lyapcheck.check.kinds.for_all import ForAll, Pieces, Sturm
from lyapcheck.check.kinds.for_small import ForSmall
from lyapcheck.check.kinds.identity import Identity, NormalForm
from lyapcheck.check.kinds.inertia import HarmonicSizes, MassBelow
from lyapcheck.check.kinds.norm_bound import NormBound
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Relation, Variable
from lyapcheck.check.verify import verify

A, Y, Z = ("mat", "A"), ("vec", "y"), ("vec", "z")
S, X = ("var", "s"), ("var", "x")
ONE = (((0, 0, 0, 0), F(1)),)
SINE = (((1, 0, 0, 0), F(10)),)
FIVE = (((0, 0, 0, 0), F(5)),)


def num(value):
    return ("num", str(F(value)))


def test_christoffel_symbols_are_of_a_symmetric_matrix():
    """With M12 = M21 = 10 sin q1, as the text reads, C has the entry 10 cos q1 in place 211."""
    with pytest.raises(Refused):
        verify(CoriolisBelow(((ONE, SINE), ((), ONE)), (), F(8)), HarmonicSizes())


def scaled(kind, name, x):
    return ("scale", ("var", name), x) if kind == "var" else ("apply", ("mat", name), x)


def swapped(kind):
    """M and N change places: true for numbers, false for matrices."""
    left, right = (scaled(kind, a, scaled(kind, b, Y)) for a, b in ("MN", "NM"))
    return EveryN(("dot", Z, left), ("dot", Z, right))


def damping(family, friction):
    one = (((0, 0), F(1)),)
    ranges = ((F(friction), F(friction)),)
    return DampingBelow(((one,),), ranges, (), family, None, (F(1),), (F(1),), num(3))


def small(conclusion, variables=(), bounded=()):
    return ForSmall("eps", variables, (), conclusion, bounded)


PAIRS = {
    "numbers and matrices": (swapped("var"), swapped("mat")),
    "h and friction of a loop": (damping("tanh", 1), damping("arctan", 100)),
    "the lower half of M": (
        MassBelow(((ONE, ()), ((), ONE)), (), F(2)),
        MassBelow(((ONE, ()), (FIVE, ONE)), (), F(2)),
    ),
}


@pytest.mark.parametrize("name", PAIRS)
def test_statements_that_differ_have_texts_that_differ(name):
    one, other = PAIRS[name]
    assert one != other
    assert one.text() != other.text()


NAMED_AS_CONSTANTS = {
    "L_2": BoundEveryN(("var", "L_2"), ("L", 2), (), (), (), (), ()),
    "π": Identity(("var", "π"), ("pi",)),
    "γ_2": Identity(("var", "γ_2"), ("gamma", 2)),
}


@pytest.mark.parametrize("name", NAMED_AS_CONSTANTS)
def test_a_variable_does_not_look_like_a_number(name):
    with pytest.raises(Refused, match=r"is not a name|is not an operation"):
        NAMED_AS_CONSTANTS[name].require_well_formed()


def test_the_text_of_a_claim_for_small_values_says_over_what_its_bounded_variables_run():
    gap = ("add", ("var", "t"), ("mul", ("var", "eps"), ("var", "t")))
    text = small(Relation(num(0), "<", gap), bounded=("t",)).text()
    assert "(0, 1]" in text


def test_the_text_of_a_claim_for_small_values_lets_the_threshold_depend_on_the_variables():
    """ε < x for small ε is true at each x > 0, and false as “for small ε: for all x > 0”."""
    text = small(Relation(("var", "eps"), "<", X), (Variable("x", F(0)),)).text()
    assert text.index("x > 0") < text.index("small enough")


def test_what_stands_under_a_rate_must_have_a_value():
    """−1/(s − 1) ≤ 0 is no refutation of d/dt ln(s − 1) ≥ 0 at s = 1/2, where there is no logarithm."""
    s = ("var", "s")
    log = BoundEveryN(("neg", ("rate", ("log", ("add", s, num(-1))))), num(0), (), ((s, num(1)),), (), (), ())
    gone = EveryN(("rate", ("div", num(1), num(0))), num(1))
    for statement, point in ((log, (("s", F(1, 2)),)), (gone, ())):
        with pytest.raises(Refused, match="is not shown to have a value"):
            verify(statement, EntriesWitness(1, point))


def test_letters_shared_without_end_are_refused_at_once():
    t, w, v, z = num(1), ("vec", "w"), ("vec", "v"), ("vec", "z")
    for _ in range(60):
        t = ("dot", ("scale", t, ("sum", w, v)), z)
    with pytest.raises(Refused, match="parts with all powers written out"):
        verify(EveryN(t, t), NormalForm())
    for _ in range(14):
        w = ("apply", ("sum", ("mat", "A"), ("mat", "B")), w)
    with pytest.raises(Refused, match="words"):
        verify(EveryN(("dot", w, w), ("dot", w, w)), NormalForm())


def test_a_power_without_end_is_no_polynomial():
    statement = ForAll(Relation(num(0), "<", ("exp", ("mul", num(10**11), X))))
    with pytest.raises(Refused):
        verify(statement, Pieces((Sturm(),)))


def test_the_text_of_a_refuted_conjunction_begins_with_the_part_that_fails():
    true, false = Constant(Relation(num(0), "<", num(1))), Constant(Relation(num(1), "<", num(0)))
    both = AllOf((("a", true), ("b", false)))
    proof = OnePart(1, ExactNumbers())
    made = Certificate(About("c", "", None, None, "p"), both, "refuted", "exact", proof)
    assert judged(made.text().encode()).statement.startswith("(2) 1 < 0, which is part of: (1) 0 < 1")


def test_a_cut_is_marked_and_leaves_what_is_supposed():
    assert shortened("a" * 400 + " if b", False).endswith("if b")
    assert "a … (cut) … a" in shortened("a" * 400, False)
    assert shortened("a" * 400, True) == "a" * 400


@pytest.mark.parametrize("name", ["γ₂", "ρ1", "π′", "h₂", "γ_2a", "sin", "ln", "ν", "x'"])
def test_a_name_does_not_look_like_something_else(name):
    with pytest.raises(Refused):
        Identity(("var", name), ("var", name)).require_well_formed()


def test_ends_at_infinity_are_neither_open_nor_reached():
    with pytest.raises(Refused, match="infinity"):
        ForAll(Relation(X, "<", num(1)), None, F(0), open_low=True).require_well_formed()
    with pytest.raises(Refused, match="no end"):
        Variable("x", None, strict=False)


def test_the_bound_of_a_norm_stands_in_brackets():
    assert "(−1 + 2)·‖x‖" in NormBound(X, 1, ("add", num(-1), num(2)), 1).text()
