"""Statements as a certificate has them: decided, and read again from their text."""

import json

from lyapcheck.certificate import to_json
from lyapcheck.check.codec import from_json
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Statement
from lyapcheck.check.verify import verify
from lyapcheck.claims.procedures import propose


def verdict(statement):
    """What the search says, which the checker says too of what is read."""
    result = propose(statement)
    again = from_json(Statement, json.loads(json.dumps(to_json(statement))), "statement")
    assert again == statement
    if result.proof is not None:
        assert verify(again, result.proof).verdict == result.verdict.value
    return result.verdict.value


def why(statement):
    """Why it is not proved."""
    result = propose(statement)
    assert result.verdict.value != "proved"
    return result.reason


def outcome(statement, proof):
    """What the checker says of a proof: its verdict, or that it is refused."""
    try:
        return verify(statement, proof).verdict
    except Refused:
        return "refused"
