"""Certificates: what is written is what is read, and each proof shows its own statement alone.

What must be refused, and for which reason, has its files in the arena.
"""

import pytest

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About, judge, parse, read
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.claims import all_of, run_proof, var
from lyapcheck.claims.procedures import propose
from lyapcheck.verdicts import Verdict
from tests.claims.test_claims import PROVED, REFUTED

pytestmark = pytest.mark.usefixtures("in_this_process")

x, y, a, b = map(var, "xyab")
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


def test_the_precision_outside_does_not_matter():
    from flint import ctx

    certificate = certificate_of(PROVED["√3 > 1 is known"])
    for bits in (10, 53, 1000):
        with ctx.workprec(bits):
            assert judge(certificate).verdict == "proved"
