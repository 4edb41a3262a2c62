"""Examples of textbooks: ODEs of two or three variables, with polynomials for V.

Van der Pol in reversed time with a region, a spring that stiffens, backstepping, gradient flow, the Lorenz
attractor within a ball, and three agents that agree. Sums of squares are found by convex programs and
verified in rational numbers. The chapters are those of Khalil's book, as far as they are remembered here.
"""

from fractions import Fraction

from lyapcheck.claims import Proof, converges_to, enters, global_, identity, local, system, var

proof = Proof("textbook", "Examples of textbooks", reference="khalil2002nonlinear")

x, y, z, k = map(var, "xyzk")

V = 3 * x**2 / 2 - x * y + y**2


def van_der_pol(level=Fraction(3, 2), within=4, sign=1):
    """x′ = −y, y′ = x − (1 − x²)y: Van der Pol's oscillator backwards, within its limit cycle."""
    loop = system({"x": -sign * y, "y": sign * (x - (1 - x**2) * y)})
    return local(loop, V, region=level >= V, within=within)


proof.add("P", "Van der Pol in reversed time is stable, and V ≤ 3/2 attracts", van_der_pol())
energy = y**2 / 2 + x**2 / 2 + x**4 / 4
proof.add(
    "spring",
    "a damped spring that stiffens comes to rest from everywhere",
    global_(system({"x": y, "y": -x - x**3 - y}), energy + x * y / 2, grows=Fraction(1, 8)),
)
u = -x - (1 + 2 * x) * (x**2 - x**3 + z) - (z + x + x**2)
proof.add(
    "change",
    "backstepping of x′ = x² − x³ + z, z′ = u: w = z + x + x² has w′ = −x − w",
    identity(u + (1 + 2 * x) * (x**2 - x**3 + z), -x - (z + x + x**2)),
)
proof.add(
    "backstepping",
    "so with y for w, x′ = −x − x³ + y and y′ = −x − y: it is stable from everywhere",
    global_(system({"x": -x - x**3 + y, "y": -x - y}), x**2 / 2 + y**2 / 2, grows=Fraction(1, 2)),
    uses=["change"],
)
f = x**2 + x * y + y**2 + x**4
proof.add(
    "gradient",
    "gradient flow goes to the minimum of a convex function",
    global_(system({"x": -(2 * x + y + 4 * x**3), "y": -(x + 2 * y)}), f, grows=Fraction(1, 2)),
)
lorenz = system({"x": 10 * (y - x), "y": 28 * x - y - x * z, "z": x * y - Fraction(8, 3) * z})
ball = x**2 + y**2 + (z - 38) ** 2
proof.add(
    "Lorenz",
    "all motions of the Lorenz system come into a ball and stay",
    enters(lorenz, ball, region=ball <= 3000, grows=Fraction(1, 2), less=2000),
)
agents = system({"x": y - x, "y": x + z - 2 * y, "z": y - z})
squares = x**2 + y**2 + z**2
proof.add("agents", "three agents in a row agree", converges_to(agents, squares, [x - y, y - z]))
proof.add(
    "gain",
    "for every k > 0 the origin of x′ = −kx + y, y′ = −x − ky is stable from everywhere",
    global_(system({"x": -k * x + y, "y": -x - k * y}, constants="k"), x**2 + y**2),
)

proof.section("What would be too much")
proof.add("forwards", "Van der Pol in its own time", van_der_pol(sign=-1))
proof.add("wide", "a region that reaches beyond the limit cycle", van_der_pol(level=30, within=60))
proof.add("open", "a region that is not in the ball", van_der_pol(within=1))
proof.add(
    "undamped",
    "the spring without damping, by its energy",
    global_(system({"x": y, "y": -x - x**3}), energy, grows=Fraction(1, 2)),
)
proof.add(
    "small ball",
    "the Lorenz system within a ball that is too small",
    enters(lorenz, ball, region=ball <= 300, grows=Fraction(1, 2), less=2000),
)
proof.add("at 0", "the agents agree on 0", converges_to(agents, squares, [x]))
