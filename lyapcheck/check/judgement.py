"""What judging one certificate by itself finds, as data that one process hands to another."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from lyapcheck.check.limits import SHOWN
from lyapcheck.check.refusal import plain


@dataclass(frozen=True)
class Judgement:
    """Why a certificate is refused (``reason``), or what it shows; all text but ``claim`` is safe to print.

    ``spent``: judging it came to no end, so that it is neither accepted nor refused.
    ``claim`` is the id as it is written, ``label`` the same to be printed; ``label`` and ``says`` are its
    author's words, ``statement`` is rendered from data, ``shows`` lists (digest, verdict, which part) for the
    statement and the parts of it that the proof decides, ``theorems`` lists (name, where it is proved),
    ``granted`` what the statement takes for granted, ``rules`` lists (rule, its module).
    """

    reason: str = ""
    unreadable: bool = False
    spent: bool = False
    digest: str = ""
    claim: str = ""
    label: str = ""
    says: str = ""
    m: int | None = None
    n: int | None = None
    statement: str = ""
    statement_digest: str = ""
    verdict: str = ""
    grade: str = ""
    uses: dict[str, str] = field(default_factory=dict)
    shows: tuple[tuple[str, str, str], ...] = ()
    theorems: tuple[tuple[str, str], ...] = ()
    granted: tuple[str, ...] = ()
    rules: tuple[tuple[str, str], ...] = ()

    def refused(self, reason: str) -> Judgement:
        """The same, refused."""
        return replace(self, reason=plain(reason))


def shortened(text: str, full: bool) -> str:
    """The text on one line, without what could steer a terminal; unless all is wanted cut in its middle.

    What a statement supposes stands at its end, and a cut is marked as one.
    """
    if full or len(text) <= SHOWN:
        return plain(text)
    return f"{plain(text[: 2 * SHOWN // 3])} … (cut) … {plain(text[-SHOWN // 3 :])}"
