"""Bounds of M(q) and g(q) for all angles at once, from storage forms along a chain of links.

Let w be what link k − 1 hands on in the frame of joint k (its twist, and for gravity the free fall), u the
rate that joint k adds about its axis e_z, and s_k quadratic forms that turns about e_z leave as they are. If

    s_k(w) + κ_k u² > cost_k(w') + s_{k+1}(X_{k+1} w'),      w' = E_k(w + e_z u),      s_{n+1} = 0,

for each k and all (w, u) ≠ 0 that can occur, where X_k moves w to the frame of joint k at q_k = 0 and E_k = I
but for rates, then for all angles Σ cost_k < s_1(X_1 w_0) + Σ κ_k u_k²: a turn by q_k changes nothing in s_k,
and the sum telescopes.

- Energies: cost_k(V) = ± VᵀG_kV for the twist V of link k, and ± J_k u² of a rotor, which belongs to
  κ_k u², sum up to ± q̇ᵀMq̇, and w_0 = 0.
- Gravity: cost_k = −2 γᵀ(m v + ω × m c) for the free fall γ sum up to 2 zᵀg for rates z, and w_0 = (0, γ).
  With s_1(X_1 w_0) ≤ κ that is 2 zᵀg ≤ κ(1 + ‖z‖²) for all z, and so ‖g‖ ≤ κ.
- Rates of M: w has V and ∂V/∂q_j. Joint j turns V by −q_j, so that E_j appends −e_z × V; from it on
  cost_k = ± V'ᵀG_kV for both parts V, V' sum up to ± ½ q̇ᵀ(∂M/∂q_j)q̇, and w_0 = 0.

References: dissipation inequalities and storage functions, ``willems1972dissipative``.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import arb, ctx, fmpq, fmpq_mat

from lyapcheck.check.loop.chain import UNIT, RigidLink
from lyapcheck.check.loop.field import BALLS
from lyapcheck.check.numbers.polynomials import fraction, rational
from lyapcheck.check.numbers.vectors import ZERO, Algebra, transposed

TWIST, FALL = 6, 3
BITS = 256
OF = Algebra(Fraction)
Matrix = Sequence[Sequence[Fraction]]
Forms = tuple[tuple[Fraction, ...], ...]
"""For each joint the coefficients of its form; see `invariant_form`."""


@dataclass(frozen=True)
class Hinge:
    """One joint and the body that it moves, in a frame whose third axis is that of the joint.

    Args:
        turn: from the frame of the joint before to that of this one at q = 0, 3 × 3.
        place: of the joint, in the frame of the one before, m, (3,).
        mass: kg.
        moment: mass times centre of mass, kg·m, (3,).
        inertia: about the joint, kg·m², 3 × 3.
    """

    turn: Matrix
    place: Sequence[Fraction]
    mass: Fraction
    moment: Sequence[Fraction]
    inertia: Matrix

    @property
    def carry(self) -> list[list[Fraction]]:
        """X: from the twist (ω, v) of the link before to that of this one at q = 0, v of the joint."""
        moved = [[-x for x in row] for row in OF.product(self.turn, _cross(self.place))]
        return _blocks(self.turn, _zeros(3), moved, self.turn)

    @property
    def body(self) -> list[list[Fraction]]:
        """G: the kinetic energy of the body is ½ VᵀGV for its twist V."""
        tilt = _cross(self.moment)
        weight = [[self.mass * x for x in row] for row in UNIT]
        return _blocks(self.inertia, tilt, transposed(tilt), weight)


def hinges(links: Sequence[RigidLink]) -> list[Hinge]:
    """The links in such frames, base first."""
    result, before = [], [list(row) for row in UNIT]
    for link in links:
        own = _upright(link.axis)
        com = OF.apply(own, link.com)
        tilt = _cross(com)
        far = [[-link.mass * x for x in row] for row in OF.product(tilt, tilt)]
        result.append(
            Hinge(
                OF.product(OF.product(own, transposed(link.turn)), transposed(before)),
                OF.apply(before, link.origin),
                link.mass,
                OF.scaled(link.mass, com),
                OF.sum(OF.congruent(own, link.inertia), far),
            )
        )
        before = own
    return result


@dataclass(frozen=True, eq=False)
class Stage:
    """One joint: X, the costs of w' and of u², what of w can occur, whether u counts, and E if not I."""

    carry: fmpq_mat
    cost: fmpq_mat
    met: range
    moves: bool = True
    entry: fmpq_mat | None = None
    turning: Fraction = ZERO

    @property
    def size(self) -> int:
        return int(self.cost.nrows())


