"""The report as versioned JSON."""

from __future__ import annotations

import json
from dataclasses import asdict

from lyapcheck.report.model import SCHEMA, Report


def render(report: Report) -> dict[str, str]:
    """One file, ``report.json``, with everything but the figures' drawing."""
    document = {
        "schema": SCHEMA,
        "m": list(report.ms),
        "robot": report.robot,
        "counts": report.counts(),
        "findings": [asdict(finding) for finding in report.findings],
        "table": report.table,
        "gate": report.gate,
        "epsilon": report.epsilon,
        "claims": report.claims,
        "instead": report.instead,
        "runs": report.runs,
        "sensitivity": report.sensitivity,
        "figures": sorted(report.figures),
        "versions": dict(report.versions),
        "seed": report.seed,
    }
    return {"report.json": json.dumps(document, ensure_ascii=False, indent=1) + "\n"}
