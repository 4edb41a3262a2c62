"""Certificates: what is written is what is read, and each proof shows its own statement alone.

What must be refused, and for which reason, has its files in the arena.
"""

from fractions import Fraction

import pytest

from lyapcheck.certificate import Certificate, to_json
from lyapcheck.check.certificate import About, judge, parse, read
from lyapcheck.check.codec import from_json
from lyapcheck.check.kinds.all_of import EveryPart
from lyapcheck.check.kinds.for_all import Boxes, Pieces, Sturm
from lyapcheck.check.kinds.identity import NormalForm
from lyapcheck.check.kinds.implies import Multiple, SignIdentity
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Relation, Total
from lyapcheck.check.verify import verify
from lyapcheck.claims import all_of, expr, implies, positive, run_proof, var
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


def test_a_proof_of_something_else_shows_nothing_false(made):
    """Every proof against every statement of the tables: accepted only with the right verdict."""
    for name, own in made.items():
        for other in made.values():
            try:
                accepted = verify(own.statement, other.proof)
            except Refused:
                continue
            assert accepted.verdict == own.verdict, name


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
