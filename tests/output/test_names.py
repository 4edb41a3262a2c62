"""Signs that a terminal cannot show have names in ASCII."""

import pytest

from lyapcheck.output.document import Document, Table
from lyapcheck.output.names import spelled
from lyapcheck.output.text import View, render

NAMES = {
    "ε₀ ≤ 0.16, γ_m, λmin(M) ≻ 0": "eps0 <= 0.16, gamma_m, lambda_min(M) > 0",
    "‖τ‖ − k_g, √n γ, √(2)": "||tau|| - k_g, sqrt n gamma, sqrt(2)",
    "q̇ᵀM(q)ẇ, q̃, q̈, zᵀΘz": "q_dot^T M(q)w_dot, q_tilde, q_ddot, z^T Theta_z",
    "10⁻¹² N·m·s/rad, kg·m²": "10^-12 N*m*s/rad, kg*m^2",
    "k₂ and x₁₂, 45°, (0, 0)°, [°]": "k_2 and x_12, 45 deg, (0, 0) deg, [deg]",
    "✓ “a” → ½ ± 2…": '[ok] "a" -> 1/2 +- 2...',
    "bras n° é, ñ, 中": "bras n deg e, n, \\u4e2d",
}


@pytest.mark.parametrize(("text", "ascii_text"), NAMES.items())
def test_signs_have_names(text, ascii_text):
    assert spelled(text, "ascii") == ascii_text
    assert spelled(text, "utf-8") == text


def test_an_encoding_keeps_the_signs_that_it_has():
    assert spelled("é 45° ε₀", "cp1252") == "é 45° eps0"


def test_columns_are_aligned_by_the_names():
    document = Document(
        "✓ a", (Table(("", "ε₀", "N·m"), (("✓", "1.5", "Λ"), ("✗", "12.25", "x")), align="lrl"),)
    )
    assert render(document, View(encoding="ascii")).splitlines() == [
        "[ok] a",
        "",
        "       eps0  N*m",
        "[ok]   1.5   Lambda",
        "[x]   12.25  x",
    ]
