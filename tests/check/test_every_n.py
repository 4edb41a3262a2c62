"""Identities for every n: against NumPy, against the same entry by entry, and with faults of every kind."""

import runpy
from dataclasses import replace

import pytest

from lyapcheck.check.kinds.identity import NormalForm
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.claims import (
    any_matrix,
    any_vector,
    dot,
    every_n,
    expr,
    form,
    loops,
    plus,
    rate,
    scaled,
    total,
    transpose,
    var,
    zero_vector,
)
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.script import find_script
from lyapcheck.rechecking import drawn_entries
from tests.helpers.stated import verdict

A, B, S = (any_matrix(name) for name in "ABS")
x, y, z, d = (any_vector(name) for name in "xyzd")
s, t = var("s"), var("t")
PUBLISHED = runpy.run_path(str(find_script("published.py")))
L = loops.letters()


TRUE = {
    "transposition": every_n(form(x, A, y), form(y, transpose(A), x)),
    "a product": every_n(dot(x, A @ (B @ y)), dot(B.T @ (A.T @ x), y)),
    "symmetry": every_n(form(x, S, y), form(y, S, x), [S]),
    "entry by entry": every_n(dot(x, scaled(d, y)), dot(d, scaled(y, x))),
    "diagonals commute inside": every_n(
        form(x, A, scaled(d, scaled(y, A @ z))), form(x, A, scaled(y, scaled(d, A @ z)))
    ),
    "an end and a diagonal": every_n(form(scaled(d, x), A, y), form(scaled(x, d), A, y)),
    "half of a symmetric part": every_n(form(x, A + A.T, x) / 2, form(x, A, x)),
    "quotients": every_n(
        1 / (1 + s) - 1 / (1 + t), (t - s) / ((1 + s) * (1 + t)) + dot(x, y) - dot(y, x), positive=[s, t]
    ),
    "what is given": every_n(form(y, A, x), 2 * dot(y, z), given=[(A, x, z.times(2))]),
    "what is given, transposed": every_n(dot(A.T @ y, x), 2 * dot(z, y), given=[(A, x, z.times(2))]),
    "a derivative": every_n(rate(s * dot(x, x)), 2 * s * dot(x, y) + t * dot(x, x), rates=[(x, y), (s, t)]),
    "of a quotient": every_n(
        rate(dot(x, d) / s),
        dot(y, d) / s - dot(x, d) * t / s**2,
        rates=[(x, y), (s, t), (d, zero_vector())],
        positive=[s],
    ),
    "nothing": every_n(dot(x, zero_vector()), expr(0)),
}
FALSE = {
    "no symmetry": every_n(form(x, A, y), form(y, A, x)),
    "matrices do not commute": every_n(dot(x, A @ (B @ y)), dot(x, B @ (A @ y))),
    "symmetric ones neither": every_n(dot(x, A @ (S @ y)), dot(x, S @ (A @ y)), [A, S]),
    "a diagonal is no matrix of any kind": every_n(form(x, A, scaled(d, y)), form(scaled(d, x), A, y)),
    "an end beyond a matrix": every_n(form(scaled(d, x), A, y), form(scaled(d, y), A, x), [A]),
    "true for n = 1 alone": every_n(dot(x, y) * dot(z, d), dot(x, z) * dot(y, d)),
    "a derivative forgotten": every_n(rate(s * dot(x, x)), 2 * s * dot(x, y), rates=[(x, y), (s, t)]),
    "what is given for another vector": every_n(form(y, A, d), 2 * dot(y, z), given=[(A, x, z.times(2))]),
    "what is given, not transposed": every_n(form(x, A, y), 2 * dot(y, z), given=[(A, x, z.times(2))]),
}


@pytest.mark.parametrize("name", TRUE)
def test_what_holds_for_every_n_is_proved(name):
    assert verdict(TRUE[name]) == "proved"


@pytest.mark.parametrize("name", FALSE)
def test_what_fails_for_some_n_is_refuted_by_entries(name):
    assert verdict(FALSE[name]) == "refuted"


def test_an_n_at_which_it_fails_is_found():
    """It holds for n = 1, where there is nothing to exchange."""
    result = propose(FALSE["true for n = 1 alone"])
    assert result.proof.n == 2


# (14) and (15) ----------------------------------------------------------------------------------------------


def fourteen(terms, **changes):
    statement = loops.along(L, PUBLISHED["V_12"], total(terms))
    return replace(statement, **changes)


def rates_with(letter, value):
    terms = PUBLISHED["TERMS_14"]
    rates = [(a, value.tree if a == letter.tree else b) for a, b in fourteen(terms).rates]
    return fourteen(terms, rates=tuple(rates))


def test_any_other_rate_of_m_than_c_plus_its_transpose_proves_nothing():
    """A symmetric rate that is another one refutes (14); one that is not symmetric makes no sense."""
    assert verdict(rates_with(L.M, plus(L.C, transpose(L.C)))) == "proved"
    assert verdict(rates_with(L.M, plus(any_matrix("Z"), any_matrix("Z").T))) == "refuted"
    other = rates_with(L.M, plus(L.C, L.C))
    assert verdict(other) == "undecided"
    with pytest.raises(Refused, match="symmetric derivative"):
        verify(other, NormalForm())


def test_the_motion_and_the_symmetry_of_m_are_needed():
    terms = PUBLISHED["TERMS_14"]
    assert verdict(fourteen(terms, given=())) == "refuted"
    assert verdict(fourteen(terms, symmetric=())) == "refuted"
    assert verdict(rates_with(L.h, L.w)) == "refuted"
    pushed = scaled(L.kp, L.h) - scaled(L.kv, L.hw) - scaled(L.b, L.w)
    for other in (pushed, pushed - L.C.T @ L.w, pushed + L.C @ L.w):
        (motion,) = fourteen(terms).given
        assert verdict(fourteen(terms, given=(replace(motion, equals=other.tree),))) == "refuted"


def test_the_rate_of_the_norm_is_that_of_the_root_of_its_square():
    norm = loops.along(L, L.r**2, rate(dot(L.e, L.e)))
    assert verdict(norm) == "proved"
    turned = [(a, L.w.tree if a == L.e.tree else b) for a, b in norm.rates]
    assert verdict(replace(norm, rates=tuple(turned))) == "refuted"


# What the checker refuses -----------------------------------------------------------------------------------


@pytest.mark.slow
def test_words_that_entries_contradict_are_not_proposed(monkeypatch):
    """Were the words wrong, drawn entries would say so before a proof is handed over."""
    from lyapcheck.claims.procedures import identity as searched

    statement = every_n(dot(x, y), dot(x, z))
    monkeypatch.setattr(searched, "is_zero", lambda tree: True)
    found = searched.find_every_n(statement)
    assert found.proof is None
    assert "words are at fault" in str(found)


def test_words_that_entries_contradict_are_refused_where_certificates_are_judged(monkeypatch):
    """The process that judges has this doubt, beside the rules."""
    statement = every_n(dot(x, y), dot(x, z))
    monkeypatch.setattr("lyapcheck.check.kinds.every_n.is_zero", lambda tree: True)
    monkeypatch.setattr("lyapcheck.check.verify.DOUBTS", {})
    assert verify(statement, NormalForm()).verdict == "proved"
    drawn_entries.install()
    with pytest.raises(Refused, match="words are at fault"):
        verify(statement, NormalForm())
