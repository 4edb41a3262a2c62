"""Statements as a certificate has them: decided, read again from their text, with parts exchanged."""

import json

from lyapcheck.certificate import to_json
from lyapcheck.check.codec import from_json
from lyapcheck.check.statement import Statement
from lyapcheck.check.verify import verify
from lyapcheck.claims.procedures import propose

OPERATIONS = ("num", "var", "add", "mul", "neg", "pow", "sin", "cos")


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


def trees(value, path=()):
    """All parts of expressions, with their places."""
    if isinstance(value, tuple):
        if value and value[0] in OPERATIONS:
            yield path, value
        for index, part in enumerate(value):
            yield from trees(part, (*path, index))


def put(value, path, new):
    """The same with another part at a place."""
    if not path:
        return new
    first, *rest = path
    return (*value[:first], put(value[first], rest, new), *value[first + 1 :])
