"""The decision procedures: true statements near false ones, outside facts, and faults that must be seen."""

from fractions import Fraction

import pytest
from flint import fmpq_poly
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.answers.check.run import paper_case_data
from lyapcheck.check.expressions.domain import Interval
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.expressions.scales import sign_beside, sign_from
from lyapcheck.check.kinds.for_all import without_abs
from lyapcheck.check.numbers.polynomials import count_roots, nonnegative_on, positive_on
from lyapcheck.claims import (
    AnyMatrix,
    Constant,
    ForSmall,
    above,
    agrees,
    any_matrix,
    any_vector,
    at_most_every_n,
    atan,
    below,
    cos,
    cosh,
    decreasing,
    dh,
    diagonal,
    diff,
    dot,
    every_n,
    exp,
    expr,
    for_all,
    form,
    gamma,
    gravity_bounded,
    h,
    identity,
    implies,
    largest_with,
    log,
    nonnegative,
    norm_bound,
    pi,
    positive,
    potential,
    rate,
    reals,
    rho,
    sin,
    sinh,
    sqrt,
    tanh,
    var,
)
from lyapcheck.claims.claim import Case
from lyapcheck.claims.decision import Decision, Judged, decided
from lyapcheck.claims.expressions import exact_value
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.procedures.search import broken_sides
from lyapcheck.verdicts import Grade, Verdict

x, y, a, b, c = map(var, "xyabc")
V, W, A = any_vector("V"), any_vector("W"), any_matrix("A")
MITRINOVIC = (3 + x**2 / 11) * sinh(x) < x * (2 + cosh(x) + x**2 / 11)  # mitrinovic1970analytic, 3.6.12


def norms_for_every_n(left, right):
    """‖V‖ ≤ a, ‖A‖ ≤ b, ‖W‖ ≤ c."""
    return at_most_every_n(left, right, [(V, a), (A, b), (W, c)])


