"""Certificates: what the judge accepts, what it must refuse, and that no number in one can be changed."""

import copy
import json
import re
from dataclasses import replace
from fractions import Fraction
from functools import reduce
from operator import getitem

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.certificate import Certificate, to_json
from lyapcheck.check.certificate import SCHEMA, About, digest_of, judge, parse, read
from lyapcheck.check.codec import from_json
from lyapcheck.check.expressions.expression import CONSTANTS, FAMILY, FUNCTIONS
from lyapcheck.check.kinds.agrees import Corners, OutsideRounding
from lyapcheck.check.kinds.all_of import EveryPart, OnePart
from lyapcheck.check.kinds.constant import ExactNumbers, SeparateBalls
from lyapcheck.check.kinds.for_all import Boxes, Pieces, Sturm
from lyapcheck.check.kinds.for_small import SmallWitness
from lyapcheck.check.kinds.identity import NormalForm
from lyapcheck.check.kinds.norm_bound import EqualEntries, Supremum
from lyapcheck.check.kinds.signs import Multiple, SignIdentity
from lyapcheck.check.kinds.trigonometric import EntryWitness, FourierBounds
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Relation, Total, Witness
from lyapcheck.check.verify import verify
from lyapcheck.claims import (
    Constant,
    ForSmall,
    agrees,
    all_of,
    always_positive,
    bounded,
    cos,
    dh,
    exp,
    expr,
    for_all,
    gamma,
    h,
    identity,
    implies,
    nonnegative,
    norm_bound,
    positive,
    reals,
    run_proof,
    sin,
    sqrt,
    tanh,
    var,
)
from lyapcheck.claims.procedures import propose
from lyapcheck.verdicts import Verdict
from tests import oracle
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


def contradicts(statement, verdict, proof):
    """Whether the oracle has a reason against a verdict."""
    if verdict == "proved":
        return oracle.objection(statement) is not None
    if hasattr(proof, "part"):
        return contradicts(statement.parts[proof.part][1], verdict, proof.proof)
    point = {name: str(value) for name, value in getattr(proof, "point", ())}
    point |= {"n": str(proof.n)} if hasattr(proof, "n") else {}
    return bool(point) and oracle.confirms(statement, point) is False


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


def words(data, path=()):
    """The places of all names of operations and relations, and of all truth values."""
    if isinstance(data, dict):
        return [place for key, value in data.items() for place in words(value, (*path, key))]
    if isinstance(data, list):
        return [place for k, value in enumerate(data) for place in words(value, (*path, k))]
    return [path] if isinstance(data, bool) or other_words(data) else []


KINDS = (FUNCTIONS, FAMILY, CONSTANTS, ("add", "mul"), ("<", "<="))


def other_words(old):
    """The names that may stand in the same place."""
    if isinstance(old, bool):
        return [not old]
    return [name for kind in KINDS if old in kind for name in kind if name != old]


def survivors(made, changes, places, others):
    """What is accepted after one change and a new digest, and how many changes were refused."""
    refused, survived = 0, []
    for name, certificate in made.items():
        data = json.loads(certificate.text())
        for path in places(data):
            if path[0] not in ("statement", "proof"):
                continue
            for new in others(reduce(getitem, path, data))[:changes]:
                try:
                    forged = read(sealed(changed(data, path, lambda _, new=new: new)))
                    judge(forged)
                except Refused:
                    refused += 1
                    continue
                survived.append((name, path, new, forged))
    return refused, survived


@pytest.mark.slow
def test_with_a_new_digest_it_is_refused_or_still_true(made):
    """The verdicts that survive are judged again by mpmath; most changes to a proof are refused."""
    refused, survived = survivors(made, 5, numbers, other_numbers)
    for name, path, new, forged in survived:
        assert not contradicts(forged.statement, forged.verdict, forged.proof), (name, path, new)
    assert refused > 1000
    assert len(survived) > 250, "changes that keep a statement true must be among them"


@pytest.mark.slow
def test_other_operations_are_refused_or_still_true(made):
    refused, survived = survivors(made, 12, words, other_words)
    for name, path, new, forged in survived:
        assert not contradicts(forged.statement, forged.verdict, forged.proof), (name, path, new)
    assert refused > len(survived) > 100


@pytest.mark.slow
@given(st.data())
def test_published_certificates_do_not_survive_changes_that_matter(published, data):
    certificate = data.draw(st.sampled_from([published[name] for name in sorted(published)]))
    document = json.loads(certificate.text())
    places = [path for path in numbers(document) if path[0] in ("statement", "proof")]
    if not places:
        return
    path = data.draw(st.sampled_from(places))
    choice = data.draw(st.integers(0, 4))
    forged = changed(document, path, lambda old: (other_numbers(old) * 5)[choice])
    try:
        read_back = read(sealed(forged))
        accepted = judge(read_back)
    except Refused:
        return
    assert not contradicts(read_back.statement, accepted.verdict, read_back.proof)


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

