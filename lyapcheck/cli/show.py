"""What a command writes: its answer, progress on standard error, and files whole or not at all."""

from __future__ import annotations

import io
import json
import os
import shlex
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar
from dataclasses import replace
from functools import partial
from pathlib import Path
from shutil import get_terminal_size
from time import monotonic
from typing import TYPE_CHECKING, Any

from lyapcheck._types import Progress
from lyapcheck.cli.parser import LOOP
from lyapcheck.errors import InputError, Problem, argument_error
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Document, Section
from lyapcheck.output.escapes import document_text
from lyapcheck.output.text import WIDTH, Depth, View
from lyapcheck.process_tree import pending, try_writing

if TYPE_CHECKING:
    from collections.abc import Mapping

    from lyapcheck.certificate import Certificate
    from lyapcheck.cli.parser import Parser

VIEWING = ("quiet", "verbose", "explain", "color")
_VIEW: ContextVar[View | None] = ContextVar("view", default=None)
SHARED = ("vary", *LOOP, "target", "start")
"""Options that mean the same to every command that has them."""
WRITING = ("certificates", "csv", "plot", "out", "export", "timings")
APART = (*VIEWING, *WRITING, "format", "assumptions", "failed", "all", "kv_share", "damping")
"""Options of a command that it does not need again: what it shows and writes, and of `tune` what no target
goes with."""
RATES = {"--rate", "--period"}
"""Two options for one number."""
OTHERS_NAMED = 8
SUMMARY = "GITHUB_STEP_SUMMARY"
"""The variable by which GitHub names the file that it shows under a job."""
LARGEST_SUMMARY = 1_000_000
"""Bytes; GitHub refuses more than a mebibyte."""
PATIENCE, SILENCE = 2.0, 30.0
"""Seconds before a bar of progress; without a terminal before the first line, and between lines."""


def require_writable(option: str, path: Path) -> None:
    """Refuse a file that could not be written at the end, before the work is done.

    Raises:
        InputError: the directory does not exist, cannot be written or is full, or the path is a directory.
    """
    if path.is_dir():
        raise argument_error(option, path, "is a directory", "name a file")
    if _is_device(path):
        return
    parent = (path.resolve() if path.is_symlink() else path).parent
    if not parent.is_dir():
        raise argument_error(
            option, path, f"there is no directory {parent}", "create it or name another file"
        )
    _require_room(option, path, parent)


def open_folder(option: str, path: Path) -> Path:
    """A directory that can be written, made if need be.

    Raises:
        InputError: there is a file of that name, or the file system refuses or is full.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise argument_error(
            option, path, f"cannot be made ({error.strerror})", "name another directory"
        ) from error
    _require_room(option, path, path)
    return path


def certificate_folder(path: Path | None) -> Path | None:
    """The folder of ``--certificates``, made if need be; ``None`` where the option is not given.

    Raises:
        InputError: as for `open_folder`.
    """
    return None if path is None else open_folder("--certificates", path)


def write_certificates(folder: Path, *groups: Mapping[str, Certificate]) -> None:
    """Write certificates into a folder, each under its name, and note which others are there.

    Raises:
        InputError: one cannot be written.
    """
    made = {name: certificate for group in groups for name, certificate in group.items()}
    for name, certificate in made.items():
        write_whole(folder / name, certificate.text())
    others = sorted(path.name for path in folder.glob("*.json") if path.name not in made)
    if others:
        from lyapcheck.output.escapes import printable

        names = ", ".join(others[:OTHERS_NAMED])
        more = f" and {len(others) - OTHERS_NAMED} more" if len(others) > OTHERS_NAMED else ""
        what = f"{folder} has files that this run did not write, and recheck {folder} judges them, too"
        print(printable(f"note: {what}: {names}{more}"), file=sys.stderr)


def _require_room(option: str, path: Path, folder: Path) -> None:
    try:
        try_writing(folder)
    except OSError as error:
        rule = f"{folder} cannot be written to ({error.strerror})"
        raise argument_error(option, path, rule, "free some space, or name another place") from error


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file in one move: readers see the old file or the new one, never half of it.

    A link stays a link, to a new file; a device or a pipe is written to as it is.

    Raises:
        InputError: the file system refuses.
    """
    import tempfile

    temporary = None
    data = content.encode("utf-8") if isinstance(content, str) else content
    try:
        if _is_device(path):
            path.write_bytes(data)
            return
        target = path.resolve()
        handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
        with pending(temporary):
            with os.fdopen(handle, "wb") as stream:
                stream.write(data)
            mask = os.umask(0)
            os.umask(mask)
            os.chmod(temporary, 0o666 & ~mask)
            os.replace(temporary, target)
    except OSError as error:
        if temporary is not None and os.path.exists(temporary):
            os.unlink(temporary)
        raise argument_error(
            "file", path, f"cannot be written ({error.strerror})", "name another file"
        ) from error


def _is_device(path: Path) -> bool:
    """Whether a file in its place would take something else away: a device, a pipe, a socket."""
    return path.exists() and not path.is_file()


