"""V of (12) and (13) and its derivative along (11), exactly, for any number of joints; and in SymPy.

Two independent ways: polynomials over ℚ in generators (``lyapunov_12``, ``lyapunov_13``, ``rate``), in which
identities are decided, and SymPy functions of time (``sympy_lyapunov``, ``sympy_rate``), differentiated by
SymPy itself.

References: (11)–(15) of ``reyes2019family``.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from flint import fmpq_mpoly

from tests.proofs.derivation.generators import dot, generators, times
from tests.proofs.derivation.printed import printed_14, printed_15

__all__ = ["lyapunov_12", "lyapunov_13", "printed_14", "printed_15", "rate", "sympy_lyapunov", "sympy_rate"]


def lyapunov_12(n: int) -> fmpq_mpoly:
    """V as (12) prints it: ½wᵀMw + Σ k_pi U_i − ε hᵀMw + ½ε² hᵀMh.

    The printed second term is (1/2m) uᵀK_p u with u_i = √ln(1 + sinh^{2m} e_i), that is Σ k_pi U_i.
    """
    ring = generators(n)
    h, w, kp, U = (ring.vector(name) for name in ("h", "w", "kp", "U"))
    Mw, Mh = times(ring.M, w), times(ring.M, h)
    energy = ring.half * dot(w, Mw) + dot(kp, U)
    return ring.normal_form(energy - ring.eps * dot(h, Mw) + ring.half * ring.eps**2 * dot(h, Mh))


def lyapunov_13(n: int) -> fmpq_mpoly:
    """V as (13) prints it: ½(w − εh)ᵀM(w − εh) + Σ k_pi U_i."""
    ring = generators(n)
    h, w, kp, U = (ring.vector(name) for name in ("h", "w", "kp", "U"))
    y = [a - ring.eps * b for a, b in zip(w, h, strict=True)]
    return ring.normal_form(ring.half * dot(y, times(ring.M, y)) + dot(kp, U))


def rate(n: int) -> fmpq_mpoly:
    """dV/dt of (12) along (11), as a normal form: what (14) and (15) must equal.

    Soundness: uses Ṁ = C + Cᵀ (property 2.4) and nothing else about C.
    """
    return generators(n).rate(lyapunov_12(n))


def sympy_lyapunov(n: int) -> Any:
    """V of (12) in SymPy, with e_i, w_i and M_ij as functions of t."""
    import sympy as sp

    _, e, w, M = _motion(n)
    h, _, U = _family()
    joints = range(n)
    kp = [sp.Symbol(f"kp{i + 1}") for i in joints]
    eps = sp.Symbol("eps0") / (1 + sp.sqrt(sum(x**2 for x in e)))
    y = [w[i] - eps * h(e[i]) for i in joints]
    kinetic = sum(M[i][j] * y[i] * y[j] for i in joints for j in joints) / 2
    return kinetic + sum(kp[i] * U(e[i]) for i in joints)


def sympy_rate(n: int) -> Any:
    """dV/dt in SymPy: V differentiated by t, then ė, ẇ and Ṁ put in; ẇ_i stays as the symbol a_i.

    In the symbols of ``tests.proofs.derivation.generators`` (without ri and s): a rational function of r.
    """
    import sympy as sp

    t, e, w, M = _motion(n)
    h, dh, U = _family()
    joints = range(n)
    C = [[sp.Symbol(f"C{i + 1}_{j + 1}") for j in joints] for i in joints]
    moving = {e[i].diff(t): -sp.Symbol(f"w{i + 1}") for i in joints}
    moving |= {w[i].diff(t): sp.Symbol(f"a{i + 1}") for i in joints}
    moving |= {M[i][j].diff(t): C[i][j] + C[j][i] for i in joints for j in range(i, n)}
    still = {sp.sqrt(sum(x**2 for x in e)): sp.Symbol("r")}
    for i in joints:
        k = i + 1
        still |= {
            function(e[i]): sp.Symbol(f"{name}{k}") for function, name in ((h, "h"), (dh, "d"), (U, "U"))
        }
        still |= {M[i][j]: sp.Symbol(f"M{k}_{j + 1}") for j in range(i, n)}
    last = {x: sp.Symbol(f"{name}{i + 1}") for name, xs in (("e", e), ("w", w)) for i, x in enumerate(xs)}
    return sympy_lyapunov(n).diff(t).xreplace(moving).subs(still).xreplace(last)


def _motion(n: int) -> tuple[Any, list[Any], list[Any], list[list[Any]]]:
    """t, and e_i, w_i, M_ij as functions of it."""
    import sympy as sp

    t, joints = sp.Symbol("t"), range(n)
    e, w = ([sp.Function(f"{name}{i + 1}")(t) for i in joints] for name in "ew")
    M = [[sp.Function(f"M{min(i, j) + 1}_{max(i, j) + 1}")(t) for j in joints] for i in joints]
    return t, e, w, M


@cache
def _family() -> tuple[Any, Any, Any]:
    """h, h' and U as SymPy functions that know U' = h and (h)' = h'."""
    import sympy as sp

    dh = sp.Function("dh")
    h = type("h", (sp.Function,), {"fdiff": lambda self, argindex=1: dh(self.args[0])})
    U = type("U", (sp.Function,), {"fdiff": lambda self, argindex=1: h(self.args[0])})
    return h, dh, U
