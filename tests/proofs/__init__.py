"""The shipped proofs."""