PROVED = {
    "Mitrinović 3.6.12 on its interval": for_all(MITRINOVIC, "0.01", "5.1785"),
    "Mitrinović 3.6.12 down to 0": for_all(MITRINOVIC, 0, "5.1785", open_low=True),
    "tanh x ≤ x, equality to second order at 0": for_all(tanh(x) <= x, 0),
    "tanh x < x right of 0": for_all(tanh(x) < x, 0, open_low=True),
    "tanh x ≤ 1, equality at infinity": for_all(tanh(x) <= 1),
    "exp x ≥ 1 + x on the line, equality inside": for_all(exp(x) >= 1 + x),
    "a square, touching 0 at 1": for_all((x - 1) ** 2 >= 0),
    "cosh x ≥ 1 + x²/2": for_all(cosh(x) >= 1 + x**2 / 2),
    "ln(1 + x) ≤ x": for_all(log(1 + x) <= x, 0, 5),
    "atan x ≤ x": for_all(atan(x) <= x, 0, 20),
    "√(1 + x) ≤ 1 + x/2": for_all(sqrt(1 + x) <= 1 + x / 2, 0, 100),
    "h_2 stays below 1.0536": for_all(h(2, x) <= "1.0536"),
    "h_8 is continuous up to 96 orders at 0": for_all(expr(0) <= x * h(8, x)),
    "|h| and |x|": for_all(abs(h(2, x)) <= abs(x)),
    "|h| < |x| but at 0": for_all(abs(h(2, x)) < abs(x), low=0, open_low=True),
    "|h|, a smaller slope": for_all(abs(h(2, x)) <= Fraction(9, 10) * abs(x)),
    "|tanh x| on the left": for_all(abs(tanh(x)) <= -x, high=0),
    "|x| as one factor": for_all(x * abs(x) <= x**2),
    "addition theorem": identity(sinh(x + y), sinh(x) * cosh(y) + cosh(x) * sinh(y)),
    "sin² + cos²": identity(sin(x) ** 2 + cos(x) ** 2, 1),
    "U' = h": identity(diff(potential(5, x), "x"), h(5, x)),
    "√2 √2 = 2": identity(sqrt(2) * sqrt(2), 2),
    "√3 < 1.7321": Constant(sqrt(3) < "1.7321"),
    "‖h‖ ≤ √n γ": norm_bound(h(3, x), 4, sqrt(4) * gamma(3)),
    "‖h'‖ ≤ √n ρ": norm_bound(dh(3, x), 4, 2 * rho(3)),
    "‖tanh x‖ ≤ ‖x‖": norm_bound(h(1, x), 3, 1, power=1),
    "transitivity": implies(positive("a", "b", "c"), (a < b, b <= c), a < c),
    "a square of reals": implies(reals("a", "b"), (), expr(0) <= a**2 + b**4),
    "a product of positives": implies(positive("a", "b"), (expr(1) < a, expr(1) < b), expr(1) < a * b),
    "√3 > 1 is known": implies(positive("a"), (), a < sqrt(3) * a),
    "small ε": ForSmall("eps", positive("a", "b"), (a < b,), var("eps") * a + a < b),
    "rounding": agrees(a * b, "0.01", a="0.06", b="0.133"),
    "rounding of the inputs": agrees(a * b, "100", a="9", b="10"),
    "a symmetric part for every n": every_n(form(V, A + A.T, V) / 2, form(V, A, V)),
    "a derivative for every n": every_n(
        rate(a * form(V, A, V)),
        3 * a * form(V, A + A.T, W) + b * form(V, A, V),
        rates=[(V, W.times(3)), (a, b), (A, AnyMatrix(("sum",)))],
    ),
    "what is given, for every n": every_n(form(W, A, V), 2 * dot(W, W), given=[(A, V, W.times(2))]),
    "norms for every n": norms_for_every_n(form(V, A, W), a * b * c),
    "ε ≤ ε₀": at_most_every_n(x**2 * dot(V, W), x * a * b * c, [(x, a), (V, b), (W, c)]),
    "constants that multiply to a rational": at_most_every_n(
        form(V, A, W), 3 * gamma(2) * a * b, [(V, sqrt(3) * a), (A, gamma(2)), (W, sqrt(3) * b)]
    ),
    "the better of two norms": at_most_every_n(dot(V, W), a * b, [(V, 2 * a), (V, a), (W, b)]),
}