def viewed(parser: Parser, values: dict[str, Any]) -> dict[str, Any]:
    """The values of a command line without those that say how a text is shown, which `show` keeps to.

    Colour is for terminals, unless ``NO_COLOR`` is set; ``--color`` goes before both.
    """
    if "color" in values:
        following = partial(_following, parser, dict(values))
        quiet, verbose, explained, colour = (values.pop(name) for name in VIEWING)
        depth = Depth.QUIET if quiet else Depth.VERBOSE if verbose else Depth.SHORT
        terminal = sys.stdout.isatty()
        plain = os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb"
        coloured = colour == "always" or (colour == "auto" and terminal and not plain)
        width = get_terminal_size().columns if terminal else WIDTH
        depth = Depth.EXPLAINED if explained else depth
        _VIEW.set(View(depth, coloured, width, following, sys.stdout.encoding or "utf-8"))
    return values


def _following(parser: Parser, values: Mapping[str, Any], line: str) -> str:
    """A next command about the same arm, ranges and loop as this one, by the options that both have."""
    from lyapcheck.cli.commands import NAMES, load
    from lyapcheck.cli.parser import Parser

    words = shlex.split(line)
    if len(words) < 2 or words[1] not in NAMES:
        return line
    other = Parser(prog=f"lyapcheck {words[1]}")
    load(words[1]).arguments(other)
    known = {(action.dest, action.metavar) for action in other.actions}
    for action in parser.actions:
        kept = action.dest not in APART if other.prog == parser.prog else action.dest in SHARED
        value = values.get(action.dest)
        given = value not in (None, False, action.default) and action.option_strings
        if not (kept and given and (action.dest, action.metavar) in known):
            continue
        option = action.option_strings[-1]
        if not (RATES if option in RATES else {option}) & set(words):
            each = value if isinstance(value, list) else [value]
            words += [word for one in each for word in ([option] if one is True else [option, str(one)])]
    return shlex.join(words)


def current_view() -> View | None:
    """How the options of the command line have texts shown."""
    return _VIEW.get()


def show(answer: Answer, format: str) -> None:  # noqa: A002
    """An answer in a format; a text as the options of `viewed` say.

    Annotations for GitHub are not the whole answer: that goes to the job's summary, if there is one.
    A fault in the wording does not cost what was computed: the data are written, and the fault is raised.

    Raises:
        InputError: the summary cannot be written.
    """
    try:
        text = answer.written(format, _VIEW.get())
    except Exception:
        sys.stdout.write(_bare(answer))
        sys.stdout.flush()
        raise
    if format == "text":
        sys.stdout.write(text)
    else:
        write_data(text)
    if format == "github" and os.environ.get(SUMMARY):
        _append_summary(os.environ[SUMMARY], answer.document())


def write_data(text: str) -> None:
    """Write what programs read to standard output, in UTF-8 wherever a command runs."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(encoding="utf-8", errors="backslashreplace")
    sys.stdout.write(document_text(text))


def _bare(answer: Answer) -> str:
    """The data of an answer as JSON, whatever is in them."""
    try:
        data: Any = answer.data()
    except Exception:
        data = getattr(answer, "__dict__", None) or list(answer)  # type: ignore[call-overload]
    return json.dumps({"schema": answer.schema, "data": data}, indent=2, default=str, skipkeys=True) + "\n"


def _append_summary(path: str, document: Document) -> None:
    """Add a document to a file; of one that is too large the sections that did not pass, as many as fit."""
    from lyapcheck.output.markdown import render

    text, sections = render(document), [one for one in document.details if isinstance(one, Section)]
    others = [section for section in sections if not section.title.startswith("✓")]
    count = len(others)
    while count and len(text.encode()) > LARGEST_SUMMARY:
        title = f"{document.title}; {count} of {len(others)} that did not pass are shown"
        text = render(replace(document, title=title, details=tuple(others[:count])))
        count //= 2
    try:
        with open(path, "a", encoding="utf-8") as stream:
            stream.write(text)
    except OSError as error:
        raise InputError(
            Problem("environment", None, SUMMARY, path, f"cannot be written ({error.strerror})", "unset it")
        ) from error


# --- Progress on standard error: a bar on a terminal, a few plain lines elsewhere.


@contextmanager
def progress(label: str) -> Iterator[Progress]:
    """Show how far a piece of work has come; yields the function that the work calls to say so.

    What is shown never falls: work that begins anew, with fewer boxes or another ε₀, stays where it was.
    Quick work shows nothing.
    """
    begun, reached, shown = monotonic(), 0.0, None
    terminal = sys.stderr.isatty()
    with ExitStack() as stack:

        def advance(fraction: float, note: str) -> None:
            nonlocal reached, shown
            reached = max(reached, fraction)
            if shown is None and monotonic() - begun >= (PATIENCE if terminal else SILENCE):
                shown = stack.enter_context(_bar(label)) if terminal else _lines(label)
            if shown is not None:
                shown(reached, note)

        yield advance


@contextmanager
def _bar(label: str) -> Iterator[Progress]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    label_column, note_column = TextColumn("{task.description}"), TextColumn("{task.fields[note]}")
    columns = (label_column, BarColumn(), TaskProgressColumn(), TimeElapsedColumn(), note_column)
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(label, total=1.0, note="")
        yield lambda fraction, note: bar.update(task, completed=fraction, note=note)


def _lines(label: str) -> Progress:
    shown_at = -SILENCE

    def advance(fraction: float, note: str) -> None:
        nonlocal shown_at
        if monotonic() - shown_at >= SILENCE:
            print(f"{label}: {round(100 * fraction):3d} % {note}", file=sys.stderr)
            shown_at = monotonic()

    return advance
