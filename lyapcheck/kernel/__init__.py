"""Certificates before Coq's kernel: statements printed as theorems, proved there, their axioms read back.

Nothing here decides: what is accepted is what ``coqc`` accepts, and the statement of each theorem is printed
from the data of the certificate alone. The definitions that such a statement is made of stand on one page,
``formal/Definitions.v``; see ``docs/kernel.md``.
"""
