"""sin, cos and the functions of a family in plain doubles, short and without branches.

They are written for recorded code, and serve arrays as well.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from lyapcheck.compiled.plain_arrays import PlainArrays
from lyapcheck.compiled.straight_line import StraightLine
from lyapcheck.family import Family
from lyapcheck.family.arithmetic import Arithmetic
from lyapcheck.family.base import NumericForms
from lyapcheck.family.elementary import ElementaryFamily

_LN2 = 0.6931471805599453


@dataclass(frozen=True, eq=False)
class PlainForms:
    """What formulas ask of an arithmetic, for one family: terms of one piece of code, or arrays."""

    code: StraightLine | PlainArrays
    family: Family

    def sin(self, x: Any) -> Any:
        """sin x."""
        return self.code.call("sine", x)

    def cos(self, x: Any) -> Any:
        """cos x."""
        return self.code.call("cosine", x)

    def sqrt(self, x: Any) -> Any:
        """√x."""
        return self.code.call("sqrt", x)

    def ratio(self, a: Any, b: Any) -> Any:
        """a/b, and 0 where b = 0."""
        return a / self.code.where(b > 0.0, b, 1.0)

    def h(self, x: Any) -> Any:
        """h(x)."""
        return self._forms(x).h

    def dh(self, x: Any) -> Any:
        """h'(x)."""
        return self._forms(x).dh

    def potential(self, x: Any) -> Any:
        """U(x)."""
        return self._forms(x).potential

    def _forms(self, x: Any) -> Any:
        if self.family.name in _WITH_POWERS:
            return HyperbolicForms(self.code, self.family.m or 1, x)
        if isinstance(self.family, ElementaryFamily):
            return self.family.numeric(_arithmetic(self.code), x)
        return NumericForms(h=x, dh=self.code.term(1), potential=0.5 * x * x, secant=self.code.term(1))


_WITH_POWERS = ("hyperbolic", "tanh")


def has_plain_forms(family: Family) -> bool:
    """Whether a family can be written in plain doubles."""
    return family.name == "linear" or family.name in _WITH_POWERS or isinstance(family, ElementaryFamily)


def _arithmetic(code: StraightLine | PlainArrays) -> Arithmetic:
    """The operations of families in plain doubles."""

    def of(function: str) -> Callable[..., Any]:
        return lambda *x: code.call(function, *x)

    return Arithmetic(
        where=code.where,
        fabs=of("fabs"),
        smaller=of("smaller"),
        larger=of("larger"),
        sqrt=of("sqrt"),
        log=of("log"),
        arctan=of("atan"),
    )


class HyperbolicForms:
    """h_m, h_m' and U_m from t = e^(−|x|), which never overflows.

    With sinh|x| = u(1 + t)/(2t), u = 1 − t, let p be the smaller of sinh|x| and its inverse, P = p^(2m) and
    Q = p^(2m−2). Where sinh|x| ≤ 1

        h = (sign x) p^(2m−1) cosh x/(1 + P),  h' = Q (2m−1 + 2m p² − P)/(1 + P)²,  U = ln(1 + P)/(2m),

    and beyond

        h = (sign x) coth|x|/(1 + P),  h' = p² ((2m−1) P + 2m Q − 1)/(1 + P)²,
        U = ln sinh|x| + ln(1 + P)/(2m).

    Soundness: errors of some 4m units in the last place of the largest term; near the zero of h' that is no
    bound of its relative error.
    """

    def __init__(self, code: StraightLine | PlainArrays, m: int, x: Any) -> None:
        self.code, self.m, self.x = code, m, x
        self.a = code.call("fabs", x)
        self.t = code.call("exp_of_negative", self.a)
        over, under = code.call("one_minus_exp", self.a) * (1.0 + self.t), 2.0 * self.t
        self.near = over <= under
        self.inverse = 1.0 / code.call("larger", over, under)
        self.p = code.call("smaller", over, under) * self.inverse

    @cached_property
    def P(self) -> Any:
        """p^(2m)."""
        return self._power(self.m)

    @cached_property
    def share(self) -> Any:
        """1/(1 + P)."""
        return 1.0 / (1.0 + self.P)

    @property
    def h(self) -> Any:
        """h_m(x)."""
        size = (1.0 + self.t * self.t) * self.inverse * self.share
        odd_power = self.p * self._power(self.m - 1)
        return self.code.call("copysign", size * self.code.where(self.near, odd_power, 1.0), self.x)

    @property
    def dh(self) -> Any:
        """h_m'(x)."""
        m, P, Q, square = self.m, self.P, self._power(self.m - 1), self.p * self.p
        near = Q * ((2.0 * m - 1.0) + 2.0 * m * square - P)
        far = square * ((2.0 * m - 1.0) * P + 2.0 * m * Q - 1.0)
        return self.code.where(self.near, near, far) * self.share * self.share

    @property
    def potential(self) -> Any:
        """U_m(x)."""
        log_sinh = (self.a - _LN2) + self.code.call("log_one_plus", self._bounded_square())
        rest = self.code.call("log_one_plus", self.P) * (1.0 / (2 * self.m))
        return rest + self.code.where(self.near, 0.0, log_sinh)

    def _bounded_square(self) -> Any:
        """−t², cut where it is not needed and the logarithm would leave its range."""
        return -self.code.call("smaller", self.t * self.t, 0.2)

    def _power(self, k: int) -> Any:
        """p^(2k) by repeated squaring."""
        base, result = self.p * self.p, self.code.term(1)
        while k:
            result = result * base if k & 1 else result
            base, k = base * base, k >> 1
        return result
