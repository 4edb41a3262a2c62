"""The certificates that the repository has, as they are written."""

import json
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLDERS = "reports/certificates", "tests/arena/good", "tests/kernel/certificates"


def certificates(kinds, verdict):
    """Those of statements of some kinds with a verdict, by file; no certificate of another is parsed."""
    result = {}
    for path in sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.json")):
        content = path.read_text(encoding="utf-8")
        if any(f'"{kind}"' in content for kind in kinds):
            data = json.loads(content)
            if data["statement"]["kind"] in kinds and data["verdict"] == verdict:
                result[path.relative_to(ROOT).as_posix()] = data
    return result
