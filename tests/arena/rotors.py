"""Rotor inertia in chains of links: M(q) + diag(J), and what is no such chain.

    python -m tests.arena.rotors

adds them to the arena as it stands.
"""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction as F
from typing import Any

from lyapcheck.check.kinds.chain import ChainAbove, ChainBelow, OfChain, OwnMoments, StorageForms
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import verify
from lyapcheck.constants.storage import storage_proof
from lyapcheck.robots.dynamics import Chain
from tests.arena.attacks import edited, encoded
from tests.arena.extra import LINKS, vector
from tests.arena.library import Added
from tests.arena.plant import ARENA
from tests.arena.truths import certified

TURNED = (replace(LINKS[0], rotor=F(1, 2)), replace(LINKS[1], rotor=F(3)))
POINTS = tuple(replace(link, com=vector(0, 0, 0), rotor=F(1)) for link in LINKS)
"""Without a rotor the second would move no inertia."""
MALFORMED: dict[str, tuple[tuple[Any, ...], Any]] = {
    "written-nothing": (("statement", "links", 0, "rotor"), "0"),
    "negative": (("statement", "links", 0, "rotor"), "-1/2"),
    "of-whom": (("statement", "links", 0, "rotors"), "1"),
    "text": (("statement", "links", 1, "rotor"), 3),
}


def main() -> None:
    """Write the files, and what is expected of them."""
    arena = Added("rot")
    good: list[tuple[str, OfChain, Proof]] = [("moments", ChainAbove(POINTS, F(0)), OwnMoments())]
    for name in ("lambda_min", "lambda_max"):
        shown = storage_proof(Chain(TURNED, vector(1, 0, 0)), name)
        assert shown is not None
        assert isinstance(shown.statement, OfChain)
        assert isinstance(shown.proof, StorageForms)
        good.append((name, shown.statement, shown.proof))
    for name, statement, proof in good:
        accepted = verify(statement, proof)
        content = certified(name, statement, proof, accepted.verdict, accepted.grade)
        arena.add(f"good/{name}.rot.json", content, ["accepted"], "")
    _, low, high = (statement for _, statement, _ in good)
    assert isinstance(low, ChainAbove)
    assert isinstance(high, ChainBelow)
    false = [
        ("without-rotors", replace(low, links=LINKS), good[1][2]),
        ("lighter-rotor", replace(low, links=(TURNED[0], replace(TURNED[1], rotor=F(1)))), good[1][2]),
        ("heavier-rotor", replace(high, links=(TURNED[0], replace(TURNED[1], rotor=F(9)))), good[2][2]),
        ("no-moment", ChainAbove(tuple(replace(link, rotor=F(0)) for link in POINTS), F(0)), OwnMoments()),
    ]
    for name, statement, proof in false:
        content = certified(name, statement, proof, "proved", "enclosure")
        arena.add(f"bad/{name}.rot.json", content, ["refused"], f"another M: {name}")
    whole = json.loads(certified("lambda_max", high, good[2][2], "proved", "enclosure"))
    for name, (place, value) in MALFORMED.items():
        content = encoded(edited(whole, [(place, value)]))
        arena.add(f"bad/form-{name}.rot.json", content, ["refused"], f"no such link: {name}")
    arena.entries.sort(key=lambda entry: entry["path"])
    (ARENA / "expected.json").write_text(json.dumps(arena.entries, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