REFUTED = {
    "leading term of unknown sign": ForSmall("eps", positive("a", "b"), (), var("eps") * a + a < b),
    "a leading term that vanishes": ForSmall("eps", positive("a"), (), a + var("eps") < a),
    "the sign of the lowest order": ForSmall(
        "eps", positive("a") + reals("b"), (b <= 0,), b + sqrt(3) * var("eps") ** 2 < a * var("eps") ** 3
    ),
    "a quotient for small ε": ForSmall(
        "eps", positive("a"), (), 1 / (1 + var("eps")) <= 1 - 2 * a * var("eps"), ()
    ),
    "for some share of ε": ForSmall(
        "eps", positive("a"), (), var("eps") * gamma(3) < var("eps") * var("t"), ("t",)
    ),
    "norms for every n, too small a bound": norms_for_every_n(2 * form(V, A, W), a * b * c),
    "larger ε": at_most_every_n(x * y * dot(V, V), x**2 * a**2, [(x, y), (V, a)]),
    "norms for every n, other symbols": norms_for_every_n(form(V, A, W), a * b**2),
    "no symmetry for every n": every_n(form(V, A, W), form(W, A, V)),
    "a derivative without a factor": every_n(rate(dot(V, V)), dot(V, W), rates=[(V, W)]),
    "Mitrinović 3.6.12 too far": for_all(MITRINOVIC, "0.01", "5.2"),
    "tanh x ≤ x left of 0": for_all(tanh(x) <= x),
    "tanh x < x at 0": for_all(tanh(x) < x, 0),
    "tanh x ≤ 0.999": for_all(tanh(x) <= "0.999"),
    "exp x ≥ 1 + 1.01 x": for_all(exp(x) >= 1 + expr("1.01") * x),
    "exp x > 1 + x at 0": for_all(exp(x) > 1 + x),
    "a square minus a little": for_all((x - 1) ** 2 >= expr("0.001")),
    "√(1 + x) ≤ 1 + x/3": for_all(sqrt(1 + x) <= 1 + x / 3, 0, 100),
    "h_2 stays below 1.05": for_all(h(2, x) <= "1.05"),
    "|h| < |x| at 0": for_all(abs(h(2, x)) < abs(x)),
    "|h|, too small a slope": for_all(abs(h(2, x)) <= Fraction(86, 100) * abs(x)),
    "a sign that changes": for_all(abs(x - 1) <= abs(x) + Fraction(9, 10)),
    "|tanh x|, the other sign": for_all(abs(tanh(x)) <= x),
    "addition theorem with a sign": identity(sinh(x + y), sinh(x) * cosh(y) - cosh(x) * sinh(y)),
    "h'' is not h'": identity(diff(h(2, x), "x"), 2 * dh(2, x)),
    "U' is not 2 h": identity(diff(potential(5, x), "x"), 2 * h(5, x)),
    "√3 < 1.732": Constant(sqrt(3) < "1.732"),
    "‖h‖ ≤ γ without √n": norm_bound(h(3, x), 4, gamma(3)),
    "‖h_1‖ ≤ γ without √n, never reached": norm_bound(h(1, x), 2, gamma(1)),
    "‖h'‖ ≤ √n ρ‖x‖ at 0": norm_bound(dh(1, x), 3, sqrt(3), power=1),
    "‖h‖ ≤ ½ √n γ ‖x‖": norm_bound(h(1, x), 3, sqrt(3) / 2, power=1),
    "transitivity of ≤ is not strict": implies(positive("a", "b", "c"), (a <= b, b <= c), a < c),
    "a cube is not positive": implies(reals("a", "b"), (), expr(0) <= a**2 + b**3),
    "a product of positives the other way": implies(positive("a", "b"), (expr(1) < a * b,), expr(1) < a),
    "rounding": agrees(a * b, "0.01", a="0.6", b="0.133"),
    "8.8 is not 8": agrees(100 * (1 - a / b), "8", a="25.4006", b="27.8546"),
}

UNDECIDED = {
    "a leading term that vanishes at √2 alone": ForSmall(
        "eps", positive("a"), (expr(2) <= a**2, a**2 <= 2), var("eps") + a**2 < 2
    ),
    "small values without a value": ForSmall(
        "eps", positive("a"), (), 1 / (a - a) + var("eps") < 1 / (a - a)
    ),
}


@pytest.mark.parametrize("name", PROVED)
def test_true_statements_are_proved(name):
    decision = propose(PROVED[name])
    assert decision.verdict is Verdict.PROVED, decision
    assert decision.grade in (Grade.ENCLOSURE, Grade.EXACT)


@pytest.mark.parametrize("name", REFUTED)
def test_false_statements_are_refuted_with_a_witness(name):
    decision = propose(REFUTED[name])
    assert decision.verdict is Verdict.REFUTED, decision
    assert decision.witness["left"] != decision.witness["right"] or decision.witness["operator"] == "<"


@pytest.mark.parametrize("name", UNDECIDED)
def test_open_statements_come_with_a_reason(name):
    decision = propose(UNDECIDED[name])
    assert decision.verdict is Verdict.UNDECIDED
    assert decision.reason


