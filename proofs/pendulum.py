"""The pendulum, by energy and by other V: rests, regions of attraction, swing-up, a spring.

θ occurs in sines and cosines alone, so it counts up to full turns. Regions are balls of 2(1 − cos θ) + w².
The swing-up is that of energy control: θ″ = −sin θ + u with u = −kw(E − 1), for E = ½w² − cos θ.
"""

from fractions import Fraction

from lyapcheck.claims import Proof, converges_to, cos, enters, global_, local, sin, system, var

proof = Proof("pendulum", "The pendulum", reference="khalil2002nonlinear")

θ, w, a, b = map(var, ("θ", "w", "a", "b"))
damped = system({"θ": w, "w": -sin(θ) - w})
E = w**2 / 2 + 1 - cos(θ)
V = E + w * sin(θ) / 2
"""Strict: dV/dt = −(1 − ½cos θ)w² − ½w sin θ − ½sin² θ."""


def with_damping(b, parts):
    """All motions of θ″ = −a sin θ − bθ′ with positive a and b."""
    s = system({"θ": w, "w": -a * sin(θ) - b * w}, constants="a b")
    return converges_to(s, w**2 / 2 + a * (1 - cos(θ)), parts, grows=Fraction(1, 2), less=2)


proof.add("rests", "every motion tends to a rest, down or up", with_damping(b, [w, a * sin(θ)]))
proof.add(
    "strict",
    "the same by a V that falls everywhere but at the rests",
    converges_to(damped, V, [w, sin(θ)], grows=Fraction(1, 4), less=2),
)
proof.add(
    "P",
    "the lower rest is asymptotically stable, by the strict V",
    local(damped, V, region=Fraction(1, 2) >= V, within=3),
)
proof.add(
    "steps",
    "it attracts all motions with an energy of at most 19/10, where the upper rest has 2",
    local(damped, E, region=Fraction(19, 10) >= E, within=Fraction(39, 10), rest=[w, sin(θ)]),
)
line = 1 - cos(θ) + θ**2 / 4 + θ * w / 2 + w**2 / 2
proof.add(
    "line",
    "with θ² in V the angle is a number, and θ sin θ ≥ θ² − θ⁴/6 is used",
    local(damped, line, region=Fraction(1, 2) >= line, within=2),
)
D = w**2 / 2 - cos(θ) - 1
"""The energy less that of the upper rest."""


def swing_up(parts, k=1):
    """The pendulum with the torque −kw(E − 1)."""
    return converges_to(
        system({"θ": w, "w": -sin(θ) - k * w * D}), D**2 / 2, parts, grows=Fraction(1, 4), less=4
    )


proof.add(
    "swing up",
    "every motion tends to the energy of the upper rest, or to the lower rest",
    swing_up([w * D, sin(θ) * D, (1 - cos(θ)) * D**2]),
)
spring = system({"θ": w, "w": sin(θ) - 2 * θ - w})
stored = w**2 / 2 + θ**2 - (1 - cos(θ))
proof.add(
    "spring",
    "an inverted pendulum on a spring that is stiffer than gravity stands from everywhere",
    global_(spring, stored + θ * w / 4, grows=Fraction(1, 8)),
)
proof.add("spring steps", "the same by its energy", global_(spring, stored, grows=Fraction(1, 2), rest=[w]))
proof.add(
    "wheel",
    "with a constant torque ½ the speed comes below 2",
    enters(system({"θ": w, "w": Fraction(1, 2) - sin(θ) - w}), w**2, region=w**2 <= 4, less=4),
)

proof.section("What would be too much")
proof.add(
    "pushed",
    "every motion tends to a rest, with a torque along the motion",
    with_damping(-b, [w, a * sin(θ)]),
)
proof.add("undamped", "every motion tends to a rest without damping", with_damping(0 * b, [w, a * sin(θ)]))
proof.add("bottom", "every motion tends to the lower rest", with_damping(b, [w, a * (1 - cos(θ))]))
proof.add(
    "upright",
    "the lower rest attracts a region with the upper rest in it",
    local(damped, E, region=E <= 2, within=5, rest=[w, sin(θ)]),
)
proof.add("global", "the lower rest attracts all", global_(damped, E, grows=Fraction(1, 2), rest=[w, sin(θ)]))
proof.add("energy", "every motion tends to the energy of the upper rest", swing_up([w * D, sin(θ) * D, D]))
proof.add("swing down", "the same with the opposite torque", swing_up([w * D, sin(θ) * D], k=-1))
proof.add(
    "soft",
    "an inverted pendulum on a spring that is softer than gravity stands",
    global_(
        system({"θ": w, "w": 2 * sin(θ) - θ - w}),
        w**2 / 2 + θ**2 / 2 - 2 * (1 - cos(θ)),
        grows=Fraction(1, 8),
        less=9,
    ),
)
