"""A gain set on an arm as C99, its torque in balls, and a bound of what rounding does to it in C."""

from __future__ import annotations

import math
import random
import re
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from importlib.resources import files

from flint import arb

from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.polynomials import dyadic
from lyapcheck.control.gains import GainSet
from lyapcheck.control.sampling import LoopRecord
from lyapcheck.export.functions import FLAT, Kernel, Saturation, angle_error, sine_text
from lyapcheck.export.steps import BITS, Program, Rounded, constant
from lyapcheck.family import Family, named
from lyapcheck.files.decimals import significant_up
from lyapcheck.robots.plant import RobotModel

ANGLES = (2**12, 2**30)
"""rad: |q| and |q_d| for which a bound is given; beyond the last the C text refuses."""
VECTORS = 1_000
FAR = 10
"""One vector of so many has angles up to the last of `ANGLES`, the others up to the first."""
DIGITS = 4
TURN = 2 * math.pi
ENDINGS = ("", "_test", "_sampled")
"""Of names of files, beside those of their kinds."""
LONGEST = 40
"""Letters of a name in C."""


@dataclass(frozen=True)
class Controller:
    """τ = K_p h(e) − K_v h(w) + g(q) of one gain set on one arm at its nominal numbers.

    Args:
        gains: of a bounded family that is written in C.
        model: the arm, without parameters.
        limits: of the motors, N·m; none where there is none.
        loop: how it is run, with a period and velocities by differences.
        name: that C names begin with.
        wrapped: whether readings jump at a full turn.
        hold: samples without a good reading for which the last torque is sent.
    """

    gains: GainSet
    model: RobotModel
    limits: tuple[Fraction | None, ...]
    loop: LoopRecord
    name: str
    wrapped: bool = False
    hold: int = 3

    @property
    def family(self) -> Family:
        return named(self.gains.family, self.gains.m)

    @cached_property
    def saturation(self) -> Saturation:
        return Saturation(self.family)

    @cached_property
    def gravity(self) -> Kernel:
        """g(q) from the sines and cosines ``s[i]``, ``c[i]``, (n,), N·m."""
        program, n = Program(), self.model.n
        sines, cosines = ([program.read(f"{letter}[{i}]") for i in range(n)] for letter in "sc")
        torques = self.model.at(sines, cosines, program.number).gravity()
        return Kernel(program, {f"g[{i}]": torque for i, torque in enumerate(torques)})

    @cached_property
    def sum(self) -> Kernel:
        program = Program()
        kp, he, kv, hw, gi = map(program.read, ("kp", "he", "kv", "hw", "gi"))
        return Kernel(program, {"tau[i]": kp * he - kv * hw + gi})

    @cached_property
    def rounding(self) -> dict[int, tuple[Fraction, ...]]:
        """By each of ``ANGLES``: bounds of |computed τ_i − τ_i|, (n,), N·m, for |q|, |q_d| ≤ it and finite w.

        They are rounded up. Sines and cosines are any numbers of [−1, 1] there: the bound of g is larger than
        it need be, the more the longer the chain.

        Soundness: running errors in balls, outward, over the whole domain, of the steps that are printed.

        Raises:
            Unbounded: there is none.
        """
        with precision(BITS):
            errors, h = self.saturation.errors(), arb(0, arb(above(self.family.checked.gamma)))
            result = {}
            for largest in ANGLES:
                angle = Rounded(arb(0, 1), angle_error(arb(largest)))
                gravity = self.gravity.rounded(**dict.fromkeys(self.gravity.reads, angle))
                totals = []
                for kp, kv, gi in zip(self.gains.kp, self.gains.kv, gravity, strict=True):
                    parts = {
                        "kp": Rounded.constant(kp),
                        "kv": Rounded.constant(kv),
                        "he": Rounded(h, errors.rounded),
                        "hw": Rounded(h, errors.exact),
                        "gi": gi,
                    }
                    totals.append(significant_up(dyadic(self.sum.rounded(**parts)[0].error), DIGITS))
                result[largest] = tuple(totals)
            return result

    def torque(self, q: Sequence[float], w: Sequence[float], goal: Sequence[float]) -> list[arb]:
        """τ in balls, (n,), N·m: the steps of g in balls, and h as the checker has it."""
        angles = [arb(x) for x in q]
        turns = {"s": [x.sin() for x in angles], "c": [x.cos() for x in angles]}
        given = {f"{letter}[{i}]": x for letter, row in turns.items() for i, x in enumerate(row)}
        gravity = self.gravity.program.run(list(self.gravity.outputs.values()), given, to_arb)
        h = self.family.ball_h
        return [
            to_arb(kp) * h(arb(to) - at) - to_arb(kv) * h(arb(rate)) + pull
            for kp, kv, to, at, rate, pull in zip(
                self.gains.kp, self.gains.kv, goal, angles, w, gravity, strict=True
            )
        ]

    def texts(self) -> dict[str, str]:
        n, loop = self.model.n, self.loop
        assert loop.period is not None
        # in a comment of any compiler: no end of it, no trigraph, no line
        title = re.sub(r"[^A-Za-z0-9 ._-]", "_", f"{self.gains.name} on {self.model.name}")[:80]
        member = "" if self.gains.m is None else f", m = {self.gains.m}"
        words = {
            "TITLE": title,
            "H_NAME": f"{self.gains.family}{member}",
            "JOINTS_VALUE": str(n),
            "PERIOD_VALUE": constant(loop.period),
            "TAPS_VALUE": str(len(loop.filter)),
            "HOLD_VALUE": str(self.hold),
            "WRAPPED_VALUE": str(int(self.wrapped)),
            "TURN_VALUE": constant(TURN),
            "FLAT_VALUE": constant(FLAT),
            "KP_VALUES": _list(self.gains.kp),
            "KV_VALUES": _list(self.gains.kv),
            "FILTER_VALUES": _list(loop.filter),
            "LIMIT_VALUES": ", ".join(
                "DBL_MAX" if limit is None else constant(below(limit)) for limit in self.limits
            ),
            "SINE_TEXT": sine_text(),
            "H_TEXT": self.saturation.text(),
            "GRAVITY_TEXT": self.gravity.text(),
            "TORQUE_TEXT": self.sum.text(" " * 8),
            "VECTORS_TEXT": self._vectors(),
            "COUNT_VALUE": str(VECTORS),
            "BOUND_VALUES": ",\n    ".join(
                f"{{{', '.join(constant(above(x)) for x in self.rounding[largest])}}}" for largest in ANGLES
            ),
            "NAME": self.name,
        }
        token = re.compile("|".join(sorted(words, key=len, reverse=True)))
        return {
            file.replace("controller", self.name): token.sub(
                lambda found: words[found[0]],
                files("lyapcheck.export").joinpath(file).read_text(encoding="utf-8"),
            )
            for file in ("controller.h", "controller.c", "controller_test.c")
        }

    def _vectors(self) -> str:
        """Arguments and torques as two doubles each, of balls; the same for the same controller."""
        draw, n = random.Random(0), self.model.n
        rows = []
        with precision(2 * BITS):
            for number in range(VECTORS):
                far = number % FAR == 0
                reach = draw.choice((1e-3, 1.0, math.pi, float(ANGLES[0]), float(ANGLES[1]) if far else 10.0))
                q = [draw.uniform(-reach, reach) for _ in range(n)]
                goal = [draw.choice((x + draw.gauss(0, 1), draw.uniform(-reach, reach))) for x in q]
                goal = [max(-reach, min(reach, x)) for x in goal]
                w = [draw.gauss(0, 1) * 10.0 ** draw.choice((-8, -2, 0, 1, 3, 300)) for _ in range(n)]
                torques = self.torque(q, w, goal)
                high = [float(x.mid()) for x in torques]
                low = [float((x - arb(y)).mid()) for x, y in zip(torques, high, strict=True)]
                rows.append(
                    f"{{{int(far)}, {', '.join(f'{{{_list(part)}}}' for part in (q, w, goal, high, low))}}}"
                )
        return ",\n    ".join(rows)


def c_names(names: Sequence[str]) -> list[str]:
    """A C name for each of some names, all different, also as the beginnings of files on any disk."""
    used: set[str] = set()
    result = []
    for name in names:
        stem = re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")[:LONGEST].strip("_") or "gains"
        stem = stem if stem[0].isalpha() else f"gains_{stem}"
        chosen, count = stem, 1
        while used & (taken := {f"{chosen}{end}".lower() for end in ENDINGS}):
            count += 1
            chosen = f"{stem}_{count}"
        used |= taken
        result.append(chosen)
    return result


def above(value: Fraction) -> float:
    """A double that is not below a number."""
    near = float(value)
    return near if Fraction(near) >= value else math.nextafter(near, math.inf)


def below(value: Fraction) -> float:
    """A double that is not above a number."""
    return -above(-value)


def _list(values: Sequence[Fraction | float]) -> str:
    return ", ".join(map(constant, values))
