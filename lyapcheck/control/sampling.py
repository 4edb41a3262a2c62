"""The loop as a computer runs it, and for which periods gains are shown to be stable on it by (S)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from typing import Any

from lyapcheck.check.kinds.chain import NoTorque, OwnLevers
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import HarmonicSizes
from lyapcheck.check.kinds.sampled import MOST_DELAY, MOST_TAPS, SampledStable, ShortPeriod
from lyapcheck.check.loop.chain import lever_bound, pulls
from lyapcheck.check.loop.field import size_of
from lyapcheck.check.statement import Proof
from lyapcheck.control.gravity import least_along
from lyapcheck.control.judgement import JudgedStatement, judged_statement
from lyapcheck.errors import InputError, Problem, argument_error
from lyapcheck.files.decimals import DECIMAL, decimal_text
from lyapcheck.files.fields import Fields, Notes
from lyapcheck.files.loop import NOTHING, LoopEntry, read_loop
from lyapcheck.robots.dynamics import Chain

ONE = (Fraction(1),)
TIMING = ("longest", "delay", "velocity", "filter", "lowpass", "encoder", "within")
"""What means something with a period only."""


@dataclass(frozen=True)
class LoopRecord:
    """How the controller runs, and what it does not know.

    τ_i = k_pi h(q_di − p_i) − k_vi h(v_i) + ĝ_i(p), held from one reading to the next, p the reading
    ``delay`` samples ago. By differences v = Σ_j f_j (p_{−j} − p_{−j−1})/T with the nominal T.

    Args:
        period: T, s; ``None`` where the controller is taken to be of infinite rate.
        longest: the longest interval between two readings, s; T without jitter.
        delay: whole samples from a reading to the torque that it makes.
        velocity: ``difference`` or ``measured``.
        filter: the taps f_j, the newest first.
        lowpass: cut-off of a first-order filter of the velocity in place of the taps, Hz.
        encoder: counts a turn of every joint; ``None`` for those of the arm.
        unknown_payload: the most at the centre of mass of the last link, unknown to the controller, kg.
        gravity_error: the largest share of the g_i(q) of the arm file, which the controller uses, by which
            that of the real arm may differ.
        within: the largest error at the start, degrees, if stability is to be proved for starts at rest.
    """

    period: Fraction | None = None
    longest: Fraction | None = None
    delay: int = 1
    velocity: str = "difference"
    filter: tuple[Fraction, ...] = ONE
    lowpass: Fraction | None = None
    encoder: int | None = None
    unknown_payload: Fraction = Fraction(0)
    gravity_error: Fraction = Fraction(0)
    within: Fraction | None = None

    @property
    def knows_gravity(self) -> bool:
        """Whether the controller's g(q) is that of the arm."""
        return not self.unknown_payload and not self.gravity_error

    @property
    def stretch(self) -> Fraction:
        """The longest interval over the nominal one."""
        return self.longest / self.period if self.longest is not None and self.period else Fraction(1)

    @property
    def entry(self) -> LoopEntry:
        return LoopEntry(**{one.name: getattr(self, one.name) for one in fields(LoopEntry)})

    @property
    def text(self) -> str:
        """The loop in words: ``2.5 ms, 1 sample late, velocity by differences``."""
        if self.period is None:
            return self.unknown_text
        jitter = self.longest is not None and self.longest > self.period
        longest = f", no interval above {time_text(self.longest or self.period)}" if jitter else ""
        return f"{time_text(self.period)}{longest}, {self.how}"

    @property
    def late(self) -> str:
        """How late a torque goes out, in words."""
        late = "1 sample late" if self.delay == 1 else f"{self.delay} samples late"
        return late if self.delay else "no delay"

    @property
    def how(self) -> str:
        parts = [self.late]
        parts.append("velocity measured" if self.velocity == "measured" else "velocity by differences")
        if self.lowpass is not None:
            parts.append(f"low-pass of {decimal_text(self.lowpass)} Hz")
        elif self.filter != ONE:
            parts.append(f"filter of {len(self.filter)} taps")
        return ", ".join(parts)

    @property
    def unknown_text(self) -> str:
        """What the controller does not know: ``a payload of up to 2 kg``."""
        kg, percent = decimal_text(self.unknown_payload), decimal_text(100 * self.gravity_error)
        parts = [f"a payload of up to {kg} kg"] if self.unknown_payload else []
        parts += [f"gravity wrong by up to {percent} %"] if self.gravity_error else []
        return " and ".join(parts)


UNSAID = LoopRecord()
"""Where nothing is said of the loop: of infinite rate, with all gravity known."""


def exact_only(record: LoopRecord | None) -> str:
    """What an error at rest leaves out where a coarse encoder is stated."""
    return "" if record is None or record.encoder is None else ", with exact readings"


def time_text(seconds: Fraction) -> str:
    """A period exactly: in ms where it is a decimal, else as 1/600 s."""
    text = decimal_text(1000 * seconds)
    return f"{decimal_text(seconds)} s" if "/" in text else f"{text} ms"


def record_of(
    option: LoopEntry = NOTHING, gain_file: LoopEntry = NOTHING, arm: LoopEntry = NOTHING
) -> LoopRecord | None:
    """The loop by all that is said of it: an option goes before the gain file, and that before the arm file.

    Returns:
        ``None`` where nothing is said.

    Raises:
        InputError: an option about timing without any period, or an interval shorter than the period.
    """
    said = option.over(gain_file.over(arm))
    if said == NOTHING:
        return None
    if said.period is None:
        for name in TIMING:
            if getattr(option, name) is not None:
                rule = "means nothing without a period"
                raise argument_error(f"--{name}", "", rule, "add --rate, or rate = … under [loop]")
    elif said.longest is not None and said.longest < said.period:
        rule = f"must not be shorter than the period of {time_text(said.period)}"
        raise argument_error("longest", time_text(said.longest), rule, "give both together")
    result = LoopRecord(**{name: value for name, value in vars(said).items() if value is not None})
    return result if result.longest is not None else replace(result, longest=result.period)


