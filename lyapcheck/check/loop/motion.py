"""zᵀC(q, x)x of a chain of links as a sum along the chain, and an upper bound of it by polynomials.

For rates z and x of the joints let Z and V be the twists of a link, A its acceleration for q̇ = x and q̈ = 0,
and N the sum of the x_k² so far. In the frame of joint k, e the unit twist about its axis,

    Z' = Z + e z_k,   A' = A + (V × e) x_k,   V' = V + e x_k,   N' = N + x_k²,
    2 zᵀC(q, x)x = Σ_k cost_k,   cost_k = 2 Z'ᵀ(G A' + V' ×* G V').

If polynomials s_k that turns about the axis leave as they are fulfil, with X_k as in ``storage`` and N ≥ 0,

    s_k(Z, A, V, N) + κ z_k² ≥ cost_k + s_{k+1}(X_{k+1} (Z', A', V', N')),   s_{n+1} = −κ N²,

for all k > K, and if for the first K joints, taken together at every posture,

    κ Σ z_k² ≥ Σ cost_k + s_{K+1}(X_{K+1} (Z', A', V', N')),      k ≤ K,

then 2 zᵀC(q, x)x ≤ κ (‖z‖² + ‖x‖⁴): a turn by q_k changes nothing in s_k, the sum telescopes, and all is 0 at
the base. That holds for all z and x only if ‖C(q, x)x‖ ≤ κ‖x‖². Behind joint K what is not negative is
N^d mᵀPm with P positive definite, m monomials; before it vᵀH(q)v, v the rates z_k and the products x_i x_j,
with H positive definite at all angles (``head``, ``control_points``).

References: recursive Newton–Euler algorithm, ``featherstone2008rigid`` chapter 5; ``willems1972dissipative``.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations_with_replacement

from flint import Ordering, arb, ctx, fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.check.loop.arithmetic import BALLS
from lyapcheck.check.loop.control_points import definite_at_all_angles, nodes
from lyapcheck.check.loop.head import Head, relation, stored_form
from lyapcheck.check.loop.storage import BITS, TWIST, Hinge
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.numbers.vectors import ZERO, Algebra, Entry, Vector

Gram = tuple[tuple[Fraction, ...], ...]
"""The rows of a symmetric matrix up to the diagonal."""
RING = fmpq_mpoly_ctx.get([*(f"{a}{i}" for a in "ZAV" for i in range(6)), *"Nzx"], Ordering.lex)
GENS = RING.gens()
STATE, (RATE, SPEED) = GENS[:19], GENS[19:]
"""(Z, A, V, N); z and x of a joint."""
COUNT = STATE[-1]
POLYNOMIALS = Algebra(lambda value: RING.constant(rational(value)))


def products(a: Vector) -> list[Entry]:
    """Those of each two entries, an entry with itself among them."""
    return [x * y for x, y in combinations_with_replacement(a, 2)]


LINEAR = [*STATE[12:18], SPEED]
JOINT = [*STATE[:12], RATE, *products(LINEAR), COUNT]
"""The monomials m of a joint, beside those with N."""


def carried(of: Algebra, hinge: Hinge, state: Vector) -> list[Entry]:
    """From the frame of the joint before to that of this one at q = 0."""
    carry = hinge.carry
    return [*(x for k in range(0, 18, TWIST) for x in of.apply(carry, state[k : k + TWIST])), state[18]]


def turned(of: Algebra, sine: Entry, cosine: Entry, state: Vector) -> list[Entry]:
    """From there to the frame of the joint at another angle."""
    result = list(state)
    for k in range(0, 18, 3):
        result[k] = of.dot((cosine, sine), state[k : k + 2])
        result[k + 1] = of.minus(of.times(cosine, state[k + 1]), of.times(sine, state[k]))
    return result


def moved(of: Algebra, state: Vector, z: Entry, x: Entry) -> list[Entry]:
    """(Z', A', V', N')."""
    result = list(state)
    for k in (6, 9):
        result[k] = of.plus(state[k], of.times(state[k + 7], x))
        result[k + 1] = of.minus(state[k + 1], of.times(state[k + 6], x))
    for k, more in ((2, z), (14, x), (18, of.times(x, x))):
        result[k] = of.plus(state[k], more)
    return result


def cost(of: Algebra, hinge: Hinge, state: Vector) -> Entry:
    """2 Z'ᵀ(G A' + V' ×* G V')."""
    body, rates, spin, speed = hinge.body, state[:6], state[12:15], state[15:18]
    momentum = of.apply(body, state[12:18])
    torque = of.add(of.cross(spin, momentum[:3]), of.cross(speed, momentum[3:]))
    force = of.add(of.apply(body, state[6:12]), [*torque, *of.cross(spin, momentum[3:])])
    return of.value(of.times(Fraction(2), of.dot(rates, force)))


def coriolis_power(
    of: Algebra, hinges: Sequence[Hinge], sines: Vector, cosines: Vector, z: Vector, x: Vector
) -> Entry:
    """2 zᵀC(q, x)x at one posture."""
    state: Vector = [ZERO] * len(STATE)
    total = of.value(ZERO)
    for hinge, sine, cosine, rate, speed in zip(hinges, sines, cosines, z, x, strict=True):
        state = moved(of, turned(of, sine, cosine, carried(of, hinge, state)), rate, speed)
        total = total + cost(of, hinge, state)
    return total


def shows(
    hinges: Sequence[Hinge],
    kappa: Fraction,
    joints: Sequence[tuple[Gram, Gram]],
    relations: Sequence[Sequence[Fraction]],
    degree: int,
    start: Sequence[int],
    halvings: Sequence[int],
) -> bool:
    """Whether matrices show 2 zᵀC(q, x)x ≤ κ (‖z‖² + ‖x‖⁴), for two joints or more.

    Args:
        hinges: base first.
        kappa: the bound.
        joints: for the joints behind the first K, P of ``JOINT`` and of N (V, x).
        relations: of the products of the first K speeds, see `head.relation`, at each of the nodes.
        degree: of which these are; not below that of H.
        start: see `definite_at_all_angles`, for q_2 to q_K.
        halvings: likewise.

    Soundness: s_k is what the condition with equality makes of it, a polynomial in the state alone; else it
        is refused, as where turns change it.
    """
    if not all(is_definite(p, JOINT) and is_definite(q, LINEAR) for p, q in joints):
        return False
    of, price, first = POLYNOMIALS, rational(kappa), len(hinges) - len(joints)
    handed_on = -price * COUNT**2
    for k in range(len(hinges) - 1, first - 1, -1):
        squares, counted = joints[k - first]
        state = moved(of, STATE, RATE, SPEED)
        form = gram(squares, JOINT) + COUNT * gram(counted, LINEAR) - price * RATE**2
        form += cost(of, hinges[k], state) + onwards(hinges[k + 1 :], state, handed_on)
        if form.derivative("z") or form.derivative("x") or _turning(form):
            return False
        handed_on = form
    terms = {powers[: len(STATE)]: c for powers, c in handed_on.to_dict().items()}
    head = Head(hinges[: first + 1], first, kappa, stored_form(terms))
    postures = zip(nodes(degree, first - 1), relations, strict=True)
    values = (head.entries(angles, relation(row, first)) for angles, row in postures)
    return definite_at_all_angles(values, degree, start, halvings)


def onwards(following: Sequence[Hinge], state: Vector, form: fmpq_mpoly) -> fmpq_mpoly:
    """s_{k+1}(X_{k+1} w'), at the end s_{n+1}(w')."""
    reached = carried(POLYNOMIALS, following[0], state) if following else state
    return form.compose(*map(POLYNOMIALS.value, reached), *GENS[len(STATE) :])


def _turning(form: fmpq_mpoly) -> fmpq_mpoly:
    """The rate at which turns of all vectors about e_z change it."""
    rate = RING.constant(0)
    for x, y in ((i, i + 1) for i in range(0, 18, 3)):
        rate += form.derivative(y) * GENS[x] - form.derivative(x) * GENS[y]
    return rate


def gram(matrix: Sequence[Vector], terms: Sequence[fmpq_mpoly]) -> fmpq_mpoly:
    """mᵀPm."""
    total = RING.constant(0)
    for i, row in enumerate(matrix):
        total += 2 * terms[i] * POLYNOMIALS.dot([*row[:-1], row[-1] / 2], terms[: i + 1])
    return total


def is_definite(matrix: Gram, terms: Sequence[fmpq_mpoly]) -> bool:
    """Whether this is a positive definite matrix of that size."""
    fits = [len(row) for row in matrix] == [*range(1, len(terms) + 1)]
    with ctx.workprec(BITS):
        return fits and BALLS.positive_definite([[arb(rational(x)) for x in row] for row in matrix])
