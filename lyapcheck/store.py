"""What is kept in the user's cache between runs: found again by its key, checked to be whole, never trusted.

A kept file is its content followed by the SHA-256 of that, written beside its place and moved there in one
step: a killed run leaves no half file, and a damaged one is not found. Keys of answers are digests of the
question, of the versions behind it and of the source of lyapcheck itself, so that another version asks anew.
Answers that hold verdicts are taken through `lyapcheck.store`, which has their certificates judged again.
"""

from __future__ import annotations

import gzip
import hashlib
import json
import os
import stat
import tempfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, TypeVar

from lyapcheck.certificate import Certificate
from lyapcheck.check import certificate as read
from lyapcheck.check.certificate import certificate_of, judge
from lyapcheck.check.refusal import Refused
from lyapcheck.computing import shared_between
from lyapcheck.extensions import shipped
from lyapcheck.process_tree import pending

OFF = "LYAPCHECK_NO_STORE"
"""Set in the environment, so that worker processes know it too, where nothing is to be taken or kept."""
ANSWERS = "answers"
BEHIND = ("lyapcheck", "casadi", "clarabel", "cvxpy", "matplotlib", "numpy", "python-flint", "scipy", "sympy")
LARGEST = 200_000_000
"""Bytes of a kept file."""
_DIGEST = hashlib.sha256().digest_size


def off() -> bool:
    """Whether nothing is to be taken or kept."""
    return bool(os.environ.get(OFF))


def home() -> Path:
    """$XDG_CACHE_HOME/lyapcheck, or the same in ~/.cache."""
    given = os.environ.get("XDG_CACHE_HOME", "")
    base = Path(given) if given and Path(given).is_absolute() else Path("~/.cache").expanduser()
    return base / "lyapcheck"


def kept(kind: str, name: str) -> bytes | None:
    """The content of a kind kept under a name, if it is there, ours alone to write, and whole."""
    try:
        content = _content(home() / kind / name)
    except (OSError, RuntimeError):
        return None
    body, digest = content[:-_DIGEST], content[-_DIGEST:]
    return body if body and hashlib.sha256(body).digest() == digest else None


def keep(kind: str, name: str, body: bytes) -> Path | None:
    """Put a content under its name in one step; none if the cache cannot be written."""
    try:
        folder = home() / kind
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not _private(folder.stat()):
            return None
        return _write(folder, body + hashlib.sha256(body).digest()).replace(folder / name)
    except (OSError, RuntimeError):
        return None


def take(question: Mapping[str, Any]) -> Any | None:
    """The answer kept for a question, as plain data; none if there is none, or it is damaged."""
    if off():
        return None
    body = kept(ANSWERS, key_of(question))
    try:
        return None if body is None else json.loads(gzip.decompress(body))
    except (OSError, ValueError, EOFError):
        return None


def put(question: Mapping[str, Any], answer: Any) -> None:
    """Keep the answer to a question, plain data; without a word where that is not possible."""
    if not off():
        text = json.dumps(answer, ensure_ascii=False, separators=(",", ":"))
        keep(ANSWERS, key_of(question), gzip.compress(text.encode(), 3, mtime=0))


def key_of(question: Mapping[str, Any]) -> str:
    """The digest of a question, plain data, with all that an answer depends on besides."""
    text = json.dumps(question, sort_keys=True, ensure_ascii=False, separators=(",", ":"))
    return exact(text, made_with())


def made_with() -> str:
    """The digest of what answers rest on besides their question: lyapcheck and the packages behind it."""
    return exact(source_digest(), _versions())


@cache
def _versions() -> tuple[tuple[str, str], ...]:
    """Of each package, empty where it is not installed."""
    known = {}
    for name in BEHIND:
        with suppress(PackageNotFoundError):
            known[name] = version(name)
    return tuple((name, known.get(name, "")) for name in BEHIND)


def exact(*subjects: object) -> str:
    """The digest of what some objects show of themselves, such as arms and gains all their exact numbers."""
    return hashlib.sha256(_spelled(subjects).encode("utf-8", "surrogatepass")).hexdigest()


