"""The four ε₀ of one gain set, and what is said of them beside the numbers, in a sentence each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.decreasing import Decreasing, StateWitness
from lyapcheck.check.kinds.link_bounds import ChainDecreasing
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.digits import at_least, at_most

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.promise import Promise
    from lyapcheck.robots import RobotModel
    from lyapcheck.search.controlled_arm import ChainProof, DecreaseProof
    from lyapcheck.search.falsify import RisingState
    from lyapcheck.search.weights import Weighted

CERTIFIED, FALSIFIED = "certified", "falsified"
FASTEST = 100
"""rad/s, beyond which no arm turns."""


@dataclass(frozen=True)
class FourEpsilons:
    """The four ε₀ of one gain set. A missing one is ``None``, with its reason in ``reasons``.

    Args:
        gains: the gain set.
        model: the arm.
        published: the end of (18), rounded down.
        scalar: ε₀ of the scalar form, from norms.
        promise: that V falls with the largest ε₀ of which the checker accepted a proof.
        falsified: ε₀ of the witness.
        witness: the state that refutes ``falsified``.
        boxes: how many boxes branch and bound looked at.
        certified_by: which search proposed the proof behind ``certified``.
        proof: behind ``certified``, accepted by the checker.
        scalar_proof: behind ``scalar``, accepted by the checker; ``None`` if it accepted none.
        against: the statement that ``witness`` refutes, and the state with the arm it is a state of.
        weighted: a proof with weights Λ in y = w − εΛh, if the search found one.
        weighted_promise: that V falls with these weights.
        ranges: whether the answer holds for all ranges of the arm, or for its nominal numbers.
        corner: the uncertain numbers of the arm that ``witness`` is about, by name.
        reasons: why a number is missing, and what to try.
        findings: what the numbers say about each other, one sentence each.
        seed: of the sampled states.
        unvaried: the promise at the numbers of the file, if the ranges contain them.
        outside: the numbers whose value in the file lies outside the ranges.
        seconds: how long it took, where that was asked for.
    """

    gains: GainSet
    model: RobotModel
    published: Fraction | None
    scalar: Fraction | None
    promise: Promise | None
    falsified: Fraction | None
    witness: RisingState | None
    boxes: int
    certified_by: str
    proof: DecreaseProof | ChainProof | None = None
    scalar_proof: DecreaseProof | ChainProof | None = None
    against: tuple[Decreasing, StateWitness] | None = None
    weighted: Weighted | None = None
    weighted_promise: Promise | None = None
    ranges: bool = False
    corner: Mapping[str, Fraction] = field(default_factory=dict)
    reasons: Mapping[str, str] = field(default_factory=dict)
    findings: tuple[str, ...] = ()
    seed: int = 0
    unvaried: Promise | None = None
    outside: tuple[str, ...] = ()
    seconds: float | None = None

    @property
    def certified(self) -> Fraction | None:
        """The ε₀ that is promised."""
        return eps0_of(self.promise)

    @property
    def name(self) -> str:
        """Of the gain set."""
        return self.gains.name

    @property
    def m(self) -> int | None:
        """Member of the family, if it has members."""
        return self.gains.m

    @property
    def scalar_grade(self) -> str | None:
        """``enclosure`` where ``scalar`` has a certificate, else ``no certificate``; ``None`` without it."""
        if self.scalar is None:
            return None
        return "no certificate" if self.scalar_proof is None else "enclosure"

    @property
    def arm(self) -> str:
        """The arm, and for which of its values the numbers are where it has ranges."""
        name, numbers = self.model.name, (*self.model.parameters.values(), *self.model.viscous)
        if self.ranges:
            return f"{name}, for all values in its ranges"
        return f"{name}, at its nominal numbers" if any(one.ranged for one in numbers) else name

    @property
    def ratio(self) -> Fraction | None:
        """certified / falsified: 1 would leave nothing open."""
        if self.certified is None or not self.falsified:
            return None
        return self.certified / self.falsified


def eps0_of(promise: Promise | None) -> Fraction | None:
    """The ε₀ that a promise is about."""
    if promise is None:
        return None
    assert isinstance(promise.asked, Decreasing | ChainDecreasing)
    return promise.asked.eps0


def remarks(result: FourEpsilons) -> Iterator[tuple[bool, str]]:
    """Everything else in a sentence each, with whether the short answer has it.

    How the certified number was proved, findings, reasons for missing numbers, weights and the witness.
    """
    promise, witness, weighted = result.promise, result.witness, result.weighted
    if promise is not None or result.boxes:
        way = [] if promise is None else [promise.says(f"certified by {result.certified_by}")]
        if result.proof is not None and result.proof.boxes:
            way.append(f"{_boxes(result.proof.boxes)} judged by the checker")
        way += [f"{_boxes(result.boxes)} looked at by the search"] if result.boxes else []
        yield False, f"{', '.join(way)}."
    if promise is not None and result.unvaried is not None:
        certified, nominal = result.certified or Fraction(0), eps0_of(result.unvaried) or Fraction(1)
        cost = "nothing" if certified >= nominal else f"{at_most(100 * (1 - certified / nominal), 2)} %"
        said = result.unvaried.says(f"at nominal numbers ε₀ = {decimal_text(nominal)} is certified.")
        yield True, f"the ranges cost {cost}: {said}"
    if result.outside:
        yield (
            True,
            f"the file's own value lies outside the range of {', '.join(result.outside)}: nothing here is "
            "about the arm as its file describes it.",
        )
    yield from ((True, f"{finding}.") for finding in result.findings)
    for kind, reason in result.reasons.items():
        what = "no" if getattr(result, kind) is None else "no larger"
        yield kind in (CERTIFIED, "published"), f"{what} {kind} ε₀: {reason}."
    if weighted is not None and result.weighted_promise is not None:
        seen = f"{weighted.states} worst states in the program"
        said = f"with weights, y = w − εΛh, Λ = I is the best that was shown ({seen})."
        if weighted.proof.loop.coupling:
            values = ", ".join(map(decimal_text, weighted.products))
            seen = f"{_boxes(weighted.proof.boxes)}, {seen}"
            said = f"with weights, y = w − εΛh, dV/dt < 0 is proved for ε₀Λ = diag({values}) ({seen})."
        yield True, result.weighted_promise.says(said)
    if witness is not None:
        yield False, f"falsified {witness_text(witness)}."
        speed = max(map(abs, witness.state.w))
        if speed > FASTEST:
            yield (
                False,
                f"No arm reaches the {at_least(speed, 2)} rad/s of that state. "
                "A larger ε₀ may hold in real motions.",
            )
        if result.corner:
            values = ", ".join(f"{name} = {decimal_text(value)}" for name, value in result.corner.items())
            yield False, f"that state is one of the arm with {values}."


def _boxes(count: int) -> str:
    return "1 box" if count == 1 else f"{count} boxes"


def witness_text(witness: RisingState) -> str:
    """The failing state in one line."""
    units = {"q": "rad", "e": "rad", "w": "rad/s"}
    places = ", ".join(
        f"{name} = ({', '.join(map(decimal_text, getattr(witness.state, name)))}) {unit}"
        for name, unit in units.items()
    )
    return f"at {places} with ε₀ = {decimal_text(witness.eps0)}: dV/dt > {at_least(witness.rate)} W"
