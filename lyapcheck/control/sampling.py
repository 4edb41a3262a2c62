"""The loop as a computer runs it: one record of an option, a gain file and an arm file, in this order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from typing import Any

from lyapcheck.errors import InputError, argument_error
from lyapcheck.files.decimals import DECIMAL, decimal_text
from lyapcheck.files.fields import Fields, Notes
from lyapcheck.files.loop import NOTHING, LoopEntry, read_loop

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
    def how(self) -> str:
        late = "1 sample late" if self.delay == 1 else f"{self.delay} samples late"
        parts = [late if self.delay else "no delay"]
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


def time_text(seconds: Fraction) -> str:
    """A period exactly: in ms where it is a decimal, else as 1/600 s."""
    text = decimal_text(1000 * seconds)
    return f"{decimal_text(seconds)} s" if "/" in text else f"{text} ms"


def record_of(
    option: LoopEntry = NOTHING, gain_file: LoopEntry = NOTHING, arm: LoopEntry = NOTHING
) -> LoopRecord | None:
    """The loop by all that is said of it; an option goes before the gain file, and that before the arm file.

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
    given = {name: value for name, value in vars(said).items() if value is not None}
    result = LoopRecord(**given)
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
        raise InputError([replace(one, key=_option(one.key)) for one in notes.problems])
    return result


def _option(key: str) -> str:
    return f"--{key.replace('_', '-')}"


def _typed(value: Any) -> Any:
    text = value.strip() if isinstance(value, str) else ""
    if not DECIMAL.fullmatch(text):
        return value
    number = Fraction(text)
    return int(number) if number.denominator == 1 else number