def _spelled(subject: Any) -> str:
    """All fields of a record and of its parts, whatever its own ``repr`` leaves out."""
    if is_dataclass(subject) and not isinstance(subject, type):
        known = [(one, getattr(subject, one.name)) for one in fields(subject) if one.repr]
        kept = [(one.name, value) for one, value in known if value or not one.metadata.get("left_out")]
        inner = ", ".join(f"{name}={_spelled(value)}" for name, value in kept)
        return f"{type(subject).__qualname__}({inner})"
    if type(subject) is tuple:
        return f"({', '.join(map(_spelled, subject))}{',' if len(subject) == 1 else ''})"
    if type(subject) is list:
        return f"[{', '.join(map(_spelled, subject))}]"
    if type(subject) is dict:
        return f"{{{', '.join(f'{_spelled(key)}: {_spelled(value)}' for key, value in subject.items())}}}"
    return repr(subject)


@cache
def source_digest() -> str:
    """Of every file of lyapcheck and of the proofs that come with it."""
    whole = hashlib.sha256()
    for root in (Path(__file__).parent, shipped("proofs")):
        for path in sorted(root.rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                whole.update(
                    f"{path.relative_to(root)}\n".encode() + hashlib.sha256(path.read_bytes()).digest()
                )
    return whole.hexdigest()


def _write(folder: Path, content: bytes) -> Path:
    """A new file that only this user can read, gone again if it cannot be written to its end."""
    handle, name = tempfile.mkstemp(dir=folder, prefix=".new-")
    try:
        with pending(name), os.fdopen(handle, "wb") as file:
            file.write(content)
    except OSError:
        Path(name).unlink(missing_ok=True)
        raise
    return Path(name)


def _content(path: Path) -> bytes:
    """The bytes of a kept file; none of one that is no file of ours alone, or a link.

    Looked at by the descriptor that is read: nothing can take its place in between.

    Raises:
        OSError: it is not there.
    """
    flags = [getattr(os, name, 0) for name in ("O_NONBLOCK", "O_NOFOLLOW", "O_CLOEXEC", "O_BINARY")]
    if not _private(path.parent.stat()):
        return b""
    with os.fdopen(os.open(path, os.O_RDONLY | sum(flags)), "rb") as file:
        status = os.fstat(file.fileno())
        whole = _private(status) and stat.S_ISREG(status.st_mode) and status.st_size <= LARGEST
        return file.read(LARGEST) if whole else b""


def _private(status: os.stat_result) -> bool:
    """Whether only this user can change it: what is kept here is run and shown."""
    mine = not hasattr(os, "getuid") or status.st_uid == os.getuid()
    return mine and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


# --- Answers between runs: certificates by the digest of what was asked, judged again when they are taken.
#
# A certificate that the checker does not accept, or that is about another thing than what is asked now,
# makes the whole answer unknown: it is computed anew. Plain data beside the certificates say how they were
# found, and decide nothing.

T = TypeVar("T")
BROKEN = (Refused, AttributeError, KeyError, TypeError, ValueError, ZeroDivisionError)
"""What comes of data that another program, or another person, has written."""


@dataclass(frozen=True)
class KeptCertificates:
    """An answer as it is kept.

    Args:
        certificates: by name, what the answer rests on.
        beside: plain data.
    """

    certificates: Mapping[str, read.Certificate]
    beside: Mapping[str, Any] = field(default_factory=dict)


def remembered(
    question: Mapping[str, Any],
    rebuilt: Callable[[KeptCertificates], T | None],
    compute: Callable[[], T],
    written: Callable[[T], KeptCertificates | None],
    jobs: int = 1,
) -> T:
    """The answer to a question: from what is kept, where that holds, else computed now and kept.

    Args:
        question: plain data.
        rebuilt: the answer from accepted certificates; ``None`` where they are not about what is asked.
        compute: the answer.
        written: an answer as it is kept; ``None`` where it is not worth it.
        jobs: processes that may share a certificate.
    """
    if off():
        return compute()
    result = _taken(question, rebuilt, jobs)
    if result is None:
        result = compute()
        if (one := written(result)) is not None:
            texts = {name: Certificate.of(each).text() for name, each in one.certificates.items()}
            put(question, {"certificates": texts, "beside": one.beside})
    return result


def _taken(
    question: Mapping[str, Any], rebuilt: Callable[[KeptCertificates], T | None], jobs: int
) -> T | None:
    answer = take(question)
    if answer is None:
        return None
    try:
        texts: dict[str, str] = answer["certificates"]
        found = {name: certificate_of(text.encode())[0] for name, text in texts.items()}
        with shared_between(jobs):
            for one in found.values():
                judge(one)
        return rebuilt(KeptCertificates(found, answer["beside"]))
    except BROKEN:
        return None
