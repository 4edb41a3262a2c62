"""ODEs of a few variables: textbook examples, and loops and regions that come close to them and are false."""

from dataclasses import replace
from fractions import Fraction as F
from random import Random

import pytest

from lyapcheck.claims import converges_to, enters, exp, expr, global_, local, sin, sqrt, system, var
from tests.helpers.shares import one_in
from tests.helpers.stated import verdict, why
from tests.oracle.flows import flow

x, y, z, k = map(var, "xyzk")
SQUARE = x**2 + y**2
LINEAR = system({"x": y, "y": -x - y})
SUM = 3 * x**2 + 2 * x * y + 2 * y**2
TURNED_POL = system({"x": -y, "y": x - (1 - x**2) * y})
POL = 3 * x**2 / 2 - x * y + y**2
LORENZ = system({"x": 10 * (y - x), "y": 28 * x - y - x * z, "z": x * y - F(8, 3) * z})
BOWL = x**2 + y**2 + (z - 38) ** 2
TRUE = {
    "linear": global_(LINEAR, SUM),
    "cubic": global_(system({"x": -(x**3) + y, "y": -x - y**3}), SQUARE),
    "constant": global_(system({"x": -k * x + y, "y": -x - k * y}, constants="k"), SQUARE),
    "Van der Pol": local(TURNED_POL, POL, region=F(3, 2) >= POL, within=4),
    "Lorenz": enters(LORENZ, BOWL, region=BOWL <= 3000, grows=F(1, 2), less=2000),
    "consensus": converges_to(
        system({"x": y - x, "y": x + z - 2 * y, "z": y - z}), x**2 + y**2 + z**2, [x - y, y - z]
    ),
}


@pytest.mark.parametrize("name", one_in(4, TRUE))
def test_textbook_examples(name):
    statement = TRUE[name]
    assert verdict(statement) == "proved"
    assert flow(statement, Random(1)) is None


def test_what_it_says():
    assert (
        TRUE["Van der Pol"]
        .text()
        .startswith(
            "x = 0, y = 0 is asymptotically stable and attracts x² + y² ≤ 4, V ≤ 1.5 under dx/dt = −y;"
        )
    )
    assert "comes to V ≤ 3000 and stays there under" in TRUE["Lorenz"].text()
    assert "every motion is bounded, with x − y, y − z → 0 under" in TRUE["consensus"].text()
    assert "for all k > 0" in TRUE["constant"].text()


FALSE = {
    "Van der Pol in its own time": (
        local(system({"x": y, "y": -x + (1 - x**2) * y}), POL, region=F(3, 2) >= POL, within=4),
        "fall",
    ),
    "beyond its limit cycle": (local(TURNED_POL, POL, region=POL <= 30, within=60), "fall"),
    "a centre": (global_(system({"x": y, "y": -x}), SQUARE), "fall"),
    "a centre that grows a little": (global_(system({"x": y + F(1, 1000) * x, "y": -x}), SQUARE), "fall"),
    "another state of rest": (global_(system({"x": -x + x**3, "y": -y}), SQUARE), "fall"),
    "a saddle": (global_(system({"x": x, "y": -y}), SQUARE), "fall"),
    "a motion that escapes": (enters(system({"x": x}), x**2, region=x**2 <= 5), "fall"),
    "Lorenz in a small bowl": (enters(LORENZ, BOWL, region=BOWL <= 30, grows=F(1, 2), less=2000), "fall"),
    "consensus at 0": (converges_to(system({"x": y - x, "y": x - y}), SQUARE, [x]), "x → 0"),
    "the origin moves": (global_(system({"x": 1 - x, "y": -y}), SQUARE), "rest of x"),
}


@pytest.mark.parametrize("name", FALSE)
def test_a_flow_that_does_otherwise_is_not_proved(name):
    statement, reason = FALSE[name]
    assert flow(statement, Random(1)) is not None, "the flow is no counterexample"
    assert why(statement).startswith(reason)


@pytest.mark.parametrize(
    ("statement", "reason"),
    [
        (global_(LINEAR, SQUARE - F(1, 10**12) * y**2 - x**2), "growth"),
        (local(LINEAR, x**2 - F(1, 10**12) * y**2, region=x**2 - F(1, 10**12) * y**2 <= 1, within=4), "edge"),
        (local(system({"x": -x, "y": -y}), x**2, region=x**2 <= 1, within=4), "edge"),
        (global_(LINEAR, SQUARE * (x - 1) ** 2), "growth"),
        (local(LINEAR, SUM * (x - 1) ** 2, region=SUM * (x - 1) ** 2 <= 1, within=9), "edge"),
        (local(LINEAR, SQUARE, region=SQUARE <= 1, within=2), "fall"),
        (global_(system({"x": -x, "y": -y / x}), SQUARE), "expression: is not a polynomial"),
    ],
)
def test_data_that_do_not_show_it(statement, reason):
    """A weight of −10⁻¹², level sets without end, V that vanishes elsewhere, dV/dt too, and a pole."""
    assert why(statement).startswith(reason)


def test_what_is_no_polynomial_or_has_other_names():
    base = TRUE["linear"]
    for change, reason in (
        ({"energy": sqrt(SQUARE).tree}, "not a polynomial"),
        ({"energy": (1 / (1 + x**2)).tree}, "not a polynomial"),
        ({"rates": (("x", sin(2 * y).tree), ("y", x.tree))}, "not a polynomial"),
        ({"rates": (("x", exp(y).tree), ("y", x.tree))}, "sin and cos of one state each"),
        ({"rates": (("x", sin(k).tree), ("y", x.tree)), "constants": ("k",)}, "sin and cos of one state"),
        ({"rates": (("x", (1 / x).tree), ("y", x.tree))}, "not a polynomial"),
        ({"rates": (("x", y.tree), ("x", x.tree))}, "one is given twice"),
        ({"rates": ()}, "must be 1 to 12"),
        ({"constants": ("x",)}, "one is given twice"),
        ({"energy": var("q").tree}, "q"),
        ({"a": x.tree}, "x"),
        ({"a": None}, "must be a, b"),
        ({"level": expr(1).tree}, "must be a, b"),
        ({"conclusion": "magic"}, "is not one that the checker knows"),
        ({"conclusion": "nearby"}, "must be level, radius"),
        ({"conclusion": "towards"}, "are what motions tend to"),
        ({"conclusion": "bounded", "level": expr(1).tree, "parts": (x.tree,)}, "are what motions tend to"),
    ):
        assert reason in why(replace(base, **change)), change
    with pytest.raises(ValueError, match="the rate of x has k"):
        system({"x": -k * x})
    with pytest.raises(ValueError, match="with the V of the theorem"):
        local(LINEAR, SUM, region=SQUARE <= 1, within=1)
    with pytest.raises(ValueError, match="with the V of the theorem"):
        enters(LINEAR, SUM, region=SUM < 1)
