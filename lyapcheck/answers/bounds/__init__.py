"""How far from their goal gain sets let an arm rest under dry friction: proved, beside simulated motions."""

from lyapcheck.answers.bounds.answer import Comparisons, certificates, comparison_data
from lyapcheck.answers.bounds.compare import BoundsComparison, compare

__all__ = ["BoundsComparison", "Comparisons", "certificates", "compare", "comparison_data"]
