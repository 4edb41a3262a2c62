"""Bounds for all angles at once from storage forms along a chain of links, certified in balls.

Let w be what link k hands on to the next one (its twist, say), u what its joint adds, and s_k a quadratic
form that turns about joint k leave as it is. If for k = 1, …, n and all w and u

    s_k(w) + κ·price(w, u) ≥ cost_k(w') + s_{k+1}(X_{k+1} w'),      w' = w + b(u),      s_{n+1} = 0,

where X_{k+1} moves w' into the frame of the next joint at q = 0, then for all angles Σ cost_k ≤ κ Σ price:
the turn by q_k changes nothing in s_k, and the sum telescopes. The least κ for which there are such forms is
the value of a small semidefinite program, whatever the number of joints, and it comes close to the truth:
the angles are gone without any box.

References: dissipation inequalities and storage functions, willems1972dissipative.
"""

from lyapcheck.constants.storage.bounds import storage_proof

__all__ = ["storage_proof"]
