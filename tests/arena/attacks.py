"""Good certificates with values put at some places, under a renewed digest, as whoever means harm would do.

    python -m tests.arena.attacks ext.resting attack.rest-m-zero "no h_0 is known" statement/m=0

writes ``bad/attack.rest-m-zero.json`` from ``good/ext.resting.json``, which must be refused for that reason.
Values are JSON. What is expected follows from the change, never from a checker.
"""

from __future__ import annotations

import copy
import hashlib
import json
import sys
from typing import Any

from tests.arena.run import ARENA

Document = dict[str, Any]
Edits = list[tuple[tuple[str | int, ...], Any]]


def sealed(document: Document) -> Document:
    """The document under the digest of its content."""
    content = {key: value for key, value in document.items() if key != "digest"}
    text = json.dumps(content, sort_keys=True, ensure_ascii=False, separators=(",", ":"))
    return {**content, "digest": hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()}


def encoded(document: Document) -> bytes:
    return (json.dumps(document, sort_keys=True, ensure_ascii=False) + "\n").encode()


def edited(document: Document, edits: Edits) -> Document:
    """A copy with values put at places, under its own digest."""
    changed = copy.deepcopy(document)
    for path, value in edits:
        place: Any = changed
        for step in path[:-1]:
            place = place[step]
        place[path[-1]] = value
    return sealed(changed)


def main(base: str, name: str, why: str, *edits: str) -> None:
    """Write the file, and what is expected of it."""
    placed = [edit.partition("=")[::2] for edit in edits]
    values = [
        (tuple(int(step) if step.isdigit() else step for step in place.split("/")), json.loads(value))
        for place, value in placed
    ]
    good = json.loads((ARENA / "good" / f"{base}.json").read_text(encoding="utf-8"))
    (ARENA / "bad" / f"{name}.json").write_bytes(encoded(edited(good, values)))
    expected = ARENA / "expected.json"
    entries = {one["path"]: one for one in json.loads(expected.read_text(encoding="utf-8"))}
    entries[f"bad/{name}.json"] = {"path": f"bad/{name}.json", "expected": ["refused"], "why": why}
    rows = [entries[path] for path in sorted(entries)]
    expected.write_text(json.dumps(rows, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
