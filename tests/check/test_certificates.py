"""Certificates: what the judge accepts, what it must refuse, and that no number in one can be changed."""

import copy
import json
import re
from dataclasses import replace
from fractions import Fraction

import pytest

from lyapcheck.certificate import Certificate, to_json
from lyapcheck.check.certificate import SCHEMA, About, digest_of, judge, parse, read
from lyapcheck.check.codec import from_json
from lyapcheck.check.kinds.all_of import EveryPart
from lyapcheck.check.kinds.for_all import Boxes, Pieces, Sturm
from lyapcheck.check.kinds.identity import NormalForm
from lyapcheck.check.kinds.implies import Multiple, SignIdentity
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Relation, Total
from lyapcheck.check.verify import verify
from lyapcheck.claims import (
    all_of,
    expr,
    for_all,
    implies,
    positive,
    run_proof,
    tanh,
    var,
)
from lyapcheck.claims.procedures import propose
from lyapcheck.verdicts import Verdict
from tests.claims.test_claims import PROVED, REFUTED

pytestmark = pytest.mark.usefixtures("in_this_process")

x, y, a, b = map(var, "xyab")
F = Fraction
CASES = {**PROVED, **REFUTED, "all of": all_of(one=PROVED["√3 < 1.7321"], two=PROVED["U' = h"])}
CASES["not all"] = all_of(one=PROVED["√3 < 1.7321"], two=REFUTED["√3 < 1.732"])


def certificate_of(statement):
    decision = propose(statement)
    about = About("c", "a claim", None, None, "test")
    return Certificate(about, statement, decision.verdict.value, decision.grade.label, decision.proof)


@pytest.fixture(scope="module")
def made():
    return {name: certificate_of(statement) for name, statement in CASES.items()}


@pytest.fixture(scope="module")
def published():
    return run_proof("published.py", ms=(2,)).certificates


def sealed(data):
    """A document with the digest of what it says now."""
    content = {key: value for key, value in data.items() if key != "digest"}
    return {**content, "digest": digest_of(content)}


def refusal(statement, proof):
    with pytest.raises(Refused) as caught:
        verify(statement, proof)
    return str(caught.value)


# What is written is what is read --------------------------------------------------------------------------


def test_a_certificate_survives_its_file(made):
    for name, certificate in made.items():
        again = Certificate.of(read(parse(certificate.text())))
        assert again == certificate, name
        assert again.text() == certificate.text()
        assert judge(again).verdict == certificate.verdict


@pytest.mark.slow
def test_the_same_proof_gives_the_same_bytes_without_paths(published):
    again = run_proof("published.py", ms=(2,)).certificates
    assert {name: c.text() for name, c in again.items()} == {name: c.text() for name, c in published.items()}
    assert not any("/work" in c.text() or "home" in c.text() for c in published.values())


@pytest.mark.slow
def test_every_decided_claim_has_one_and_uses_name_the_digests(published):
    result = run_proof("published.py", ms=(2,))
    decided = [row for row in result.claims if row.verdict in (Verdict.PROVED, Verdict.REFUTED)]
    assert len(published) == len(decided)
    digests = {c.claim.id: c.digest for c in published.values()}
    for certificate in published.values():
        assert judge(certificate).grade == certificate.grade
        assert all(digests[claim] == digest for claim, digest in certificate.uses.items())
    assert set(published["10p.m2.json"].uses) == {"2.8", "7a"}
    assert published["16.6.m2.json"].uses == {}, "a witness rests on nothing"


# No number can be changed ---------------------------------------------------------------------------------

NUMBER = re.compile(r"-?[0-9]+([./][0-9]+)?")


def numbers(data, path=()):
    """The places of all numbers, as integers or as text."""
    if isinstance(data, dict):
        return [place for key, value in data.items() for place in numbers(value, (*path, key))]
    if isinstance(data, list):
        return [place for k, value in enumerate(data) for place in numbers(value, (*path, k))]
    is_number = isinstance(data, int) or (isinstance(data, str) and NUMBER.fullmatch(data))
    return [path] if is_number else []


def changed(data, path, change):
    """A copy with one number changed."""
    result = copy.deepcopy(data)
    inner = result
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = change(inner[path[-1]])
    return result


def other_numbers(old):
    """Changes that keep the form: the neighbours, the opposite, 0 and the double."""
    if isinstance(old, bool):
        return [not old]
    if isinstance(old, int):
        return [value for value in (old + 1, old - 1, -old, 2 * old, 0) if value != old]
    if "." in old:
        return [old[:-1] + str((int(old[-1]) + 1) % 10), "-" + old.lstrip("-") if old[0] != "-" else old[1:]]
    value = F(old)
    changes = (value + 1, -value, value * 2, value * F(1001, 1000), F(0))
    return [str(new) for new in changes if new != value]


