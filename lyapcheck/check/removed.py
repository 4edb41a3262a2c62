"""Kinds of statement and rules that were removed, each with the last version that reads them."""

LAST_READ_BY = {
    "ComesToRest": "0.1.0",
    "DecreasingNearby": "0.1.0",
    "Settling": "0.1.0",
    "StaysWithin": "0.1.0",
    "V decreasing at corners": "0.1.0",
    "dominant diagonal": "0.1.0",
    "energy along the links": "0.1.0",
    "falling energy": "0.1.0",
    "falling levels": "0.1.0",
    "falling levels in phases": "0.1.0",
    "forms of the motion": "0.1.0",
    "products of rates": "0.1.0",
    "slower and nearer": "0.1.0",
}
"""Names of kinds and of rules, one a line."""
