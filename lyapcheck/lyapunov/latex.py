"""The formulas of V, dV/dt, Q and Θ' in LaTeX, one expression each, for documents.

References: (12), (13), (15) of ``reyes2019family``.
"""

from __future__ import annotations

from lyapcheck.lyapunov.printed import PRINTED_14, PRINTED_15, Term


def latex_forms() -> dict[str, str]:
    """LaTeX by name: ``V12``, ``V13``, ``14``, ``15``, ``rate``, ``Q``, ``X``, ``Y``, ``S`` and ``theta``."""
    h, eps = r"h_m(\tilde q)", r"\varepsilon"
    potential = r"\sum_i k_{pi} U_m(\tilde q_i)"
    momentum, turned = r"\frac{(M h) \hat e^T}{1 + \|\tilde q\|}", "C(q, h)"
    return {
        "V12": rf"V = \frac{{1}}{{2}} \dot q^T M \dot q + {potential}"
        rf" - {eps} {h}^T M \dot q + \frac{{1}}{{2}} {eps}^2 {h}^T M {h}",
        "V13": rf"V = \frac{{1}}{{2}} [\dot q - {eps} {h}]^T M [\dot q - {eps} {h}] + {potential}",
        "14": r"\dot V = " + latex_sum(PRINTED_14),
        "15": r"\dot V = " + latex_sum(PRINTED_15),
        "rate": rf"\dot V = -{eps} h^T K_p h - (\dot q - {eps} h)^T X \dot q",
        "Q": r"Q = \begin{bmatrix} K_p & -\frac{1}{2} \sqrt{\varepsilon} X \\"
        r" -\frac{1}{2} \sqrt{\varepsilon} X^T & Y \end{bmatrix}",
        "X": rf"X = B + K_v D + {eps} S",
        "Y": rf"Y = B + K_v D + \frac{{1}}{{2}} {eps} (S + S^T)",
        "S": rf"S = {turned} + {momentum} - M H'",
        "theta": r"\Theta' = \begin{bmatrix} \varepsilon k & -\frac{1}{2} \varepsilon (d + \varepsilon c) \\"
        r" -\frac{1}{2} \varepsilon (d + \varepsilon c) & \beta - \varepsilon c \end{bmatrix}",
    }


def latex_sum(terms: tuple[Term, ...]) -> str:
    """The sum of printed terms; a leading plus sign is left out."""
    return " ".join(term.latex for term in terms).removeprefix("+ ")
