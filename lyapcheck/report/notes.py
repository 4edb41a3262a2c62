"""What a published proof prints and argues, in words: read from the file beside its script."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from lyapcheck.control.gains import proofs_folder


@dataclass(frozen=True)
class Paper:
    """The text that a proof script is about."""

    authors: str
    title: str
    source: str
    theorem: str
    controller: str

    @property
    def citation(self) -> str:
        """In one line."""
        return f"{self.authors}, {self.title}, {self.source}"


@dataclass(frozen=True)
class Box:
    """A step of the proof, or of the way round: as good as the worst of its claims."""

    label: str
    title: str
    claims: tuple[str, ...]
    proof: str = "published"
    after: str = ""


@dataclass(frozen=True)
class Note:
    """What the text argues where claims fail, why that is wrong, and what mends it; formulas in LaTeX.

    ``mended`` are the claims that show that the repair does.
    """

    claims: tuple[str, ...]
    title: str
    printed: str = ""
    argument: str = ""
    fails: str = ""
    consequence: str = ""
    repair: str = ""
    mended: tuple[str, ...] = ()
    figure: str = ""


@dataclass(frozen=True)
class Notes:
    """All that the file says.

    Args:
        paper: the text.
        chain: its proof from left to right.
        route: the way round what is broken.
        findings: notes on claims that may fail; one whose claims hold is not shown.
        equations: LaTeX of the numbered formulas.
        titles: of claims, in a few letters, for the graph.
        known: what was known before the paper, and what is new: a sentence, then paragraphs.
        own: by proof the claims about an arm and gains, for reports on others than the paper's.
    """

    paper: Paper
    chain: tuple[Box, ...]
    route: tuple[Box, ...]
    findings: tuple[Note, ...]
    equations: Mapping[str, str]
    titles: Mapping[str, str]
    known: tuple[str, ...]
    own: Mapping[str, tuple[str, ...]]


def published_notes() -> Notes:
    """Those on the paper."""
    result = tomllib.loads((proofs_folder() / "published.toml").read_text(encoding="utf-8"))
    return Notes(
        paper=Paper(**result["paper"]),
        chain=tuple(_box(one) for one in result["chain"]),
        route=tuple(_box(one) for one in result["route"]),
        findings=tuple(_note(one) for one in result["findings"]),
        equations=result["equations"],
        titles=result["titles"],
        known=(result["known"]["short"], *result["known"]["text"]),
        own={proof: tuple(ids) for proof, ids in result["own"].items()},
    )


def _note(data: dict[str, Any]) -> Note:
    return Note(**data | {name: tuple(data.get(name, ())) for name in ("claims", "mended")})


def _box(data: dict[str, str]) -> Box:
    return Box(**data | {"claims": tuple(data["claims"])})  # type: ignore[arg-type]
