"""``lyapcheck export``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.show import open_folder, show, write_whole
from lyapcheck.cli.values import Complaints, gains_on_arm, loop_of, require_joints
from lyapcheck.errors import InputError, Problem, argument_error
from lyapcheck.files.reader import holds
from lyapcheck.output.answer import FORMATS
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser
    from lyapcheck.control.sampling import LoopRecord

MOST_HELD = 1000


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_gain_file()
    about = "Folder for the files. It is created if it does not exist."
    parser.add_argument("--out", metavar="DIR", type=Path, help=about)
    about = "Readings jump at a full turn, and NAME_step counts turns."
    parser.add_argument("--wrapped", action="store_true", help=about)
    about = "Number of samples without a good reading that repeat the last torque."
    parser.add_number("--hold-samples", int, about, default=3, least=0, most=MOST_HELD)
    parser.add_loop()
    parser.add_robot()
    parser.add_format(FORMATS)


def run(
    file: Path,
    out: Path | None,
    wrapped: bool,
    hold_samples: int,
    robot: str | None,
    format: str,  # noqa: A002
    **options: str | None,
) -> Exit:
    """Write each gain set as a controller in C99, with a computed bound of rounding.

    The files are NAME.h, NAME.c, NAME_test.c and NAME.json, with the name of the gain set. NAME_torque
    computes K_p h(e) − K_v h(w) + g(q). NAME_step reads angles at a rate and keeps each torque within the
    motor limit. NAME_sampled.json is a certificate of the longest proved period, if there is one.

    Exit code 0: the files are written, for any verdict of the gate, 2: a file cannot be used, or another file
    has its name.

    Examples:
      lyapcheck export gains.toml --out controller --rate 1000
      lyapcheck export gains.toml --out arm --rate 400 --filter 0.5,0.5 --wrapped
    """
    from lyapcheck.answers.export import export
    from lyapcheck.control.sampling import record_of

    wrong = Complaints()
    said = wrong.reading(loop_of, options)
    gain_file, _, model = wrong.result(gains_on_arm, file, robot)
    assert said is not None
    require_joints([gain_file], model)
    loop = _runnable(record_of(said, gain_file.loop, model.loop))
    if out is None:
        raise argument_error("--out", "", "is missing", "name a folder: --out controller")
    answer = export(gain_file, model, loop, wrapped=wrapped, hold=hold_samples)
    files = {name: text for one in answer.sets for name, text in one.files.items()}
    folder = open_folder("--out", out)
    paths = {folder / name: text.encode() for name, text in files.items()}
    others = [path for path, data in paths.items() if path.exists() and not holds(path, data)]
    if others:
        rule, repair = "is there already, with other content", "name another folder, or move it away"
        raise InputError([Problem("argument", None, "--out", str(path), rule, repair) for path in others])
    for path, data in paths.items():
        write_whole(path, data)
    show(answer, format)
    return Exit.PROVED


def _runnable(loop: LoopRecord | None) -> LoopRecord:
    """A loop that ``NAME_step`` can run."""
    if loop is None or loop.period is None:
        rule = "is missing: NAME_step divides differences by its period"
        raise argument_error("--rate", "", rule, "add --rate 1000, or rate = 1000 under [loop]")
    if loop.velocity != "difference":
        rule = "is nothing that NAME_step can have; it takes differences"
        raise argument_error(
            "velocity", loop.velocity, rule, "say difference, and call NAME_torque with rates"
        )
    if loop.lowpass is not None:
        rule = "is no filter of finitely many taps"
        raise argument_error("lowpass", float(loop.lowpass), rule, "give its taps: --filter 0.5,0.5")
    return loop
