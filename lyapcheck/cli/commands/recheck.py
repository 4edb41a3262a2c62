"""``lyapcheck recheck``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.check.judgement import MOST, Limits
from lyapcheck.check.recheck import Outcome
from lyapcheck.cli.show import current_view, open_folder, progress
from lyapcheck.errors import installed, lacking
from lyapcheck.rechecking import FORMATS, HELP
from lyapcheck.rechecking import run as judge

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser


def arguments(parser: Parser) -> None:
    """What the command takes."""
    about = "Certificate files, or folders with certificates."
    parser.add_argument("certificates", metavar="CERTIFICATE...", nargs="+", help=about)
    parser.add_argument("--full", action="store_true", help=HELP["full"])
    parser.add_argument("--trusted", action="store_true", help=HELP["trusted"])
    parser.add_number("--seconds", int, HELP["seconds"], default=Limits.seconds, least=1, most=MOST)
    parser.add_number("--memory", int, HELP["memory"], default=Limits.memory, least=1, most=MOST)
    about = "Also ask the kernel of Coq about each certificate. This needs coqc."
    parser.add_argument("--kernel", action="store_true", help=about)
    about = "The same, and keep the files for Coq in this folder."
    parser.add_argument("--kernel-files", metavar="DIR", type=Path, help=about)
    parser.add_format()


def run(
    certificates: list[str],
    full: bool,
    trusted: bool,
    seconds: int,
    memory: int,
    kernel: bool,
    kernel_files: Path | None,
    format: str,  # noqa: A002
) -> int:
    """Verify certificates with the small checker alone, and give the reason for each that is not accepted.

    Each statement is printed from its data. The author's description is in quotation marks. A certificate is
    undecided while a certificate that it uses is missing.

    Exit code 0: all accepted, 1: some refused, 2: a file cannot be read, 3: some undecided and none refused,
    4: a statement is both proved and refuted.

    Examples:
      lyapcheck recheck proof/
      lyapcheck recheck proof/16.6.json --trusted
      lyapcheck recheck proof/ --kernel
    """
    if not installed("flint"):  # else it is the process that judges that does not start
        raise lacking("flint")
    if kernel or kernel_files is not None:
        from lyapcheck.answers.recheck import writer

        folder = None if kernel_files is None else open_folder("--kernel-files", kernel_files)
        with progress("kernel") as advance:
            both = writer(format, seconds, folder, lambda note: advance(0, note), current_view())
            return judge(certificates, format, full, trusted, seconds, memory, {format: both})

    def written(outcome: Outcome, with_trusted: bool) -> str:
        from lyapcheck.answers.recheck import Recheck

        return Recheck(outcome, with_trusted).written(format, current_view())

    formats = {format: written, "json": FORMATS["json"]}  # which is the checker's own
    return judge(certificates, format, full, trusted, seconds, memory, formats)
