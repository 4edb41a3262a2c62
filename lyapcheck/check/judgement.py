"""What judging one certificate by itself finds, as data that one process hands to another."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from lyapcheck.check.refusal import plain

# --- What reading and judging one certificate may cost.

MAX_BYTES = 50_000_000
"""Of a file."""
MAX_NESTING = 400
"""Levels of objects and lists; an expression may have 300 of them."""
MAX_ARM = 9
"""Joints of an arm."""
MOST_CORNERS = 256
"""Of the ranges of an arm's parameters."""
LARGEST = 10**9
"""rad, rad/s, N·m and J: beyond all that is of use."""
SHOWN = 300
"""Characters of a statement, or of its author's words, unless the whole is asked for."""
MOST = 1_000_000
"""Seconds or MiB, beyond which a limit is none."""


@dataclass(frozen=True)
class Limits:
    """Seconds of computing time and MiB that the process may take which judges a certificate."""

    seconds: int = 600
    memory: int = 4096


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
        return replace(self, reason=plain(reason))


def shortened(text: str, full: bool) -> str:
    """The text on one line, without what could steer a terminal; unless all is wanted cut in its middle.

    What a statement supposes stands at its end, and a cut is marked as one.
    """
    if full or len(text) <= SHOWN:
        return plain(text)
    return f"{plain(text[: 2 * SHOWN // 3])} … (cut) … {plain(text[-SHOWN // 3 :])}"


TORQUE = (
    "the torque is (6), τ = K_p h(e) − K_v h(w) + g(q) with e = q_d − q, w = q̇ and a constant q_d, applied "
    "as it is, and (6) knows g(q) exactly; (11) is M(q)q̈ + C(q,q̇)q̇ + Bq̇ + g(q) = τ with it"
)
"""What statements about the closed loop (11) with numbers take for granted of the torque."""
