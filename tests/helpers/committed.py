"""The certificates that the repository has, as they are written and as they are read."""

import json
from functools import cache
from pathlib import Path

from lyapcheck.check.codec import from_json
from lyapcheck.check.statement import Proof, Statement

ROOT = Path(__file__).parents[2]
FOLDERS = "reports/certificates", "tests/arena/good", "tests/kernel/certificates"


@cache
def texts():
    """All of them by their places."""
    found = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.json"))
    return {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in found}


def certificates(kinds, verdict):
    """Those of statements of some kinds with a verdict, by file; no certificate of another is parsed."""
    result = {}
    for place, content in texts().items():
        if any(f'"{kind}"' in content for kind in kinds):
            data = json.loads(content)
            if data["statement"]["kind"] in kinds and data["verdict"] == verdict:
                result[place] = data
    return result


def read(name):
    """The statement and the proof of a file of the arena."""
    data = json.loads((ROOT / "tests" / "arena" / f"{name}.json").read_text(encoding="utf-8"))
    return from_json(Statement, data["statement"], "statement"), from_json(Proof, data["proof"], "proof")