def energy(links: Sequence[RigidLink], sign: int) -> list[Stage]:
    """Costs that sum up to sign · q̇ᵀM(q)q̇."""
    return [
        Stage(
            _matrix(hinge.carry),
            _matrix(_scaled(sign, hinge.body)),
            range(TWIST if k else 0),
            turning=sign * link.rotor,
        )
        for k, (link, hinge) in enumerate(zip(links, hinges(links), strict=True))
    ]


def rate_of_mass(links: Sequence[RigidLink], joint: int, sign: int) -> list[Stage]:
    """Costs that sum up to sign · ½ q̇ᵀ(∂M/∂q_j)q̇ for a joint j, counted from 0."""
    result, nothing = [], _zeros(TWIST)
    turned = _scaled(-1, _cross([ZERO, ZERO, Fraction(1)]))
    one = [[Fraction(int(i == k)) for k in range(TWIST)] for i in range(TWIST)]
    appended = _blocks(one, nothing, _blocks(turned, _zeros(3), _zeros(3), turned), nothing)
    for k, hinge in enumerate(hinges(links)):
        half = _scaled(Fraction(sign, 2) if k >= joint else ZERO, hinge.body)
        result.append(
            Stage(
                _matrix(_blocks(hinge.carry, nothing, nothing, hinge.carry)),
                _matrix(_blocks(nothing, half, half, nothing)),
                range(0 if k == 0 else TWIST if k <= joint else 2 * TWIST),
                entry=_matrix(appended) if k == joint else None,
            )
        )
    return result


def weight(links: Sequence[RigidLink], joints: Collection[int]) -> list[Stage]:
    """Costs that sum up to 2 zᵀg(q) for rates z of some joints, counted from 0."""
    result = []
    for k, hinge in enumerate(hinges(links)):
        # γᵀ(ω × c) = ωᵀ(c × γ)
        above = [[-x for x in row] for row in _cross(hinge.moment)]
        above += [[-hinge.mass * x for x in row] for row in UNIT]
        cost = _blocks(_zeros(TWIST), above, transposed(above), _zeros(FALL))
        carry = _blocks(hinge.carry, [[ZERO] * FALL] * TWIST, [[ZERO] * TWIST] * FALL, hinge.turn)
        met = range(0 if k else TWIST, TWIST + FALL)
        result.append(Stage(_matrix(carry), _matrix(cost), met, k in joints))
    return result


def invariant_form(coefficients: Sequence[Fraction], vectors: int) -> fmpq_mat:
    """A form of some vectors that turns of all of them about e_z leave as it is.

    For each pair a, b of them, a before or at b, come the coefficients of 2 a_z b_z, of 2 (a_x b_x + a_y b_y)
    and for a ≠ b of 2 (a_x b_y − a_y b_x), the first two without the 2 where a is b.
    """
    rows = [[ZERO] * (3 * vectors) for _ in range(3 * vectors)]
    if len(coefficients) != vectors * (3 * vectors + 1) // 2:
        raise ValueError(f"{vectors} vectors have another number of coefficients than {len(coefficients)}")
    rest = iter(coefficients)
    for a in range(vectors):
        for b in range(a, vectors):
            along, across = next(rest), next(rest)
            block = [(2, 2, along), (0, 0, across), (1, 1, across)]
            if a < b:
                skew = next(rest)
                block += [(0, 1, skew), (1, 0, -skew)]
            for i, j, value in block:
                rows[3 * a + i][3 * b + j] = rows[3 * b + j][3 * a + i] = value
    return _matrix(rows)


