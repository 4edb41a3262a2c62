"""Upper bounds for every n: against numbers with the actual norms, with faults, and forged covers."""

from dataclasses import replace

import pytest

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.bound_every_n import BoundEveryN, terms_in_words
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.recheck import gather, recheck
from lyapcheck.check.systems.system import minus
from lyapcheck.check.verify import verify
from lyapcheck.claims import (
    any_matrix,
    any_vector,
    companion,
    constant_goal,
    dot,
    expr,
    form,
    moving_goal,
    norm,
    rate_at_most,
    scaled,
    strict,
    tanh,
    var,
)
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.procedures.norm_bounds import find_bound_every_n
from tests.helpers.shares import one_in
from tests.helpers.stated import verdict

A, S = any_matrix("A"), any_matrix("S")
x, y, d = (any_vector(name) for name in "xyd")
s, p, q, k, l, m = (var(name) for name in "spqklm")
NORMS = (
    ((x.tree,), p.tree),
    ((y.tree,), q.tree),
    ((A.tree,), k.tree),
    ((("diag", "d"),), l.tree),
    ((s.tree, y.tree), m.tree),
)
LEAST = ((form(x, S, x).tree, (3 * p**2).tree),)


def bound(left, right, norms=NORMS, least=None):
    """In x, y, d, s, A and the symmetric S with xᵀSx >= 3p², where S occurs."""
    symmetric = ("S",) if "'S'" in str(left.tree) else ()
    least = (LEAST if symmetric else ()) if least is None else least
    return BoundEveryN(left.tree, expr(right).tree, symmetric, (), (), norms, least)


TRUE = {
    "a form": bound(form(x, A, y), p * k * q),
    "with a minus": bound(-form(x, A, y), p * k * q),
    "of the transpose": bound(2 * form(x, A.T, y), 2 * p * k * q),
    "a diagonal": bound(dot(x, scaled(d, y)), p * l * q),
    "two at once": bound(s * form(x, A, y), p * k * m),
    "or one after the other": bound(s * form(x, A, y), s * p * k * q),
    "a product": bound(dot(x, y) * dot(y, A @ (A @ x)), p**2 * q**2 * k**2),
    "at least": bound(-2 * s * form(x, S, x), -6 * s * p**2),
    "terms cancel": bound(form(x, A, y) - form(y, A.T, x), 0),
    "room to spare": bound(form(x, A, y), 2 * p * k * q + p),
    "several": bound(form(x, A, y) - form(x, S, x) + s * dot(x, y), p * k * q - 3 * p**2 + p * m),
}
OPEN = {
    "too small": bound(form(x, A, y), p * k * q * "0.999"),
    "another power": bound(form(x, A, y), p * k**2 * q),
    "a norm that is not known": bound(form(x, S, y), p * q * 1000),
    "d is no diagonal matrix there": bound(form(scaled(x, d), A, y), p * l * k * q),
    "at least, with a plus": bound(form(x, S, x), 3 * p**2),
    "at least, twice": bound(-form(x, S, x) * form(x, S, x), -9 * p**4),
    "one term too many": bound(form(x, A, y) + s * s, p * k * q),
    "signs do not cancel": bound(form(x, A, y) - form(x, A, y) * 2, 0),
    "a quotient": bound(form(x, A, y) / s, p * k * q / s),
    "a function": bound(form(x, A, y), p * k * q + tanh(p)),
}


@pytest.mark.usefixtures("few_tries")
@pytest.mark.parametrize("name", one_in(3, OPEN))
def test_what_norms_do_not_give_stays_open(name):
    assert verdict(OPEN[name]) != "proved"


# dV/dt ------------------------------------------------------------------------------------------------------

FAMILY = companion("every_function.py")


def rate_of(corner=1, side=1, low=1, more=0, less=0, desired=False, bounded_for=None):
    """The bound of dV/dt, with factors of its entries and ε more or less in two of them."""
    goal = moving_goal("positive") if desired else constant_goal("positive")
    loop, V, above, (h, k, K_p, K_v) = FAMILY.closed_loop(goal, FAMILY.any_function)
    B, eps = goal.B, goal.eps0 * goal.s
    c, d = goal.beta * (h.slope + h.share) + h.reach * goal.kc, B.max + k.secant * K_v.max
    turn = goal.kc * goal.vd if (desired if bounded_for is None else bounded_for) else expr(0)
    first = corner * eps * (K_p.min - eps * turn) + more * eps
    last = low * (B.min - eps * c) + less * eps
    a, b = norm(h), norm(goal.w)
    form = first * a**2 - expr(side) * eps * (d + turn + eps * c) * a * b + last * b**2
    return rate_at_most(strict(loop, V, rate=form, **above))


