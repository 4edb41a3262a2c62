"""The language of proofs, and the search for what decides a claim."""