def test_any_number_changed_is_refused_by_the_digest(made):
    for certificate in made.values():
        data = json.loads(certificate.text())
        places = numbers(data)
        for path in places[:: 1 + len(places) // 25]:
            with pytest.raises(Refused, match="digest"):
                read(changed(data, path, lambda old: other_numbers(old)[0]))


def test_a_proof_of_something_else_shows_nothing_false(made):
    """Every proof against every statement of the tables: accepted only with the right verdict."""
    for name, own in made.items():
        for other in made.values():
            try:
                accepted = verify(own.statement, other.proof)
            except Refused:
                continue
            assert accepted.verdict == own.verdict, name


# Documents that are refused -------------------------------------------------------------------------------


def document():
    return json.loads(certificate_of(for_all(tanh(x) <= 1)).text())


def nest(levels):
    tree = ["var", "x"]
    for _ in range(levels):
        tree = ["neg", tree]
    return tree


BROKEN = {
    "schema": lambda d: d | {"schema": SCHEMA[:-1] + "2"},
    "document the checker does not know": lambda d: d | {"seconds": 1},
    "document the checker lacks": lambda d: {k: v for k, v in d.items() if k != "uses"},
    "claim the checker does not know": lambda d: d | {"claim": d["claim"] | {"author": "me"}},
    "statement.kind": lambda d: d | {"statement": d["statement"] | {"kind": "Lemma"}},
    "proof.rule": lambda d: d | {"proof": {"rule": "trust me"}},
    "must be an object": lambda d: d | {"proof": []},
    "claim.m 2": lambda d: d | {"claim": d["claim"] | {"m": "2"}},
    "claim.m True": lambda d: d | {"claim": d["claim"] | {"m": True}},
    "statement.low lowest terms": lambda d: d | {"statement": d["statement"] | {"low": "2/4"}},
    "statement.low rational": lambda d: d | {"statement": d["statement"] | {"low": "0.5"}},
    "statement.low text": lambda d: d | {"statement": d["statement"] | {"low": 3}},
    "is empty": lambda d: d | {"statement": d["statement"] | {"low": "2", "high": "1"}},
    "variable y declared": lambda d: d | {"statement": d["statement"] | {"variable": "y"}},
    "open_low bool": lambda d: d | {"statement": d["statement"] | {"open_low": 1}},
    "relation ≤ only": lambda d: with_relation(d, operator="="),
    "operation knows": lambda d: with_relation(d, left=["eval", ["var", "x"]]),
    "operation parts": lambda d: with_relation(d, left=["div", ["var", "x"]]),
    "expression list": lambda d: with_relation(d, left="x"),
    "expression float": lambda d: with_relation(d, left=["num", "1e3"]),
    "expression member": lambda d: with_relation(d, left=["h", 0, ["var", "x"]]),
    "expression exponent": lambda d: with_relation(d, left=["pow", ["var", "x"], -1]),
    "nested deeper": lambda d: with_relation(d, left=nest(400)),
    "verdict": lambda d: d | {"verdict": "refuted"},
    "grade": lambda d: d | {"grade": "enclosure" if d["grade"] == "exact" else "exact"},
    "uses digest": lambda d: d | {"uses": {"a": "0123"}},
    "uses text": lambda d: d | {"uses": {"a": 7}},
    "says Unicode": lambda d: d | {"claim": d["claim"] | {"says": "\ud800"}},
}


def with_relation(data, **fields):
    return data | {"statement": data["statement"] | {"relation": data["statement"]["relation"] | fields}}


@pytest.mark.parametrize("rule", BROKEN)
def test_a_malformed_document_is_refused_with_the_rule(rule):
    with pytest.raises(Refused) as caught:
        judge(read(sealed(BROKEN[rule](document()))))
    assert rule.split()[0].strip("≤") in str(caught.value)


@pytest.mark.parametrize(
    "text", ['{"a": 1.5}', '{"a": NaN}', '{"a": 1, "a": 2}', '{"a": 123456789012345678901}', "[" * 100_000]
)
def test_json_that_no_certificate_contains_is_refused(text):
    with pytest.raises(Refused):
        parse(text)


def test_a_refutation_that_claims_to_rest_on_others_is_refused():
    certificate = replace(certificate_of(REFUTED["√3 < 1.732"]), uses={"a": "0" * 64})
    with pytest.raises(Refused, match="rests on nothing"):
        judge(certificate)


# Proofs that are refused ----------------------------------------------------------------------------------


def boxes(*cuts, zero=False, tail=False, bits=64):
    return Boxes(tuple(map(F, cuts)), zero, tail, bits)


def steps(*multiples, lift=()):
    return SignIdentity(lift, tuple(Multiple(k, F(w), m) for k, w, m in multiples))


class Unheard(Total):
    """A kind of statement that no rule decides."""

    def require_well_formed(self):
        pass

    def text(self):
        return ""


def test_a_statement_that_is_no_statement_is_refused():
    assert "declared" in refusal(implies(positive("a"), (), a <= b), steps())
    assert "twice" in refusal(implies(positive("a", "a"), (), expr(0) <= a), steps())
    assert "at least one part" in refusal(all_of(), EveryPart(()))
    assert "is not a way to decide" in refusal(Unheard(), NormalForm())
    with pytest.raises(ValueError, match="<="):
        Relation(("num", "1"), "=", ("num", "1"))


def test_reading_builds_only_what_the_types_say():
    proof = to_json(Pieces((boxes(0, 1), Sturm())))
    assert proof["pieces"][1] == {"rule": "Sturm"}
    assert from_json(Proof, proof, "proof").pieces[1] == Sturm()
    with pytest.raises(Refused, match="not a rule"):
        from_json(Proof, {"rule": "Sturm"}, "proof")
    with pytest.raises(Refused, match="must be identity of signs"):
        from_json(Proof, {"rule": "leading term", "identity": {"rule": "normal form"}}, "proof")


def test_the_precision_outside_does_not_matter():
    from flint import ctx

    certificate = certificate_of(PROVED["√3 > 1 is known"])
    for bits in (10, 53, 1000):
        with ctx.workprec(bits):
            assert judge(certificate).verdict == "proved"