# --- The same from a command line.


def loop_of_options(options: Mapping[str, Any]) -> LoopEntry:
    """What the options of `lyapcheck.cli.parser.LOOP` say, each text as in a file; ``None`` is not given.

    Raises:
        InputError: every option that cannot be used.
    """
    data = {name: _typed(value) for name, value in options.items() if value is not None}
    if "filter" in data:
        data["filter"] = [_typed(word) for word in str(options["filter"]).split(",")]
    notes = Notes("argument", lambda _: None)
    result = read_loop(Fields(data, (), notes))
    if notes.problems:
        raise InputError([_of_option(one, options) for one in notes.problems])
    return result


def loop_words(own: LoopEntry, used: LoopRecord | None) -> list[str]:
    """What a gain file says of the loop as words of a command line, with the values that were used."""
    if used is None:
        return []
    values = {name: getattr(used, name) for name, value in vars(own).items() if value is not None}
    if used.lowpass is not None:
        values.pop("filter", None)
    period, words = values.get("period"), []
    if period is not None and period.numerator == 1:
        values["period"], words = None, ["--rate", str(1 / period)]
    for line in LoopEntry(**values).toml.splitlines()[1:]:
        key, _, value = line.partition(" = ")
        words += [f"--{key.replace('_', '-')}", value.strip('"[]').replace(" ", "")]
    return words


def _of_option(problem: Problem, options: Mapping[str, Any]) -> Problem:
    """What is wrong with a key of ``[loop]``, said of the option that has its name and of what was typed."""
    key, _, _ = problem.key.partition("[")
    option = f"--{key.replace('_', '-')}"
    begin, of_file, value = problem.repair.partition(f"write {key} = ")
    repair = f"{begin}write {option} {value.replace(chr(34), '')}" if of_file else begin
    return replace(problem, key=option, value=str(options[key]).strip(), repair=repair)


def _typed(value: Any) -> Any:
    text = value.strip() if isinstance(value, str) else ""
    if not DECIMAL.fullmatch(text):
        return value
    number = Fraction(text)
    return int(number) if number.denominator == 1 else number


# --- What shows (S), and for which periods (S) holds.


def require_sampled(loop: LoopRecord, angles: str = "unwrapped") -> LoopRecord:
    """A loop of which (S) speaks, with the angles as readings give them.

    Raises:
        ValueError: (S) does not speak of such a loop; it says what to do.
    """
    taps, whole = loop.filter, f"must be whole samples to {MOST_DELAY}; round it up"
    few = isinstance(taps, tuple) and 1 <= len(taps) <= MOST_TAPS
    cut = f"must be 1 to {MOST_TAPS} weights of differences; cut one off that never ends"
    measured = 'needs the inertia and is not covered; take velocity = "difference"'
    wrapped = "jump by a turn and are not covered; add the turns, as |Δq| < π in a sample"
    rules: tuple[tuple[str, object, bool, str], ...] = (
        ("period", loop.period, (loop.period or 0) > 0, "must be positive; give seconds"),
        ("longest", loop.longest, loop.stretch >= 1, "is below the period; give the longest interval"),
        ("delay", loop.delay, loop.delay in range(MOST_DELAY + 1), whole),
        ("filter", taps, few, cut),
        ("velocity", loop.velocity, loop.velocity == "difference", measured),
        ("angles", angles, angles == "unwrapped", wrapped),
    )
    for name, value, fits, rule in rules:
        if not fits:
            raise ValueError(f"{name} = {value} {rule}")
    return loop


def sampled_proof(statement: SampledStable) -> ShortPeriod:
    """What may show a statement by (S): a bound of each torque of gravity, with its proof."""
    chain, rows = Chain(statement.links, statement.fall), []
    for i, bound in enumerate(statement.bounds([Fraction(0)] * statement.n)):
        way: tuple[Fraction, Proof] = Fraction(0), NoTorque()
        if isinstance(bound, GravityBelow):
            sizes = (size_of(torque, statement.parameters) for torque in bound.entries)
            way = sum(sizes, Fraction(0)), HarmonicSizes()
        elif not pulls(statement.links, statement.fall, i, ()):
            along = least_along(chain, i)
            way = lever_bound(statement.links, statement.fall, i, along), OwnLevers(along)
        rows.append(way)
    return ShortPeriod(tuple(k for k, _ in rows), tuple(own for _, own in rows))


def judged_sampled(statement: SampledStable) -> JudgedStatement:
    """What the checker says of gains on a computer, by (S).

    Soundness: that of ``lyapcheck.check.verify``.
    """
    return judged_statement(statement, [sampled_proof(statement)])


def largest_periods(statement: SampledStable) -> list[Fraction]:
    """The supremum of the periods, s, that (S) shows of each joint; not positive where it shows none.

    Soundness: (S) is strict, and linear in T.
    """
    k_g = statement.k_g or sampled_proof(statement).k_g
    still, now = (statement.needed(k_g, T) for T in (Fraction(0), statement.period))
    rows = zip(statement.viscous_min, still, now, strict=True)
    return [statement.period * (b - low) / (high - low) for b, low, high in rows]