@given(st.integers(2, 9), st.integers(-6, 6))
def test_bounds_just_beside_gamma_fall_on_their_sides(m, offset):
    """γ_m from the certified constants: a bound above is proved by Sturm, one below refuted by a point."""
    from lyapcheck.check.numbers.balls import hyperbolic_constants

    bound = hyperbolic_constants(m).gamma.mid + Fraction(2 * offset + 1, 500)
    expected = Verdict.PROVED if offset >= 0 else Verdict.REFUTED
    assert propose(for_all(h(m, x) <= bound)).verdict is expected


@given(st.lists(st.integers(-4, 4), min_size=1, max_size=5), st.integers(-5, 5))
def test_sturm_counts_the_roots_it_is_given(roots, low):
    poly = fmpq_poly([1])
    for root in roots:
        poly *= fmpq_poly([-root, 1])
    assert count_roots(poly, Fraction(low), None) == len({r for r in roots if r > low})
    changes = [r for r in set(roots) if roots.count(r) % 2 and r > low]
    assert nonnegative_on(poly, Fraction(low), None) is (not changes)
    assert positive_on(poly, Fraction(low), None) is (not [r for r in roots if r >= low])


def test_equality_of_values_is_not_taken_for_a_proof():
    assert sign_beside((x - x).tree, "x", Fraction(0), Fraction(1, 2)) == 0
    assert sign_from((x - x).tree, "x", Fraction(4)) == 0
    assert sign_from((tanh(x) - 1).tree, "x", Fraction(4)) < 0
    assert not is_zero((log(x * y) - log(x) - log(y)).tree)


def test_only_a_sign_that_is_seen_is_used():
    to_right, both = {"x": Interval(Fraction(0))}, {"x": Interval(Fraction(-1), Fraction(1))}
    for tree, where, plain in (
        (abs(x).tree, to_right, x.tree),
        (abs(x).tree, both, abs(x).tree),
        (abs(x - 1).tree, to_right, abs(x - 1).tree),
        (abs(-x).tree, to_right, ("neg", (-x).tree)),
    ):
        assert without_abs(tree, where) == plain


def test_an_undefined_expression_proves_and_refutes_nothing():
    decision = propose(for_all(expr(0) <= sqrt(x - 10), 0, 5))
    assert decision.verdict is Verdict.UNDECIDED
    assert broken_sides((sqrt(x).tree, "<=", expr(0).tree), {"x": Fraction(-1)}) is None


def test_a_witness_must_meet_the_hypotheses():
    conclusion = (a.tree, "<=", expr(1).tree)
    point = {"a": Fraction(2)}
    assert broken_sides(conclusion, point) is not None
    assert broken_sides(conclusion, point, ((a.tree, "<", expr("1.5").tree),)) is None


def test_numbers_must_be_exact():
    with pytest.raises(TypeError, match="not exact"):
        expr(0.1)
    with pytest.raises(TypeError, match="no truth value"):
        bool(expr(1) < x)


def test_numeric_evidence_decides_nothing():
    with pytest.raises(ValueError, match="numeric"):
        Decision(Verdict.PROVED, Grade.NUMERIC, "sampling")
    with pytest.raises(ValueError, match="witness"):
        Decision(Verdict.REFUTED, Grade.EXACT, "by thought", witness={})
    with pytest.raises(ValueError, match="certificate"):
        Decision(Verdict.PROVED, Grade.EXACT, "by thought")
    with pytest.raises(ValueError, match="says why"):
        Decision(Verdict.UNDECIDED, Grade.NUMERIC, "sampling")


def test_what_a_search_proposes_is_no_verdict():
    result = propose(for_all(tanh(x) <= x, 0))
    assert result.verdict is Verdict.PROVED
    asked = for_all(tanh(x) <= x, 0)
    refusal = Judged(asked, False, "the digest is another one", None, None)
    for judged in (None, refusal):
        assert decided(result, judged, asked).verdict is Verdict.UNDECIDED
    assert "the digest is another one" in decided(result, refusal, asked).reason
    accepted = Judged(asked, True, "", "proved", "enclosure")
    assert decided(result, accepted, asked).grade is Grade.ENCLOSURE
    assert decided(result, accepted, asked).word == "proved"


