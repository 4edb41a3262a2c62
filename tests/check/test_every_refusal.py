"""Each refusal of the checker, and a certificate of the arena that comes to it.

``refusals.json`` names for each place a file of the arena that is refused there. After a change of the
checker: python -m tests.check.test_every_refusal
"""

import json
import sys
from pathlib import Path

import pytest

from lyapcheck.check.certificate import MAX_BYTES, judged, parse
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.kinds.identity import Identity, NormalForm
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from tests.arena.run import ARENA
from tests.helpers.refusals import places, recorded

SEEN_AT = Path(__file__).with_name("refusals.json")
BY_THE_STACK = {"bad/door.985-lists.json", "bad/door.lists-in-a-digest.json"}
"""Too deep for Python's reader or for the rule after it, by how deep the stack is already."""
SECOND_LINE = {
    "kinds/link_bounds.py LinkBounds.require_shown: 'must be positive, M = Mᵀ'",
    "kinds/decreasing.py by_posture: 'must be refuted'",
    "kinds/stability.py by_argument: 'must be a point at which all conditions hold'",
    "kinds/for_all.py _shown: 'is not known'",
    "kinds/for_small.py sign_for_small: 'must be one'",
}
"""Where nothing comes today, since something before it refuses: rules that may be used by others one day."""


def nested(operation, inner, *before):
    """An operation on itself, deeper than an expression may be."""
    for _ in range(301):
        inner = (operation, *before, inner)
    return inner


def refused_as_objects():
    """What no file can bring about, since reading it refuses first; a script could."""
    one = ("num", "1")
    statements = (
        Identity(nested("neg", one), one),
        EveryN(("dot", ("vec", "z"), nested("scale", ("vec", "z"), one)), ("num", "0"), (), (), ()),
    )
    said = []
    for statement in statements:
        with pytest.raises(Refused) as refused:
            verify(statement, NormalForm())
        said.append(str(refused.value))
    with pytest.raises(Refused) as refused:
        parse(" " * (MAX_BYTES + 1))
    return [*said, str(refused.value)]


def test_what_is_refused_for_a_reason_is_refused_for_that_reason():
    """The certificates ``refused.*`` and ``border.*`` of the arena, which says words of the reason."""
    every = json.loads((ARENA / "expected.json").read_text())
    rows = [row for row in every if row["path"].startswith(("bad/refused.", "bad/border."))]
    assert len(rows) > 230
    said = {row["path"]: judged((ARENA / row["path"]).read_bytes()).reason for row in rows}
    assert [row for row in rows if row["why"] not in said[row["path"]]] == []


def test_what_no_file_brings_about_is_refused_too():
    said = refused_as_objects()
    assert [words in text for words, text in zip(("deeper", "deeper", "is above"), said, strict=True)]


@pytest.mark.slow
def test_each_place_at_which_the_checker_refuses_has_been_come_to():
    with recorded() as seen:
        for path in set(json.loads(SEEN_AT.read_text(encoding="utf-8")).values()):
            judged((ARENA / path).read_bytes())
        refused_as_objects()
    assert set(places().values()) - seen == SECOND_LINE


def main():
    """Name for each place the smallest file of the arena that is refused there."""
    known = {*(ARENA / "bad").rglob("*.json")} - {ARENA / name for name in BY_THE_STACK}
    result = {}
    for path in sorted(known, key=lambda path: (path.stat().st_size, path.as_posix())):
        with recorded() as seen:
            judged(path.read_bytes())
        result = dict.fromkeys(seen, path.relative_to(ARENA).as_posix()) | result
    text = json.dumps(result, indent=1, sort_keys=True, ensure_ascii=False)
    SEEN_AT.write_text(f"{text}\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
