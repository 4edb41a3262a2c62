"""Exactly at the border, through the file and the command: never wrong because of rounding."""

from decimal import Context, Decimal, Inexact
from fractions import Fraction
from math import ceil, floor, isqrt

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lyapcheck.answers.gate import gate
from lyapcheck.check.numbers.balls import hyperbolic_constants
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.control.gains import read_gain_file

SETTINGS = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])

EXACT = Context(prec=200, traps=[Inexact])
"""Decimal arithmetic that never rounds."""


@st.composite
def decimals(draw, most=30):
    """A positive decimal of up to so many digits, between 1e-14 and 1e14."""
    places = draw(st.integers(0, min(most, 15) - 1))
    digits = draw(st.integers(1, 10 ** draw(st.integers(places + 1, min(most, places + 14))) - 1))
    whole, rest = divmod(digits, 10**places)
    return f"{whole}.{rest:0{places}d}" if places else str(whole)


def gamma_between(m, bits):
    """Integers a ≤ γ_m·2^bits ≤ b."""
    gamma = hyperbolic_constants(m, bits * 3 // 10 + 20).gamma
    return floor(gamma.lower * 2**bits), ceil(gamma.upper * 2**bits)


def judged(path, top, kp, kv, bounds):
    path.write_text(
        f'[[gains]]\nname = "a"\n{top}\nkp = [{", ".join(kp)}]\nkv = [{", ".join(kv)}]\n[bounds]\n{bounds}\n'
    )
    (result,) = gate(read_gain_file(path))
    return result


def arm(friction, torque, gravity):
    lists = f"torque = [{', '.join(torque)}]\ngravity = [{', '.join(gravity)}]"
    return f"viscous_min = {friction}\n{lists}"


def of(result, name, joint=0):
    return next(check for check in result.checks if (check.id, check.joint) == (name, joint))


def one_unit_more(text):
    """The decimal one unit larger in its last place."""
    value = Decimal(text)
    return format(EXACT.add(value, EXACT.scaleb(Decimal(1), int(value.as_tuple().exponent))), "f")


@SETTINGS
@given(st.integers(1, 60), st.integers(1, 4), decimals(), decimals())
def test_the_largest_k_v_passes_and_one_unit_more_does_not(tmp_path, m, n, friction, written):
    """(19), whatever digits were written: what the message proposes is accepted, and nothing larger is."""
    bounds, kp = arm(friction, ["9e14"] * n, ["0"] * n), ["1"] * n

    def check(kv):
        return of(judged(tmp_path / "g.toml", f"m = {m}", kp, [kv] * n, bounds), "19")

    first = check(written)
    largest = first.largest_admissible
    assert largest is not None  # the friction is positive: some digits suffice
    assert largest.places >= len(written.partition(".")[2])
    assert check(largest.text).verdict == "accepted"
    above = check(one_unit_more(largest.text))
    assert above.verdict == "rejected"
    assert first.verdict == ("accepted" if Fraction(written) <= largest else "rejected")
    # and by γ itself, in balls of the paper's definition through an independent square
    low, high = gamma_between(m, 600)
    for result, sign in ((check(largest.text), 1), (above, -1)):
        assert result.value is not None
        square = n * result.value**2
        assert (
            sign * (Fraction(friction) ** 2 - square * Fraction(low if sign < 0 else high, 2**600) ** 2) >= 0
        )


@SETTINGS
@given(st.integers(2, 60), decimals(20), decimals(20), decimals(20))
def test_the_largest_k_p_passes_and_one_unit_more_does_not(tmp_path, m, torque, kp, kv):
    """(10p): k_p as large as the message says beside the k_v that was written."""
    bounds = arm("9e14", [torque], ["0"])
    largest = of(judged(tmp_path / "g.toml", f"m = {m}", [kp], [kv], bounds), "10p").largest_admissible
    if largest is None or largest <= Fraction(kv):
        return
    places = largest.places
    gain_range = (largest - Fraction(kv)) * 10**places
    if gain_range.denominator != 1:  # k_v has more digits than the answer
        return
    for units, verdict in ((gain_range, "accepted"), (gain_range + 1, "rejected")):
        text = format(EXACT.scaleb(Decimal(int(units)), -places), "f")
        assert of(judged(tmp_path / "g.toml", f"m = {m}", [text], [kv], bounds), "10p").verdict == verdict


@SETTINGS
@given(st.sampled_from([1, 4]), decimals(), st.sampled_from(["m = 1", 'family = "tanh"']))
def test_equality_is_rejected_by_19_and_10p(tmp_path, n, limit, top):
    """γ = 1 and √n whole: the border is a decimal, and (19) and (10p) are strict."""
    border = Fraction(limit)
    budget = format(EXACT.multiply(Decimal(limit), Decimal(isqrt(n))), "f")
    result = judged(tmp_path / "g.toml", top, ["1"] * n, [limit] * n, arm(budget, ["9e14"] * n, ["0"] * n))
    check = of(result, "19")
    assert (check.verdict, check.margin, check.limit) == ("rejected", 0, Enclosure.exact(border))
    assert check.largest_admissible is not None
    assert check.largest_admissible < border
    if "." in limit:
        half = format(EXACT.divide(Decimal(limit), Decimal(2)), "f")
        result = judged(
            tmp_path / "g.toml", top, [half] * n, [half] * n, arm("9e14", [budget] * n, ["0"] * n)
        )
        assert (of(result, "10p").verdict, of(result, "10p").margin) == ("rejected", 0)


def test_equality_with_an_irrational_gamma_is_accepted_by_10(tmp_path):
    """(‖τ‖ − k_g)/(√n γ) with ‖τ‖ = 2γ_2 is out of reach of decimals; with m = 1 and n = 1 it is not."""
    for kp, verdict in (("1.5", "accepted"), ("1.500000000000000000000000000001", "rejected")):
        result = judged(tmp_path / "g.toml", "m = 1", [kp], ["0.5"], arm("9", ["3"], ["1"]))
        (check,) = [check for check in result.checks if check.id == "10"]
        assert check.verdict == verdict


@pytest.mark.parametrize("digits", [10, 100, 300])
@pytest.mark.parametrize("m", [2, 3, 17])
def test_a_gain_that_agrees_with_the_limit_to_hundreds_of_digits(tmp_path, m, digits):
    """k_v is 1/γ_m cut off after so many digits, or one unit above: only a finer bracket tells them apart."""
    low, high = gamma_between(m, 2000)
    below = 2**2000 * 10**digits // high
    assert below == 2**2000 * 10**digits // low
    for units, verdict in ((below, "accepted"), (below + 1, "rejected")):
        kv = f"0.{units:0{digits}d}"
        check = of(judged(tmp_path / "g.toml", f"m = {m}", ["1"], [kv], arm("1", ["9"], ["0"])), "19")
        assert check.verdict == verdict
        assert check.largest_admissible == Fraction(below, 10**digits)