def test_what_was_not_asked_decides_nothing():
    asked, other = for_all(tanh(x) <= x, 0), for_all(tanh(x) <= x, 1)
    for verdict in ("proved", "refuted"):
        decision = decided(propose(asked), Judged(other, True, "", verdict, "exact"), asked)
        assert decision.verdict is Verdict.UNDECIDED
        assert "asked" in decision.reason or "answer the question" in decision.reason
    with pytest.raises(ValueError, match="promise"):
        Decision(Verdict.PROVED, Grade.EXACT, "by thought", certificate=propose(asked).proof)


def test_a_wrong_printed_number_comes_with_the_input_that_would_give_it():
    witness = propose(agrees(a * 2, "10", solve_for="a", a="3")).witness
    assert [float(bound) for bound in witness["a that gives it"]] == pytest.approx([4.75, 5.25], rel=1e-5)
    assert propose(agrees(a + 2, "10", solve_for="a", a="3")).witness.keys() == witness.keys() - {
        "a that gives it"
    }


def test_what_is_written_where_a_number_belongs_is_that_number_or_is_refused():
    assert exact_value(expr(2) * 3 / 4) == Fraction(3, 2)
    assert exact_value(sqrt(4) + sqrt(2) * sqrt(2) - gamma(1)) == 3
    assert exact_value(sqrt(3) - sqrt(3)) == 0
    assert for_all(x >= 0, sqrt(4)).low == 2
    for refused in (
        lambda: for_all(x >= "1.5", gamma(2)),
        lambda: for_all(x >= 0, 0, pi),
        lambda: gravity_bounded(Case(*paper_case_data(1)).robot, [gamma(2)]),
        lambda: decreasing(Case(*paper_case_data(1)).robot, Case(*paper_case_data(1)).gains, h(1, "0.001")),
        lambda: largest_with(lambda eps: eps < 1, start=sqrt(2)),
    ):
        with pytest.raises(ValueError, match=r"not shown to be rational.*round it by above\("):
            refused()
    for refused in (exact_value, above, below):
        with pytest.raises(ValueError, match="2·a·b contains a, b; give a number"):
            refused(2 * a * b)
        with pytest.raises(ValueError, match="not shown to have a value"):
            refused(1 / (sqrt(2) * sqrt(2) - 2))
    assert above(gamma(2)) - below(gamma(2)) == Fraction(1, 10**4)


def test_only_letters_are_taken_for_letters():
    for refused, words in (
        (lambda: diagonal(V + W), r"diagonal: V \+ W is not the letter of a vector"),
        (lambda: every_n(a, a, symmetric=[A.T]), "symmetric: Aᵀ is not the letter of a matrix"),
        (lambda: every_n(a, a, given=[(A, V + V, W)]), "given: .* is not the letter of a vector"),
        (lambda: every_n(a, a, positive=[1 + a]), r"positive: 1 \+ a is not the letter of a number"),
    ):
        with pytest.raises(ValueError, match=f"{words}; give it a letter of its own"):
            refused()


def test_the_hypotheses_of_a_bound_are_printed_with_it():
    statement = at_most_every_n(
        x * dot(V, W), x * a * b, [(V, a), ((x, W), b), (diagonal(W), c)], [(dot(V, W), 0)]
    )
    assert statement.text() == (
        "x·Vᵀ·W ≤ x·a·b for every n and all numbers a, b, c, x; vectors V, W, no number negative, "
        "if ‖V‖ ≤ a; ‖x‖‖W‖ ≤ b; ‖diag(W)‖ ≤ c; Vᵀ·W ≥ 0"
    )


def test_the_root_of_a_negative_number_is_no_constant():
    b = var("b")
    decision = propose(implies(nonnegative("a", "b"), (), a <= 0 / (sqrt(rho(1) - 3) * b)))
    assert decision.verdict is Verdict.UNDECIDED
