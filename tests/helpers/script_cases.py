"""A proof script as it is shipped, its verdicts, and copies of it with something replaced."""

from pathlib import Path

from lyapcheck.claims import run_proof
from lyapcheck.claims.script import find_script


def verdicts(path, only=(), ms=(2,), **options):
    """The verdict of each claim of a script, by id."""
    rows = run_proof(path, ms=ms, only=only, **options).claims
    return {row.id: row.verdict.value for row in rows}


def rewriter(name, folder):
    """Writes a shipped script with one passage, which must be there, replaced by another."""
    source = Path(find_script(name)).read_text(encoding="utf-8")

    def write(right, wrong):
        assert right in source
        path = folder / "altered.py"
        path.write_text(source.replace(right, wrong), encoding="utf-8")
        return path

    return write
