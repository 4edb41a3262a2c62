"""Running the gate: read, decide, write."""

from __future__ import annotations

import os
import sys

from lyapcheck.control.gains import read_gain_file
from lyapcheck.errors import InputError, Problem
from lyapcheck.gating.formats import renderer
from lyapcheck.gating.gate import DECIDING, GateResult, gate, gate_exit
from lyapcheck.output.escapes import document_text
from lyapcheck.verdicts import Exit

TYPE_CHECKING = False
if TYPE_CHECKING:
    from lyapcheck.cli.gate_options import GateCall
    from lyapcheck.control.known_arms import ArmLimits

SUMMARY = "GITHUB_STEP_SUMMARY"
"""The variable by which GitHub names the file that it shows under a job."""
LARGEST_SUMMARY = 1_000_000
"""Bytes; GitHub refuses more than a mebibyte."""


def run(call: GateCall) -> Exit:
    """Judge the files of a call and write the results to standard output.

    Returns:
        the exit code.

    Raises:
        InputError: a file cannot be used; the results of the others have been written.
    """
    results: list[GateResult] = []
    problems: list[Problem] = []
    arms: dict[str, ArmLimits] = {}
    conditions = call.conditions or DECIDING
    for file in call.files:
        try:
            gain_file = read_gain_file(file)
            results += gate(gain_file, call.robot, conditions, call.gamma, call.strict, arms)
        except InputError as error:
            problems += error.problems
    if results:
        if call.certificates is not None:
            _write_certificates(call.certificates, results)
        sys.stdout.write(document_text(renderer(call.format)(results)))
        if call.format == "github" and os.environ.get(SUMMARY):
            _append_summary(os.environ[SUMMARY], results)
    if problems:
        sys.stdout.flush()
        raise InputError(problems)
    return gate_exit(results)


def _write_certificates(folder: str, results: list[GateResult]) -> None:
    """One file for each check that was decided."""
    from pathlib import Path

    from lyapcheck.cli.output import open_folder, write_whole
    from lyapcheck.gating.documents import certificates

    made, place = certificates(results), open_folder("--certificates", Path(folder))
    for name, certificate in made.items():
        write_whole(place / name, certificate.text())


def _append_summary(path: str, results: list[GateResult]) -> None:
    """Add the results in Markdown to the summary of the job; of too many only those that did not pass."""
    render = renderer("markdown")
    text = render(results)
    if len(text.encode()) > LARGEST_SUMMARY:
        others = [result for result in results if result.failures]
        size = len(render(others).encode())
        shown = others[: max(1, len(others) * LARGEST_SUMMARY // max(size, LARGEST_SUMMARY))]
        passed = f"{len(results) - len(others)} of {len(results)} gain sets accepted"
        text = f"{passed}, {len(shown)} of the others:\n\n{render(shown)}"
    try:
        with open(path, "a", encoding="utf-8") as stream:
            stream.write(text)
    except OSError as error:
        raise InputError(
            Problem("environment", None, SUMMARY, path, f"cannot be written ({error.strerror})", "unset it")
        ) from error
