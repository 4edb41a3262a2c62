"""What takes long to make, made once for all processes that run tests."""

import fcntl
import os
import pickle
from typing import TypeVar

Made = TypeVar("Made")


def once(tmp_path_factory, name, make):
    """What ``make`` returns, pickled: the first process that asks makes it, the others wait and read it."""
    place = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        place = place.parent  # each worker has a folder of its own in that of the run
    path = place / f"{name}.pickle"
    with (place / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not path.exists():
            path.write_bytes(pickle.dumps(make()))
        result = pickle.loads(path.read_bytes())
    return result
