"""Sums of squares with something changed: what is accepted is still a proof, by an arithmetic of its own."""

import copy
import json
from fractions import Fraction
from random import Random

import pytest

from lyapcheck.check.certificate import judged
from lyapcheck.check.codec import from_json
from lyapcheck.check.statement import Statement
from tests import oracle
from tests.arena.attacks import encoded, sealed
from tests.arena.run import ARENA
from tests.helpers.shares import one_in
from tests.oracle.squares import shows

GOOD = {path.stem[4:]: json.loads(path.read_text()) for path in sorted((ARENA / "good").glob("sos.*.json"))}
TINY = Fraction(1, 10**15)


def accepted(document):
    return not judged(encoded(sealed(document))).reason


def places(value, path=()):
    """Every place in plain data."""
    yield path, value
    parts = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, part in parts:
        yield from places(part, (*path, key))


def put(document, path, value):
    """A copy with a value at a place, or without that place."""
    changed = copy.deepcopy(document)
    place = changed
    for step in path[:-1]:
        place = place[step]
    if value is None:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    return changed


def mutants(document):
    """Each number, monomial, hypothesis and row of the proof changed or left out."""
    count = len(document["statement"]["hypotheses"])
    for path, value in places(document["proof"], ("proof",)):
        if isinstance(value, str) and path[-1] != "rule":
            number = Fraction(value)
            others = (number + TINY, number - TINY, -number, 2 * number, Fraction(0), number + 1, number - 1)
            yield from (put(document, path, str(one)) for one in others if one != number)
        if isinstance(value, int):
            yield from (put(document, path, value + step) for step in (-1, 1, 2))
        if path[-1] == "hypothesis":
            others = [k for k in range(-1, count + 1) if k != value]
            yield from (put(document, path, k) for k in others)
        if isinstance(path[-1], int):
            yield put(document, path, None)
        if path[-1] in ("monomial", "monomials"):
            yield put(document, path, [*value, [0, 1] if path[-1] == "monomial" else [[0, 1]]])
        if path[-1] == "squares":
            z, lower, d = (value[key] for key in ("monomials", "lower", "diagonal"))
            for k in range(len(z)):
                rows = [row[:k] + row[k + 1 :] for row in lower[:k] + lower[k + 1 :]]
                less = {"monomials": z[:k] + z[k + 1 :], "lower": rows, "diagonal": d[:k] + d[k + 1 :]}
                yield put(document, path, less)


def still_shown(document):
    """Whether the oracle takes it for a proof; what has another form is none."""
    try:
        return shows(document, Random(1))
    except (LookupError, ValueError, TypeError):
        return False


@pytest.mark.parametrize("name", GOOD)
def test_the_oracle_takes_the_good_ones_for_proofs(name):
    assert accepted(GOOD[name])
    assert shows(GOOD[name], Random(1))


@pytest.mark.parametrize("name", one_in(9, GOOD))
def test_with_something_changed_it_is_refused_or_still_a_proof(name):
    tried = list(mutants(GOOD[name]))
    said = [accepted(one) for one in tried]
    assert [one["proof"] for one, yes in zip(tried, said, strict=True) if yes and not still_shown(one)] == []
    assert sum(said) < len(said) / 5


def test_there_are_many_of_these():
    assert sum(len(list(mutants(one))) for one in GOOD.values()) > 1000


def relations(document):
    """Each relation of the statement, with the other operator, and with a little added on its right."""
    for path, value in places(document["statement"], ("statement",)):
        if isinstance(value, dict) and "operator" in value:
            other = "<" if value["operator"] == "<=" else "<="
            yield put(document, (*path, "operator"), other)
            for little in (TINY, -TINY):
                yield put(document, (*path, "right"), ["add", value["right"], ["num", str(little)]])


@pytest.mark.parametrize("name", GOOD)
def test_a_statement_just_beyond_the_truth_is_refused(name):
    for changed in relations(GOOD[name]):
        yes = accepted(changed)
        assert not yes or shows(changed, Random(1))
        assert not yes or not oracle.objection(from_json(Statement, changed["statement"], "statement"))
