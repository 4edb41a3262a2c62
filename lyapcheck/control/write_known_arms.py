"""``python -m lyapcheck.control.write_known_arms``: keep the limits of the built-in arms as they are now."""

from __future__ import annotations

from pathlib import Path
from pprint import pformat

from lyapcheck.control.known_arms import checksum
from lyapcheck.control.model_limits import model_limits
from lyapcheck.robots import load, names


def data_text() -> str:
    """The text of ``known_arms_data.py``, from the arm files as they are."""
    arms = {}
    for name in names():
        arm = model_limits(load(name))
        torque = tuple(None if limit is None else str(limit) for limit in arm.torque)
        gravity = tuple(map(str, arm.gravity))
        notes = arm.torque_notes, arm.viscous_notes
        arms[name] = (checksum(name), arm.joints, torque, gravity, str(arm.viscous_min), *notes)
    return _HEAD + f"ARMS: Arms = {pformat(arms, width=106, sort_dicts=False)}\n"


_HEAD = '''\
"""Written by ``python -m lyapcheck.control.write_known_arms``: not to be edited."""

from __future__ import annotations

# fmt: off
TYPE_CHECKING = False
if TYPE_CHECKING:
    Texts = tuple[str, ...]
    Arms = dict[str, tuple[int, Texts, tuple[str | None, ...], Texts, str, Texts, Texts]]

'''


def main() -> None:
    """Write ``known_arms_data.py``."""
    Path(__file__).with_name("known_arms_data.py").write_text(data_text(), encoding="utf-8")


if __name__ == "__main__":
    main()
