"""ε₀ from the store: the same answer, judged again, and never believed."""

import gzip
import json
from dataclasses import replace
from fractions import Fraction
from functools import cache

import pytest

from lyapcheck import store
from lyapcheck.answers.epsilon import kept
from lyapcheck.answers.epsilon.compute import Options, epsilon
from lyapcheck.answers.epsilon.kept import certificates, kept_epsilon
from lyapcheck.control.gains import GainSet
from lyapcheck.robots import load
from lyapcheck.robots.fields import Vary
from tests.arena.attacks import encoded, sealed
from tests.helpers.shares import one_in

GAINS = GainSet("one", 1, (Fraction(1, 2),), (Fraction(1, 10),))
BUDGET = {"max_boxes": 300, "starts": 2}


@pytest.fixture(autouse=True)
def place(monkeypatch, tmp_path):
    monkeypatch.delenv(store.OFF)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "lyapcheck" / store.ANSWERS


def never(*arguments, **options):
    raise AssertionError("it was computed again")


def rewritten(place, change):
    """All that is kept, changed by someone who knows how it is sealed."""
    for path in place.iterdir():
        answer = json.loads(gzip.decompress(path.read_bytes()[:-32]))
        change(answer)
        store.keep(store.ANSWERS, path.name, gzip.compress(json.dumps(answer).encode()))


@cache
def computed(ranges):
    """An arm, and its ε₀ computed once for all tests."""
    vary = (Vary.parsed("viscous=-10%..+10%"),) if ranges else ()
    model = load("pendulum1", vary=vary)
    result = epsilon(GAINS, model, ranges=ranges, **BUDGET)
    assert result.certified is not None
    assert result.witness is not None
    return model, ranges, result


@pytest.fixture(params=one_in(2, [False, True]), ids=["nominal", "ranges"])
def asked(request):
    return computed(request.param)


def test_epsilon_is_found_again(monkeypatch, asked):
    model, ranges, first = asked
    monkeypatch.setattr(kept, "four", lambda *asked: first)
    assert kept_epsilon(GAINS, model, Options(ranges=ranges, **BUDGET)) is first
    monkeypatch.setattr(kept, "four", never)
    again = kept_epsilon(GAINS, model, Options(ranges=ranges, **BUDGET))
    assert again.data() == first.data()
    texts = [{name: one.text() for name, one in certificates(result).items()} for result in (first, again)]
    assert texts[0] == texts[1]
    with pytest.raises(AssertionError, match="computed again"):
        kept_epsilon(GAINS, model, Options(ranges=ranges, max_boxes=301, starts=2))
    with pytest.raises(AssertionError, match="computed again"):
        kept_epsilon(GAINS, load("pendulum1"), Options(ranges=not ranges, **BUDGET))


def resealed(kind, change):
    """A change of one certificate, with the digest that it then has."""

    def changed(answer):
        one = json.loads(answer["certificates"][kind])
        change(one)
        answer["certificates"][kind] = encoded(sealed(one)).decode()

    return changed


@pytest.mark.parametrize(
    "change",
    [
        resealed("certified", lambda one: one["statement"].update(eps0="1000")),
        resealed("certified", lambda one: one["proof"]["rate"].update(tree="0.")),
        resealed("certified", lambda one: one["statement"].update(kp=["1"])),
        resealed("falsified", lambda one: one["statement"].update(eps0="1/1000")),
        resealed("falsified", lambda one: one["proof"].update(w=["0"])),
        resealed("falsified", lambda one: one["proof"].update(viscous=["1000"])),
        lambda answer: answer["certificates"].update(certified=answer["certificates"]["falsified"]),
        lambda answer: answer["beside"]["reasons"].update(scalar="there is none", published="(19) fails"),
        lambda answer: answer["beside"].pop("reasons"),
        lambda answer: answer.pop("beside"),
    ],
)
def test_an_epsilon_that_was_exchanged_is_asked_again(monkeypatch, place, asked, change):
    model, ranges, first = asked
    monkeypatch.setattr(kept, "four", lambda *asked: first)
    options = Options(ranges=ranges, **BUDGET)
    assert kept_epsilon(GAINS, model, options) is first
    assert kept_epsilon(GAINS, model, options) is not first
    rewritten(place, change)
    assert kept_epsilon(GAINS, model, options).data() == first.data()


def test_what_is_true_of_other_gains_is_asked_again(monkeypatch, place):
    """The certificates of another gain set, accepted, under the question of this one."""
    model, _, first = computed(ranges=False)
    other = replace(GAINS, kp=(Fraction(2, 5),))
    options = Options(**BUDGET)
    monkeypatch.setattr(kept, "four", lambda *asked: first)
    kept_epsilon(GAINS, model, options)
    (path,) = place.iterdir()
    content = path.read_bytes()
    path.unlink()
    monkeypatch.setattr(kept, "four", lambda *asked: replace(first, gains=other))
    kept_epsilon(other, model, options)
    (path,) = place.iterdir()
    path.write_bytes(content)
    monkeypatch.setattr(kept, "four", never)
    with pytest.raises(AssertionError, match="computed again"):
        kept_epsilon(other, model, options)
