"""Certificates: statements, proofs, and the one judge that tells what a proof shows.

Statements and proofs are plain data that JSON carries; :func:`verify` recomputes the verdict from them alone.

- ``statements``, ``every_n``, ``proofs``: the data; ``well_formed``, ``trees``: what makes a statement one;
- ``rules``: one file a kind of statement, a function for each class of proofs that may decide it;
- ``document``: a statement with its proof, verdict and digest as JSON; ``codec`` reads it strictly;
- ``recheck``, ``files``, ``render``: many documents, what they rest on, and the outcome in print.

A new kind of statement is a data class there, an entry in ``well_formed.FORMS`` and a file of rules.
Everything here rests on the standard library and python-flint only.
"""

from lyapcheck.check.certificates import rules
from lyapcheck.check.certificates.refusal import Refused
from lyapcheck.check.certificates.verify import Accepted, verify

__all__ = ["Accepted", "Refused", "rules", "verify"]