def slack(stages: Sequence[Stage], k: int, own: fmpq_mat, after: fmpq_mat | None, kappa: fmpq) -> fmpq_mat:
    """s_k(w) + (κ_k − turning_k) u² − cost_k(w') − s_{k+1}(X_{k+1} w') on what occurs of (w, u)."""
    stage, d = stages[k], stages[k].size
    charged = stage.cost
    if after is not None:
        carry = stages[k + 1].carry
        charged = charged + carry.transpose() * after * carry
    step = fmpq_mat(d, d + stage.moves)
    for i in range(d):
        step[i, i] = fmpq(1)
    if stage.moves:
        step[2, d] = fmpq(1)
    if stage.entry is not None:
        step = stage.entry * step
    total = -(step.transpose() * charged * step)
    for i in range(d):
        for j in range(d):
            total[i, j] += own[i, j]
    if stage.moves:
        total[d, d] += kappa - rational(stage.turning)
    met = [*stage.met, *range(d, d + stage.moves)]
    return fmpq_mat([[total[i, j] for j in met] for i in met])


@dataclass(frozen=True)
class Shown:
    """A diagonal bound diag(κ_1, …, κ_n), and for each of some chains the forms that show it; untrusted."""

    prices: tuple[Fraction, ...]
    forms: tuple[Forms, ...]

    def holds(self, chains: Sequence[Sequence[Stage]], vectors: int) -> bool:
        """Whether the condition at each joint of each chain is a positive definite form: then it holds."""
        n, count = len(self.prices), vectors * (3 * vectors + 1) // 2
        sizes = [{len(stages), len(rows)} == {n} for stages, rows in zip(chains, self.forms, strict=False)]
        lengths = {len(row) for rows in self.forms for row in rows}
        if len(chains) != len(self.forms) or not all(sizes) or lengths != {count}:
            return False
        for stages, rows in zip(chains, self.forms, strict=True):
            forms = [invariant_form(row, vectors) for row in rows]
            each = enumerate(zip(forms, [*forms[1:], None], self.prices, strict=True))
            slacks = [slack(stages, k, own, after, rational(kappa)) for k, (own, after, kappa) in each]
            with ctx.workprec(BITS):
                balls = ([list(map(arb, row)) for row in form.tolist()] for form in slacks)
                if not all(map(BALLS.positive_definite, balls)):
                    return False
        return True


def stored_at_base(stages: Sequence[Stage], forms: Sequence[fmpq_mat], fall: Sequence[Fraction]) -> Fraction:
    """s_1(X_1 w_0) with w_0 = (0, γ)."""
    start = stages[0].carry * _matrix([[ZERO]] * TWIST + [[x] for x in fall])
    result = (start.transpose() * forms[0] * start)[0, 0]
    return fraction(result)


def _upright(axis: Sequence[Fraction]) -> list[list[Fraction]]:
    """A rational rotation that takes the axis to (0, 0, 1): half a turn about the line between them."""
    x, y, z = axis
    if z == -1:
        return [[Fraction(1), ZERO, ZERO], [ZERO, Fraction(-1), ZERO], [ZERO, ZERO, Fraction(-1)]]
    middle = [x, y, z + 1]
    scale = Fraction(2) / OF.dot(middle, middle)
    return [[scale * a * b - UNIT[i][j] for j, b in enumerate(middle)] for i, a in enumerate(middle)]


def _cross(a: Sequence[Fraction]) -> list[list[Fraction]]:
    x, y, z = a
    return [[ZERO, -z, y], [z, ZERO, -x], [-y, x, ZERO]]


def _blocks(a: Matrix, b: Matrix, c: Matrix, d: Matrix) -> list[list[Fraction]]:
    upper = [[*left, *right] for left, right in zip(a, b, strict=True)]
    return upper + [[*left, *right] for left, right in zip(c, d, strict=True)]


def _zeros(n: int) -> list[list[Fraction]]:
    return [[ZERO] * n for _ in range(n)]


def _scaled(factor: Fraction | int, rows: Matrix) -> list[list[Fraction]]:
    return [[factor * x for x in row] for row in rows]


def _matrix(rows: Matrix) -> fmpq_mat:
    return fmpq_mat([[rational(x) for x in row] for row in rows])
