"""Where the paper is not confirmed, computed from the results."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from lyapcheck.report.model import Data, Finding
from lyapcheck.report.text import witness_words
from lyapcheck.report.words import answer_words, beside_words, hangs_words, quantity_words, together_words

SAME = 0.02
"""An index of the nominal arm this close to the printed one, relatively, counts as confirmed."""


def findings(
    claims: Sequence[Data],
    gate: Sequence[Data],
    epsilon: Sequence[Data],
    sensitivity: Data | None = None,
) -> tuple[Finding, ...]:
    """All findings: refuted claims first, then rejected gains, ε₀, and the experiment."""
    experiment = () if sensitivity is None else _experiment(sensitivity)
    return (*_refuted(claims), *_rejected(gate), *_epsilons(epsilon), *experiment)


def _refuted(claims: Sequence[Data]) -> Iterator[Finding]:
    """One finding a claim, for all m at which it is refuted."""
    refuted: dict[str, list[Data]] = {}
    for row in claims:
        if row["verdict"] == "refuted":
            refuted.setdefault(row["id"], []).append(row)
    for claim_id, rows in refuted.items():
        first = rows[0]
        ms = tuple(row["m"] for row in rows if row["m"] is not None)
        text = f"“{first['comment']}”: {witness_words(first)}"
        yield Finding(f"claim {claim_id}", ms, text, first["verdict"])


def _rejected(gate: Sequence[Data]) -> Iterator[Finding]:
    for result in gate:
        deciding = [check for check in result["checks"] if check["id"] in result["deciding"]]
        broken = [check for check in deciding if check["message"]]
        if result["verdict"] == "rejected" and result["m"] is not None and broken:
            first, rest = broken[0]["message"], len(broken) - 1
            more = f" (and {rest} more)" if rest else ""
            yield Finding(f"gains {result['name']}", (result["m"],), first + more, result["verdict"])


def _epsilons(epsilon: Sequence[Data]) -> Iterator[Finding]:
    for row in epsilon:
        if row["m"] is None:
            continue
        published, falsified, certified = row["published"], row["falsified"], row["certified"]
        if published is None:
            proved = f"; even so dV/dt < 0 is proved with ε₀ = {float(certified):.4g}" if certified else ""
            text = f"the interval (18) for ε₀ is empty, because (19) fails{proved}"
            yield Finding(f"ε₀ of {row['name']}", (row["m"],), text, "empty")
        elif falsified is not None and float(published) > float(falsified):
            text = (
                f"(18) allows ε₀ up to {float(published):.4g}, but dV/dt > 0 at a state found for "
                f"ε₀ = {float(falsified):.4g}"
            )
            yield Finding(f"ε₀ of {row['name']}", (row["m"],), text, "contradicted")


def _experiment(study: Data) -> Iterator[Finding]:
    """What the bench does with the nominal arm, and whether any assumed arm does what is printed."""
    for one in study["sets"]:
        ms = () if one["m"] is None else (one["m"],)
        for number in one["numbers"]:
            text = _apart(number, study)
            if text:
                yield Finding(f"{quantity_words(number)} of {one['name']}", ms, text, "differs")
    if study["together"] and study["together"]["worst"] > SAME:
        yield Finding("indices of all gains", (), together_words(study), "differs")


def _apart(number: Data, study: Data) -> str:
    """Empty where the nominal arm is near what is printed, and for torques: these are claims of the paper."""
    if number["quantity"] == "L2" and abs(number["nominal"] / number["printed"] - 1) > SAME:
        return f"{beside_words(number)}; {hangs_words(number, study)}; {answer_words(number)}"
    if number["quantity"] in ("settling", "final_error") and number["answer"] == "no":
        return f"{beside_words(number)}; {answer_words(number)}"
    return ""
