"""Properties 2.1–2.8 of an arm, decided."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, Any

from lyapcheck.files import decimal_text
from lyapcheck.robots import RobotModel, trig
from lyapcheck.verdicts import Grade, Verdict

if TYPE_CHECKING:
    from lyapcheck.claims.decision import Decision
    from lyapcheck.constants import Constant

IDS = tuple(f"2.{k}" for k in range(1, 9))
SAYS = {
    "2.1": "M(q) is symmetric and positive definite for all q",
    "2.2": "a constant β_M bounds ‖M(q)‖",
    "2.3": "C(q, 0) = 0",
    "2.4": "Ṁ(q) = C(q,q̇)ᵀ + C(q,q̇), and both are symmetric",
    "2.5": "½ q̇ᵀ[Ṁ − 2C]q̇ = 0, and Ṁ − 2C is skew-symmetric",
    "2.6": "a constant k_c gives ‖C(q,x)y‖ ≤ k_c ‖x‖ ‖y‖",
    "2.7": "0 < λmin(B)‖q̇‖² ≤ q̇ᵀBq̇ ≤ λmax(B)‖q̇‖² for q̇ ≠ 0",
    "2.8": "|g_i(q)| ≤ k_gi, so ‖g(q)‖ is bounded",
}


@dataclass(frozen=True)
class Finding:
    """A verdict with its grade, its method, and a reason, a witness or more evidence where there is one."""

    verdict: Verdict
    grade: Grade
    method: str
    reason: str = ""
    witness: dict[str, Any] | None = None
    evidence: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Property:
    """One property with what was found out about it."""

    id: str
    statement: str
    finding: Finding

    @property
    def verdict(self) -> Verdict:
        """The verdict."""
        return self.finding.verdict


def properties(model: RobotModel, constants: Sequence[Constant], by_script: bool) -> tuple[Property, ...]:
    """The eight properties.

    Args:
        model: the arm.
        constants: its certified constants.
        by_script: whether the paper's proof script is asked first; its determinants grow too large for many
            joints, and what it leaves open is decided on the polynomials and the constants.
    """
    rows = _by_polynomials(model, constants)
    if by_script:
        scripted = _by_script(model)
        rows |= {name: row for name, row in scripted.items() if row.verdict is not Verdict.UNDECIDED}
    if _friction_unknown(model):
        rows["2.7"] = _unknown_friction(model)
    return tuple(Property(name, SAYS[name], rows[name]) for name in IDS)


def _by_script(model: RobotModel) -> dict[str, Finding]:
    from lyapcheck.claims import run_proof

    result = run_proof("published.py", [1], model, None, None, IDS)
    return {row.id: _finding(row.decision) for row in result.claims}


def _finding(decision: Decision) -> Finding:
    return Finding(
        decision.verdict,
        decision.grade,
        decision.method,
        decision.reason,
        decision.witness,
        decision.evidence,
    )


def _by_polynomials(model: RobotModel, constants: Sequence[Constant]) -> dict[str, Finding]:
    known = {constant.name: constant for constant in constants}
    bounded = "a polynomial in sines and cosines is bounded"
    rates = _rates_agree(model)
    return {
        "2.1": _positive_definite(model, known["lambda_min"]),
        "2.2": _proved(Grade.EXACT, bounded, bound=_upper(known["lambda_max"])),
        "2.3": _proved(Grade.EXACT, "C(q, x) = Σ_k c_ijk(q) x_k is linear in x"),
        "2.4": rates,
        "2.5": rates,
        "2.6": _proved(Grade.EXACT, f"{bounded}, and C(q, x) is linear in x", bound=_upper(known["k_c"])),
        "2.7": _friction(model),
        "2.8": _gravity(model, known),
    }


def _positive_definite(model: RobotModel, smallest: Constant) -> Finding:
    """Every link about its own joint has a positive moment, or else λmin(M) has a positive lower bound."""
    if any(model.mass[i][j] != model.mass[j][i] for i, j in product(range(model.n), repeat=2)):
        return _undecided("M is not symmetric as polynomials", "comparison of polynomials")
    chain = model.chain_bounds
    if chain is not None and min(chain.pivots) > 0:
        method = "M = UᵀDU from the tip, where D_k is at least the moment of link k about its own joint"
        return _proved(Grade.EXACT, method, least_pivots=[decimal_text(x) for x in chain.pivots])
    method = "lower bound of λmin(M) over boxes of angles"
    if smallest.enclosure.lower > 0:
        return _proved(Grade.ENCLOSURE, method, bound=smallest.enclosure.decimals(12)[0])
    return _undecided("the lower bound of λmin(M) is not positive yet; give more --max-boxes", method)


def _rates_agree(model: RobotModel) -> Finding:
    """∂M_ij/∂q_k = c_ijk + c_jik as polynomials."""
    symbols = model.christoffel
    for i, j, k in product(range(model.n), repeat=3):
        if trig.derivative(model.mass[i][j], k) != symbols[i][j][k] + symbols[j][i][k]:
            return _undecided(f"∂M{i + 1}{j + 1}/∂q{k + 1} differs from c + cᵀ", "comparison of polynomials")
    return _proved(Grade.EXACT, "∂M_ij/∂q_k = c_ijk + c_jik as polynomials in normal form")


def _friction(model: RobotModel) -> Finding:
    least = min(range(model.n), key=lambda i: model.viscous[i].value)
    value = model.viscous[least].value
    if value > 0:
        return _proved(Grade.EXACT, "B is diagonal with positive entries", least=decimal_text(value))
    point = {f"w{i + 1}": "1" if i == least else "0" for i in range(model.n)}
    sides = {"left": ["0", "0"], "operator": "<", "right": [decimal_text(value)] * 2}
    reason = f"joint {model.joints[least]} has no viscous friction; state one in an arm file if it has"
    return _refuted(Grade.EXACT, "evaluation", {"point": point, **sides}, reason)


def _friction_unknown(model: RobotModel) -> bool:
    return any(number.assumed and number.value == 0 for number in model.viscous)


def _unknown_friction(model: RobotModel) -> Finding:
    names = zip(model.joints, model.viscous, strict=True)
    missing = ", ".join(joint for joint, number in names if number.assumed and number.value == 0)
    reason = f"no viscous friction is known of {missing}; state it in an arm file that names this URDF"
    return _undecided(reason, "reading of the file")


def _gravity(model: RobotModel, known: dict[str, Constant]) -> Finding:
    """Bounded anyway; where the source prints k_gi, they have to be bounds."""
    for i, printed in enumerate(model.gravity_bound):
        constant = known[f"k_g{i + 1}"]
        if printed is not None and constant.enclosure.lower > printed.value:
            return _too_small(i, printed.value, constant)
    open_ones = [
        f"k_g{i + 1}"
        for i, printed in enumerate(model.gravity_bound)
        if printed is not None and known[f"k_g{i + 1}"].enclosure.upper > printed.value
    ]
    if open_ones:
        reason = f"{', '.join(open_ones)} as printed lie within the enclosure; give more --max-boxes"
        return _undecided(reason, "bounds over boxes of angles")
    grade = Grade.EXACT if not any(model.gravity_bound) else Grade.ENCLOSURE
    return _proved(grade, "a polynomial in sines and cosines is bounded", bound=_upper(known["k_g"]))


def _too_small(i: int, printed: Fraction, constant: Constant) -> Finding:
    point: dict[str, Any] = {f"q{k + 1}": repr(x) for k, x in enumerate(constant.state)}
    ends = list(constant.enclosure.decimals(12))
    sides = {"left": ends, "operator": "≤", "right": [decimal_text(printed)] * 2}
    return _refuted(
        Grade.ENCLOSURE, "evaluation", {"point": point, **sides}, f"k_g{i + 1} as printed is too small"
    )


def _upper(constant: Constant) -> str:
    return constant.enclosure.decimals(12)[1]


def _proved(grade: Grade, method: str, **evidence: Any) -> Finding:
    return Finding(Verdict.PROVED, grade, method, evidence=evidence)


def _undecided(reason: str, method: str) -> Finding:
    return Finding(Verdict.UNDECIDED, Grade.NUMERIC, method, reason)


def _refuted(grade: Grade, method: str, witness: dict[str, Any], reason: str) -> Finding:
    return Finding(Verdict.REFUTED, grade, method, reason, witness)