@pytest.mark.parametrize(("desired", "terms"), [(False, 11), (True, 13)])
def test_the_rate_of_v_has_the_form(desired, terms):
    """Eleven terms as in (15), two more with the desired velocity."""
    statement = rate_of(desired=desired)
    assert len(terms_in_words(statement)[0]) == terms
    assert verdict(statement) == "proved"
    assert verdict(rate_of(side="1.001", desired=desired)) == "proved"


@pytest.mark.slow
@pytest.mark.usefixtures("few_tries")
@pytest.mark.parametrize("desired", [False, True])
def test_it_has_no_better_one(desired):
    """Every entry of Θ is needed as it is."""
    for better in ({"corner": "1.001"}, {"side": "0.999"}, {"low": "1.001"}, {"more": 1}, {"less": 1}):
        one = {name: expr(value) for name, value in better.items()}
        assert verdict(rate_of(**one, desired=desired)) != "proved"


@pytest.mark.slow
@pytest.mark.usefixtures("few_tries")
def test_without_any_one_of_the_norms_nothing_is_shown():
    statement = rate_of(desired=True)
    matrices = [("mat", name) for name in "MCD"] + [("diag", name) for name in ("dh", "Kv", "B")]
    for letter in (*matrices, ("vec", "k"), ("vec", "u"), ("vec", "w")):
        rest = tuple(known for known in statement.norms if letter not in known[0])
        assert len(rest) < len(statement.norms)
        assert verdict(replace(statement, norms=rest)) != "proved", letter
    for name in ("Kp_min", "B_min", "k_sector"):
        rest = tuple(known for known in statement.least if name not in str(known[1]))
        assert len(rest) < len(statement.least)
        assert verdict(replace(statement, least=rest)) != "proved", name


def closed_loop(desired):
    """What M ẇ is under (6), or (21), as the checker derives it, and as (11) has it."""
    every = companion("every_function.py")
    argued = (every.tracking if desired else every.regulator)(every.any_function, "any")
    system = argued.argument.system
    feedback = [("apply", ("diag", name), ("vec", f)) for name, f in (("Kp", "h"), ("Kv", "k"), ("B", "w"))]
    whole = ("sum", feedback[0], *map(minus, (*feedback[1:], ("apply", system.coriolis, ("vec", "w")))))
    return EveryN(("dot", ("vec", "x"), system.force), ("dot", ("vec", "x"), whole))


@pytest.mark.parametrize("desired", [False, True])
def test_the_controller_closes_the_loop_and_another_does_not(desired):
    """(6) or (21) minus the left side of (1), for every n; any letter exchanged on one side refutes it."""
    closed = closed_loop(desired)
    assert ("D" in letters_of(closed.left)) == desired, "C(q, q̇_d) is in (21) alone"
    assert verdict(closed) == "proved"
    gravity = "g" if desired else "gd"
    for old, new in (("Kv", "B"), ("Kp", "Kv"), ("k", "w"), ("C", "M"), (gravity, "h")):
        assert verdict(replace(closed, left=exchanged(closed.left, old, new))) == (
            "proved" if old == gravity else "refuted"
        ), old


def letters_of(tree):
    return {tree} if isinstance(tree, str) else set().union(*map(letters_of, tree))


def exchanged(tree, old, new):
    if not isinstance(tree, tuple):
        return new if tree == old else tree
    return tuple(exchanged(part, old, new) for part in tree)


def test_covers_that_entries_contradict_are_not_proposed(monkeypatch):
    """Were the words wrong, drawn entries would say so before a proof is handed over."""
    statement = TRUE["a diagonal"]
    assert find_bound_every_n(statement).proof is not None
    monkeypatch.setattr(
        "lyapcheck.rechecking.drawn_entries.drawn_entries", lambda *about: iter([(1, {}, 1), (2, {}, -1)])
    )
    found = find_bound_every_n(statement)
    assert found.proof is None
    assert "words are at fault" in str(found)


@pytest.mark.slow
def test_the_process_that_judges_draws_entries_too(tmp_path):
    """A bound whose suppositions nothing meets is true, and still refused."""
    proof = propose(TRUE["a diagonal"]).proof
    statement = replace(TRUE["a diagonal"], norms=(*NORMS, ((S.tree,), expr(-1).tree)))
    assert verify(statement, proof).verdict == "proved"
    about = About("empty", "nothing is so small", None, None, "own")
    for name, one in (("good", TRUE["a diagonal"]), ("empty", statement)):
        certificate = Certificate(about, one, "proved", "exact", proof)
        (tmp_path / f"{name}.json").write_text(certificate.text(), encoding="utf-8")
    empty, good = recheck(gather([str(tmp_path)])).checked
    assert (empty.status, good.status) == ("refused", "accepted")
    assert "that meet the bounds of the norms were not found" in empty.reason
