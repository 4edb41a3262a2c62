"""Certificates: statements, proofs, and the one judge that tells what a proof shows.

Statements and proofs are plain data that JSON carries; :func:`verify` recomputes the verdict from them alone.
Everything here rests on the standard library and python-flint only.
"""

from lyapcheck.check.certificates import rules
from lyapcheck.check.certificates.refusal import Refused
from lyapcheck.check.certificates.verify import Accepted, verify

__all__ = ["Accepted", "Refused", "rules", "verify"]
