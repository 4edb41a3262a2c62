"""A real Dask scheduler with two workers, one of which is killed halfway; rows as Parquet and DataFrame.

Run by ``make test-sweep``, which installs the extra ``sweep``.
"""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from pyarrow import parquet

import lyapcheck
from tests.sweep.test_sweep import PLAN, contents, program, rows_after

MANY = PLAN.replace("step = 0.05", "step = 0.0002")
PATIENCE = 300
"""Seconds, for a machine that has other things to do."""


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    path = tmp_path / "plan.toml"
    path.write_text(MANY, encoding="utf-8")
    return path


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """The address of a scheduler, and its two workers."""
    told = tmp_path / "scheduler.json"
    dask, common = (
        [sys.executable, "-m", "dask"],
        {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL},
    )
    started = [
        subprocess.Popen(
            [
                *dask,
                "scheduler",
                "--host",
                "127.0.0.1",
                "--port",
                "0",
                "--no-dashboard",
                "--scheduler-file",
                str(told),
            ],
            **common,
        )
    ]
    try:
        until(lambda: told.exists() and told.read_text().strip().endswith("}"))
        worker = [
            *dask,
            "worker",
            "--scheduler-file",
            str(told),
            "--nthreads",
            "1",
            "--no-nanny",
            "--no-dashboard",
        ]
        for number in range(2):
            folder = tmp_path / f"worker{number}"
            started.append(subprocess.Popen([*worker, "--local-directory", str(folder)], **common))
        yield json.loads(told.read_text())["address"], started[1:]
    finally:
        for process in started:
            process.kill()
            process.wait()


def until(done) -> None:
    """Wait for something that comes for certain."""
    end = time.monotonic() + PATIENCE
    while not done():
        assert time.monotonic() < end, "it does not come"
        time.sleep(0.05)


def workers_of(address: str) -> int:
    from distributed import Client

    with Client(address, set_as_default=False) as client:
        return len(client.scheduler_info(n_workers=-1)["workers"])


def test_a_worker_is_killed_in_the_middle_and_no_byte_changes(plan: Path, tmp_path: Path, cluster) -> None:
    address, workers = cluster
    until(lambda: workers_of(address) == 2)
    out = tmp_path / "out"
    words = program("sweep", plan, "--out", out, "--scheduler", address)
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as process:
        until(lambda: process.poll() is not None or len(list(out.glob("certificates/*.json"))) > 50)
        workers[0].send_signal(signal.SIGKILL)
        errors = process.communicate(timeout=PATIENCE)[1].decode()
    assert process.returncode == 1, errors  # some gains are rejected
    until(lambda: workers_of(address) == 1)
    rows = rows_after(["sweep", plan, "--out", tmp_path / "alone", "--jobs", 1], tmp_path / "alone")
    assert contents(out) == contents(tmp_path / "alone")
    assert [row["index"] for row in rows] == list(range(len(rows)))
    table = parquet.read_table(out / "rows.parquet").to_pylist()
    assert [{**row, "answer": json.loads(row["answer"])} for row in table] == rows


def test_rows_become_a_data_frame(plan: Path) -> None:
    plan.write_text(PLAN, encoding="utf-8")
    frame = lyapcheck.sweep(plan, workers=1).frame()
    assert list(frame["index"]) == list(range(16))
    assert set(frame["verdict"]) == {"accepted", "rejected"}


def test_an_address_without_a_scheduler_is_refused(plan: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from lyapcheck.answers import sweep as asking

    monkeypatch.setattr(asking, "PATIENCE", 1)
    with pytest.raises(lyapcheck.InputError, match="does not answer"):
        next(lyapcheck.sweep(plan, scheduler="tcp://127.0.0.1:1"))
