"""Random arms, states and arithmetics that the tests of the robots share."""

from fractions import Fraction

from flint import fmpq
from hypothesis import strategies as st

from lyapcheck import robots
from lyapcheck.check.loop.chain import UNIT, RigidLink
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.fields import Number
from lyapcheck.robots.plant import RobotModel

BUILT_IN = robots.names()

small = st.fractions(min_value=-2, max_value=2, max_denominator=20)
positive = st.fractions(min_value=Fraction(1, 20), max_value=3, max_denominator=20)
axes = st.sampled_from(
    [
        (1, 0, 0),
        (0, 1, 0),
        (0, 0, 1),
        (0, 0, -1),
        (Fraction(3, 5), Fraction(4, 5), 0),
        (Fraction(-2, 3), Fraction(1, 3), Fraction(2, 3)),
    ]
)


def angles(n):
    """n points (sin, cos) on the unit circle with rational coordinates."""
    half = st.fractions(min_value=-8, max_value=8, max_denominator=12)
    return st.lists(half.map(circle), min_size=n, max_size=n)


def circle(t):
    return 2 * t / (1 + t * t), (1 - t * t) / (1 + t * t)


def rates(n):
    return st.lists(small, min_size=n, max_size=n)


@st.composite
def plain_links(draw, most=3):
    """Links with rational numbers; every inertia belongs to a real body (second moments ⪰ 0)."""
    count = draw(st.integers(1, most))
    vector = st.tuples(small, small, small)
    links = []
    for _ in range(count):
        rows = [draw(vector) for _ in range(3)]
        second = [[sum(r[i] * r[k] for r in rows) + (i == k) for k in range(3)] for i in range(3)]
        trace = sum(second[i][i] for i in range(3))
        inertia = [[trace * (i == k) - second[i][k] for k in range(3)] for i in range(3)]
        link = {
            "axis": draw(axes),
            "origin": draw(vector),
            "mass": draw(positive),
            "com": draw(vector),
            "inertia": inertia,
        }
        links.append(link)
    return links


def model_of(links, gravity=(0, 0, Fraction(-981, 100))):
    n = len(links)

    def exact_parts(value):
        return tuple(map(exact_parts, value)) if isinstance(value, list | tuple) else Fraction(value)

    plain = [{"turn": UNIT} | {key: exact_parts(value) for key, value in link.items()} for link in links]
    chain = Chain(tuple(RigidLink(**link) for link in plain), exact_parts(gravity))
    names = tuple(f"joint{i}" for i in range(n))
    nothing = (None,) * n
    return RobotModel(
        name="random",
        title="",
        joints=names,
        dynamics=chain,
        viscous=(Number(Fraction(1)),) * n,
        coulomb=nothing,
        torque_limit=nothing,
        encoder=nothing,
        gravity_bound=nothing,
        numbers={},
    )


def exact(value):
    return fmpq(value.numerator, value.denominator)