EVEN = for_all(expr(0) < 1 + x**2 * exp(x), -1, 3)
TOP = for_all(h(2, x) <= "1.06", 0)
TRANSITIVE = implies(positive("a", "b", "c"), (a < b, b <= var("c")), a < var("c"))
SMALL = ForSmall(
    "eps", positive("a", "b"), (b <= a,), var("t") + var("eps") / (2 - var("eps")) < b - b / 2, ("t",)
)


def small_at(below=1, **at):
    point = {"a": 1, "b": 1, "t": 1} | at
    return SmallWitness(tuple((name, F(value)) for name, value in point.items()), F(below))


PRINTED = agrees(a * b, "100", a="9", b="10")


def boxes(*cuts, zero=False, tail=False, bits=64):
    return Boxes(tuple(map(F, cuts)), zero, tail, bits)


NEAR_ZERO = propose(for_all(tanh(x) < x, 0, 1, open_low=True)).proof


def steps(*multiples, lift=()):
    return SignIdentity(lift, tuple(Multiple(k, F(w), m) for k, w, m in multiples))


FORGED = {
    "a point outside": (for_all(x <= 1, 0, 1), Witness((("x", F(2)),)), "at least 0 and at most 1"),
    "a point at an open end": (
        for_all(x < 1, 0, 1, open_high=True),
        Witness((("x", F(1)),)),
        "at least 0 and below 1",
    ),
    "a point of another variable": (for_all(x <= 1), Witness((("y", F(2)),)), "must give x"),
    "a point with two values": (for_all(x <= 1), Witness((("x", F(2)), ("x", F(0)))), "twice"),
    "a point where it holds": (for_all(x <= 1), Witness((("x", F(1)),)), "not shown to break"),
    "a precision of 1": (for_all(x <= 1), Witness((("x", F(2)),), 1), "bits = 1:"),
    "an endless precision": (for_all(x <= 1), Witness((("x", F(2)),), 10**9), "bits"),
    "a point against a hypothesis": (
        implies(reals("a"), (a <= 1,), a <= 0),
        Witness((("a", F(2)),)),
        "not shown to break",
    ),
    "a point out of range": (
        implies(positive("a"), (), expr(0) <= a),
        Witness((("a", F(-1)),)),
        "must be above 0",
    ),
    "a point at a strict bound": (
        implies(positive("a"), (), expr(0) < a),
        Witness((("a", F(0)),)),
        "must be above 0",
    ),
    "different normal forms": (identity(sin(x), cos(x)), NormalForm(), "not zero"),
    "numbers that are not rational": (Constant(sqrt(2) < "1.5"), ExactNumbers(), "not rational"),
    "balls that touch": (Constant(sqrt(2) * sqrt(2) <= 2), SeparateBalls(128), "too few"),
    "pieces too few": (EVEN, Pieces((boxes(0, 1, 3),)), "must be 2"),
    "pieces too many": (EVEN, Pieces((boxes(0, 3), boxes(0, 1), boxes(0, 1))), "must be 2"),
    "boxes that stop early": (EVEN, Pieces((boxes(0, 1, 2), boxes(0, "1/2", 1))), "leaves out 3"),
    "boxes that start late": (EVEN, Pieces((boxes("1/2", 3), boxes(0, "1/2", 1))), "leaves out 0"),
    "boxes that run back": (EVEN, Pieces((boxes(0, "1/2", "1/4", 3), boxes(0, "1/2", 1))), "must rise"),
    "no cuts": (EVEN, Pieces((boxes(), boxes(0, "1/2", 1))), "cuts = 0"),
    "no cut after 0": (TOP, Pieces((boxes(0, 4, tail=True, zero=True),)), "above 0"),
    "a tail from inside": (TOP, Pieces((boxes(0, "5/4", tail=True),)), "no term dominates"),
    "a tail left out": (TOP, Pieces((boxes(0, 4),)), "leaves out infinity"),
    "a tail left of 1": (TOP, Pieces((boxes(0, "1/2", tail=True),)), "no term dominates"),
    "a box too wide": (for_all(h(2, x) <= "1.06", 0, 3), Pieces((boxes(0, 3),)), "sign is open"),
    "equality at a closed 0": (
        for_all(tanh(x) < x, 0, 1),
        NEAR_ZERO,
        "value at 0",
    ),
    "Sturm at a closed 0": (for_all(expr(0) < x, 0, 1), Pieces((Sturm(),)), "does not show > at 0"),
    "Sturm beyond its reach": (for_all(sin(x) <= 1), Pieces((Sturm(), Sturm())), "does not give the sign"),
    "a supremum that is not the component": (
        norm_bound(2 * h(2, x), 3, sqrt(3) * gamma(2)),
        Supremum(SeparateBalls(128)),
        "is neither",
    ),
    "the supremum of h for h'": (
        norm_bound(dh(2, x), 3, sqrt(3) * gamma(2)),
        Supremum(SeparateBalls(128)),
        "must be proved",
    ),
    "the supremum for a linear bound": (
        norm_bound(h(2, x), 3, sqrt(3) * gamma(2), power=1),
        Supremum(ExactNumbers()),
        "is neither",
    ),
    "a uniform proof of a linear bound": (
        norm_bound(h(1, x), 1, 2, power=1),
        EqualEntries(Pieces((Sturm(), Sturm())), Pieces((Sturm(), Sturm()))),
        "power = 1",
    ),
    "a hypothesis that does not exist": (TRANSITIVE, steps((2, 1, ()), (1, 1, ())), "hypothesis = 2"),
    "a negative index": (TRANSITIVE, steps((-1, 1, ()), (-2, 1, ())), "hypothesis = -1"),
    "a negative weight": (TRANSITIVE, steps((0, -1, ()), (1, 1, ())), "must be positive"),
    "a weight of 0": (TRANSITIVE, steps((0, 0, ()), (1, 1, ())), "must be positive"),
    "a remainder": (TRANSITIVE, steps((0, 2, ()), (1, 1, ())), "remainder"),
    "strictness from nowhere": (
        implies(positive("a", "b", "c"), (a <= b, b <= var("c")), a < var("c")),
        steps((0, 1, ()), (1, 1, ())),
        "remainder",
    ),
    "a multiplier of any sign": (
        implies(reals("a", "b"), (a <= b,), a**2 <= a * b),
        steps((0, 1, ((0, 1),))),
        "may be negative",
    ),
    "a lift of any sign": (
        implies(reals("a", "b"), (), expr(0) <= b),
        steps(lift=((0, 1), (1, 1))),
        "positive monomial",
    ),
    "a lift that may vanish": (
        implies(nonnegative("a") + reals("b"), (expr(0) <= a * b,), expr(0) <= b),
        steps((0, 1, ()), lift=((0, 1),)),
        "positive monomial",
    ),
    "a generator that does not exist": (TRANSITIVE, steps((0, 1, ((99, 1),)), (1, 1, ())), "generator = 99"),
    "small values: no such point": (SMALL, SmallWitness((("a", F(1)),), F(1)), "must give a, b, t"),
    "small values: outside": (SMALL, small_at(a=-1), "a = -1: must be above"),
    "small values: beyond the bounded": (SMALL, small_at(t=2), "t = 2: must be above 0 and at most 1"),
    "small values: where the hypothesis breaks": (SMALL, small_at(b=2), "breaks a hypothesis"),
    "small values: where it holds": (SMALL, small_at(t="1/3"), "does not break the conclusion"),
    "small values: up to nothing": (SMALL, small_at(below=0), "below = 0: must be positive"),
    "small values: a term without a value": (SMALL, small_at(below=3), "is not shown to have a value"),
    "corners of other inputs": (PRINTED, Corners((0,), (1, 1), 128), "0 or 1 for each"),
    "corners on one side": (PRINTED, Corners((0, 0), (0, 0), 128), "below the printed"),
    "not outside": (PRINTED, OutsideRounding(128), "meets the rounding"),
    "Fourier sums too coarse": (
        bounded([sin(x) ** 2 + cos(x) ** 2 + sin(x)], ["1.5"]),
        FourierBounds(),
        "not 3/2",
    ),
    "a sum of angles": (
        bounded([sin(x + var("yz")) - sin(var("xy") + var("z"))], [1]),
        FourierBounds(),
        "outside sin and cos",
    ),
    "an entry that does not exist": (
        always_positive([cos(x)]),
        EntryWitness(1, True, (("x", F(3)),)),
        "entry = 1",
    ),
    "an entry from behind": (always_positive([cos(x)]), EntryWitness(-1, True, (("x", F(3)),)), "entry = -1"),
    "an entry that has no bound": (bounded([cos(x)]), EntryWitness(0, False, (("x", F(0)),)), "no bound"),
    "a part left out": (CASES["all of"], EveryPart((SeparateBalls(128),)), "one proof per part"),
    "a part that holds": (CASES["all of"], OnePart(0, SeparateBalls(128)), "must be refuted"),
    "a part that does not exist": (CASES["not all"], OnePart(-1, SeparateBalls(128)), "part = -1"),
    "a refutation among the parts": (
        CASES["not all"],
        EveryPart((SeparateBalls(128), SeparateBalls(128))),
        "must be proved",
    ),
    "the proof of another kind": (TRANSITIVE, NormalForm(), "kind Implies"),
}


@pytest.mark.parametrize("name", FORGED)
def test_a_forged_proof_is_refused_with_a_reason(name):
    statement, proof, reason = FORGED[name]
    assert reason in refusal(statement, proof)


def test_the_same_proofs_without_the_fault_are_accepted():
    fine = [
        (for_all(x <= 1, 0, 2), Witness((("x", F(2)),))),
        (EVEN, Pieces((boxes(*(F(k, 4) for k in range(13))), boxes(0, "1/2", 1)))),
        (for_all(tanh(x) < x, 0, 1, open_low=True), NEAR_ZERO),
        (TRANSITIVE, steps((0, 1, ()), (1, 1, ()))),
        (PRINTED, Corners((0, 0), (1, 1), 128)),
        (SMALL, small_at()),
        (SMALL, small_at(t="1/2")),
        (CASES["not all"], OnePart(1, SeparateBalls(128))),
    ]
    for statement, proof in fine:
        assert verify(statement, proof).verdict in ("proved", "refuted")


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
