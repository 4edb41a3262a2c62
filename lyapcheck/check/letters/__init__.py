"""Identities between vectors and matrices that hold for every n.

Beside the expressions of ``check.expressions``, there are vectors of Rⁿ and n × n matrices:

    vectors    ("vec", "w")  ("sum", x, y, ...)  ("scale", s, x)  ("apply", A, x)
    matrices   ("mat", "M")  ("diag", "w")  ("transpose", A)  ("sum", A, B, ...)  ("scale", s, A)
    numbers    ("dot", x, y)  ("rate", s)   and the operations of ``check.expressions``

``sum`` of nothing is 0, ``diag`` is the diagonal matrix of a vector, ``rate`` the derivative by time.

- ``grammar``: which expressions are well formed;
- ``rates``: the product rule, with the derivative of each letter given;
- ``words``: numbers as expressions in words xᵀ A B … y, each in a normal form;
- ``entries``: the same at one n, entry by entry, without the above; counterexamples are replayed there.

References: ``geddes1992algorithms``, chapter 3.
"""
