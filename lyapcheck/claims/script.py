"""Finding and loading proof scripts."""

from __future__ import annotations

import os
import pickle
import re
import sys
import traceback
from collections.abc import Collection, Iterable
from dataclasses import replace
from difflib import get_close_matches
from functools import lru_cache
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

from lyapcheck.check.refusal import Refused
from lyapcheck.claims.claim import Proof, in_order
from lyapcheck.claims.decision import command, environment
from lyapcheck.claims.handover import Handover, ScriptRequest, read
from lyapcheck.errors import InputError, Problem, nearest
from lyapcheck.extensions import shipped
from lyapcheck.files.reader import SCRIPT, read_bytes
from lyapcheck.process_tree import run_apart, temporary_folder

SHIPPED = ("published.py", "scalar.py", "tracking.py", "asymptotics.py", "every_m.py", "sampled.py")
"""The proof scripts that come with lyapcheck."""

MOST_NEAR = 8
"""How many ids are suggested for one that is only the beginning of them."""
RUNNING = "<run_path>"
"""The name of a script as a module, as ``runpy`` has it."""
_IMPORTED = re.compile(r" \(/[^()]*\)$")


def find_script(name: str) -> Path:
    """The proof script of that path, or the one that comes with lyapcheck under that name.

    Raises:
        InputError: there is no such file.
    """
    path = Path(name)
    if path.suffix.lower() != ".py" and (path.exists() or path.suffix):
        rule = "a proof script is a Python file (.py)"
        raise InputError(Problem(name, None, "PROOF", name, rule, "give the path of a .py file"))
    if os.path.lexists(path):
        return path  # what is no regular file is refused as what it is, where it is read
    own = shipped("proofs") / path.name
    if path.parent in (Path(), Path("proofs")) and own.is_file():
        return own
    repair = "give the path of a proof script, or published.py for the paper's own proof"
    raise InputError(Problem(name, None, "PROOF", name, "no such proof script", repair))


def load_proof(path: Path, shown: str | None = None) -> Proof:
    """The one proof that a script defines.

    Raises:
        InputError: the script has a syntax error, raises, or does not define exactly one proof.
    """
    name = shown or str(path)
    try:
        names = _run_once(path, read_bytes(path, SCRIPT, name))
    except SyntaxError as error:
        raise InputError(
            Problem(name, error.lineno, "script", "", f"is not Python: {error.msg}", "correct the syntax")
        ) from error
    except InputError:
        raise
    except BaseException as error:  # a script must not choose the exit code
        repair = repair_of(error, "correct the script")
        raise InputError(Problem(name, line_of(error, path), "script", "", raised(error), repair)) from error
    proofs = {id(value): value for value in names.values() if isinstance(value, Proof)}
    if len(proofs) != 1:
        rule = f"a script defines exactly one Proof, this one has {len(proofs)}"
        raise InputError(Problem(name, None, "script", "", rule, 'write proof = Proof("name", "title") once'))
    return next(iter(proofs.values()))


def companion(script: str) -> SimpleNamespace:
    """Load the names of another proof script, for example ``companion("every_function.py").h_of``.

    Args:
        script: a path, or the name of a script that comes with lyapcheck.
    """
    path = find_script(script)
    return SimpleNamespace(**_run_once(path, read_bytes(path, SCRIPT)))


@lru_cache(maxsize=64)
def _run_once(path: Path, content: bytes) -> dict[str, Any]:
    """What a script of that text defines; anew where its text has changed.

    It is a module while it runs: dataclasses look theirs up.
    """
    module = ModuleType(RUNNING)
    module.__file__ = str(path)
    before = sys.modules.get(RUNNING)
    sys.modules[RUNNING] = module
    try:
        exec(
            compile(content, str(path), "exec", dont_inherit=True), vars(module)
        )  # a proof script is a program # nosec B102
    finally:
        if before is None:
            sys.modules.pop(RUNNING, None)
        else:
            sys.modules[RUNNING] = before
    return dict(vars(module))


def line_of(error: BaseException, path: Path) -> int | None:
    """The line of a script at which an error was raised, as far as it goes through it."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
    return frames[-1].lineno if frames else None


def raised(error: BaseException) -> str:
    """What a script raises, in words; without the path of a module on this machine."""
    return f"raises {type(error).__name__}: {_IMPORTED.sub('', str(error))}"


def repair_of(error: BaseException, otherwise: str) -> str:
    """What may mend a script: the nearest name that there is, where one was misspelt."""
    if isinstance(error, AttributeError) and error.name is not None:
        known = [name for name in dir(error.obj) if not name.startswith("_")]
        return nearest(error.name, known, f"it has {', '.join(known)}" if known else otherwise)
    if isinstance(error, ImportError) and error.name in sys.modules:
        wanted = str(error).split("'")[1:2]
        return nearest("".join(wanted), dir(sys.modules[error.name]), otherwise)
    return otherwise


def check_ids(known: Collection[str], ids: Iterable[str], file: str) -> None:
    """Complain about every id that the proof does not have, with those that begin alike, or the nearest.

    Raises:
        InputError: some id is unknown.
    """
    problems = []
    for wanted in ids:
        if wanted not in known:
            begun = [one for one in known if one.casefold().startswith(wanted.casefold())] if wanted else []
            near = begun[:MOST_NEAR] or get_close_matches(wanted, dict.fromkeys(known), n=3, cutoff=0.5)
            hint = f"did you mean {', '.join(near)}? " if near else ""
            repair = f"{hint}lyapcheck explain lists the ids, with --proof those of one script"
            problems.append(Problem(file, None, "id", wanted, "no claim has this id", repair))
    if problems:
        raise InputError(problems)


# --- Asking a proof script for its statements, without running it in this process.


MAX_BYTES = 400_000_000
STANDARD_ERROR = 2


def ask(request: ScriptRequest) -> Handover:
    """What a script hands over; it is over, with all it has started, when this returns.

    Soundness: nothing comes back but claims in words and statements as data, which are read strictly.

    Raises:
        InputError: the script cannot be used, or hands over something else.
    """
    with temporary_folder() as folder:
        answer = Path(folder, "answer.json")
        words = command("lyapcheck.claims.script_process")
        asked = pickle.dumps(replace(request, answer=str(answer)))
        code = run_apart(words, asked, STANDARD_ERROR, environment())
        handover = _read(answer, request, code)
    if handover.problems:
        raise InputError([Problem(*problem) for problem in handover.problems])
    claims = {claim.id: claim for claim in handover.claims}
    check_ids(claims, request.only, request.shown)
    in_order(claims, request.shown)
    return handover


def _read(answer: Path, request: ScriptRequest, code: int) -> Handover:
    try:
        ending = f"exit code {code}" if code >= 0 else f"signal {-code}"
        if code or not answer.is_file():
            raise Refused("process", ending, "must end with its claims handed over")
        size = answer.stat().st_size
        if size > MAX_BYTES:
            raise Refused("answer", f"{size} bytes", f"must not exceed {MAX_BYTES}")
        return read(answer.read_text(encoding="utf-8"), len(request.asked) + len(request.others))
    except (Refused, ValueError, RecursionError) as error:
        rule = f"does not hand over its claims ({error})"
        raise InputError(Problem(request.shown, None, "script", "", rule, "correct the script")) from error
