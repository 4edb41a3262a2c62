"""``python -m tests.cli.user_files``: each kind of file that a user names, in each way that it may be none.

What is printed, as JSON, is how each command ended. The memory of this process may grow by ``GROWTH``: what
reads without end fails here. Each command reads a missing file first: what it imports is no growth.
"""

import json
import os
import resource
import shutil
import sys
import threading
from pathlib import Path

from tests.helpers.command import lyapcheck
from tests.helpers.one_process import one_process

GROWTH = 100_000_000
GAINS = 'robot = "pendulum1"\n[[gains]]\nname = "one"\nm = 1\nkp = [0.5]\nkv = [0.1]\n'
OVERLAY = 'title = "An arm"\nurdf = "bad.urdf"\n'
COMMANDS = {
    "gain file of gate": "gate bad.toml",
    "gain file of epsilon": "epsilon bad.toml",
    "gain file of bounds": "bounds bad.toml",
    "gain file of simulate": "simulate bad.toml",
    "gain file of export": "export bad.toml --out c --rate 1000",
    "gain file of check": "check published.py --only 7b --m 1 --gains bad.toml",
    "gain file of report": "report --m 1 --gains bad.toml",
    "arm of gate": "gate gains.toml --robot bad.toml",
    "arm of robot": "robot bad.toml",
    "arm of tune": "tune bad.toml",
    "arm of report": "report --m 1 --robot bad.toml",
    "URDF file": "robot bad.urdf",
    "URDF file of an arm file": "robot overlay.toml",
    "URDF file of tune": "tune bad.urdf",
    "plan": "sweep bad.toml",
    "reference": "simulate gains.toml --reference bad.toml",
    "proof script": "check bad.py",
    "proof script of explain": "explain 1 --proof bad.py",
    "certificate": "recheck bad.json",
    "older report": "report --m 1 --compare bad.json",
}
KINDS = ("missing", "device", "pipe", "folder", "huge", "no text", "unreadable")
ENDINGS = (".toml", ".urdf", ".csv", ".py", ".json")
HUGE = 110_000_000


def put(kind, folder):
    """``bad`` with each ending, of one kind."""
    for ending in ENDINGS:
        path = folder / f"bad{ending}"
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        path.unlink(missing_ok=True)
        if kind == "device":
            path.symlink_to("/dev/zero")
        elif kind == "pipe":
            os.mkfifo(path)
        elif kind == "folder":
            path.mkdir()
        elif kind == "huge":
            path.touch()
            os.truncate(path, HUGE)
        elif kind == "no text":
            path.write_bytes(b"\xff\xfe\x00\xd8" * 5)
        elif kind == "unreadable":
            path.symlink_to("/proc/self/mem")  # a regular file that not even root reads from its start


def main(folder):
    """Run all commands on all kinds in a folder, and print a list of what came of it."""
    for name, text in (("gains", GAINS), ("overlay", OVERLAY)):
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    threading.stack_size(1 << 18)  # those of timers that are cancelled and not yet gone are no growth either
    result = []
    with one_process():
        for kind in KINDS:
            put(kind, folder)
            if kind == KINDS[1]:
                pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
                most = pages * resource.getpagesize() + GROWTH
                resource.setrlimit(resource.RLIMIT_AS, (most, most))
            for what, line in COMMANDS.items():
                done = lyapcheck(*line.split(), folder=folder)
                result.append((kind, what, done.returncode, done.stdout, done.stderr))
    print(json.dumps(result))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
