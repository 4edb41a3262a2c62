"""A real browser without a window: Chromium, spoken to in the DevTools protocol."""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.request import Request, urlopen

from websockets.sync.client import ClientConnection, connect

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
FLAGS = (
    "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
    "--hide-scrollbars", "--remote-debugging-port=0", "--remote-allow-origins=*",
)  # fmt: skip
PATIENCE = 60.0
"""Seconds until a browser that does not answer is given up."""


class Tab:
    """One page in a browser.

    ``errors`` are what the console and uncaught exceptions said.
    """

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self._number = 0
        self.errors: list[str] = []
        self._loaded = False
        for domain in ("Page", "Runtime", "Log", "DOM"):
            self.send(f"{domain}.enable")

    def send(self, method: str, **params: Any) -> dict[str, Any]:
        """The result of a command of the protocol."""
        self._number += 1
        self._socket.send(json.dumps({"id": self._number, "method": method, "params": params}))
        while True:
            message = json.loads(self._socket.recv(timeout=PATIENCE))
            if message.get("id") == self._number:
                assert "error" not in message, message
                return dict(message["result"])
            self._event(message)

    def _event(self, message: dict[str, Any]) -> None:
        method, params = message["method"], message["params"]
        self._loaded |= method == "Page.loadEventFired"
        if method == "Runtime.exceptionThrown":
            self.errors.append(json.dumps(params["exceptionDetails"]))
        if method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning"):
            self.errors.append(json.dumps(params["args"]))
        if method == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.errors.append(params["entry"]["text"])

    def open(self, page: Path, place: str = "") -> None:
        """Load a page and wait until it is there."""
        for address in ("about:blank", page.as_uri() + (f"#{place}" if place else "")):
            self._loaded = False
            self.errors.clear()
            self.send("Page.navigate", url=address)
            while not self._loaded:
                self._event(json.loads(self._socket.recv(timeout=PATIENCE)))

    def arrives(self, ending: str) -> bool:
        """Whether the tab comes to an address with an ending; without a script, which leaving would end."""
        until = time.monotonic() + PATIENCE
        while time.monotonic() < until:
            history = self.send("Page.getNavigationHistory")
            if history["entries"][history["currentIndex"]]["url"].endswith(ending):
                return True
            time.sleep(0.05)
        return False

    def run(self, script: str) -> Any:
        """The value of an expression, or of what it promises."""
        result = self.send(
            "Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True, userGesture=True
        )
        assert "exceptionDetails" not in result, result
        return result["result"].get("value")

    def enter(self, selector: str, value: object) -> None:
        """Put a value into the first control that a selector finds, as a user does."""
        result = f"document.querySelector({json.dumps(selector)})"
        self.run(f"{result}.value = {json.dumps(value)}; {result}.dispatchEvent(new Event('input'))")

    def later(self, script: str, milliseconds: int = 100) -> Any:
        """The value of an expression after a while."""
        return self.run(f"new Promise(done => setTimeout(() => done({script}), {milliseconds}))")

    def size(self, width: int, height: int = 900) -> None:
        """The size of the window in pixels."""
        mobile = width < 500
        self.send(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=mobile,
        )

    def media(self, kind: str = "", scheme: str = "light") -> None:
        """Screen or paper, and light or dark."""
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        self.send("Emulation.setEmulatedMedia", media=kind, features=features)

    def press(self, key: str) -> None:
        """One key, down and up."""
        code = {"Tab": 9, "Enter": 13}[key]
        text = {"text": "\r"} if key == "Enter" else {}
        for kind in ("keyDown", "keyUp"):
            self.send(
                "Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code, **text
            )

    def picture(self, whole: bool = False) -> bytes:
        """What is seen, or the whole page, as PNG."""
        return base64.b64decode(self.send("Page.captureScreenshot", captureBeyondViewport=whole)["data"])

    def paper(self) -> bytes:
        """The page as it is printed, as PDF."""
        return base64.b64decode(self.send("Page.printToPDF", preferCSSPageSize=True)["data"])


@contextmanager
def browser() -> Iterator[Tab]:
    """A browser of its own with one empty page."""
    assert CHROMIUM is not None, "install chromium"
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as home:
        process = subprocess.Popen(
            [CHROMIUM, *FLAGS, f"--user-data-dir={home}", "about:blank"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            with connect(_new_tab(Path(home, "DevToolsActivePort")), max_size=None) as socket:
                yield Tab(socket)
        finally:
            process.terminate()
            process.wait()


def _new_tab(file: Path) -> str:
    """The address of a new page, as soon as the browser has said at which port it listens."""
    end = time.monotonic() + PATIENCE
    while not (file.is_file() and file.read_text()):
        assert time.monotonic() < end, "the browser did not start"
        time.sleep(0.05)
    port = file.read_text().splitlines()[0]
    with urlopen(Request(f"http://127.0.0.1:{port}/json/new?about:blank", method="PUT")) as answer:
        return str(json.load(answer)["webSocketDebuggerUrl"])
