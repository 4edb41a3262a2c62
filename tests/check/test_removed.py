"""Certificates of kinds and rules that were removed are refused with the version that reads them."""

import re

import pytest

from lyapcheck.check.certificate import judged
from lyapcheck.check.codec import LAST_READ_BY, TAGS, from_json, members
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Statement
from tests.arena.run import ARENA
from tests.helpers.command import lyapcheck

REMOVED = sorted((ARENA / "bad").glob("removed.*.json"))


@pytest.mark.parametrize("path", REMOVED, ids=[path.stem for path in REMOVED])
def test_what_an_older_version_wrote_is_refused_with_that_version(path):
    reason = judged(path.read_bytes()).reason
    assert re.search(r"was removed after lyapcheck (0\.[12]\.0); lyapcheck \1 reads it", reason)


@pytest.mark.parametrize("base", [Statement, Proof])
@pytest.mark.parametrize("name", LAST_READ_BY)
def test_each_removed_name_is_refused_as_one_and_an_unknown_name_is_not(base, name):
    assert name not in members(base)
    with pytest.raises(Refused, match=f"was removed after lyapcheck {LAST_READ_BY[name]}; "):
        from_json(base, {TAGS[base]: name}, "it")
    with pytest.raises(Refused, match="that the checker knows"):
        from_json(base, {TAGS[base]: f"{name}!"}, "it")


def test_recheck_says_so():
    result = lyapcheck("recheck", ARENA / "bad" / "removed.ext.settling.json")
    assert result.returncode == 1
    said = "statement.kind = Settling: was removed after lyapcheck 0.1.0; lyapcheck 0.1.0 reads it"
    assert said in " ".join(result.stdout.split())
