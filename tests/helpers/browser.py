"""A real browser without a window: Chromium, spoken to in the DevTools protocol."""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path
from urllib.request import Request, urlopen

from websockets.sync.client import connect

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
FLAGS = (
    "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
    "--disable-dev-shm-usage", "--hide-scrollbars", "--remote-debugging-port=0", "--remote-allow-origins=*",
)  # fmt: skip
PATIENCE = 240.0
"""Seconds until a browser that does not answer is given up: a slow machine is no failure."""
PAUSE = 0.05


class Tab:
    """One page in a browser.

    ``errors`` are what the console and uncaught exceptions said.
    """

    def __init__(self, socket):
        self._socket = socket
        self._number = 0
        self.errors: list[str] = []
        self._loaded: set[str] = set()
        for domain in ("Page", "Runtime", "Log", "DOM"):
            self.send(f"{domain}.enable")
        self.send("Page.setLifecycleEventsEnabled", enabled=True)
        self.send("Emulation.setFocusEmulationEnabled", enabled=True)

    def send(self, method, **params):
        """The result of a command of the protocol."""
        self._number += 1
        self._socket.send(json.dumps({"id": self._number, "method": method, "params": params}))
        while True:
            message = json.loads(self._socket.recv(timeout=PATIENCE))
            if message.get("id") == self._number:
                assert "error" not in message, message
                return dict(message["result"])
            self._event(message)

    def _event(self, message):
        method, params = message["method"], message["params"]
        if method == "Page.lifecycleEvent" and params["name"] == "load":
            self._loaded.add(params["loaderId"])
        if method == "Runtime.exceptionThrown":
            self.errors.append(json.dumps(params["exceptionDetails"]))
        if method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning"):
            self.errors.append(json.dumps(params["args"]))
        if method == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.errors.append(params["entry"]["text"])

    def open(self, page, place=""):
        """Load a page and wait until it is there, it and not the one before."""
        for address in ("about:blank", page.as_uri() + (f"#{place}" if place else "")):
            self.errors.clear()
            loader = self.send("Page.navigate", url=address)["loaderId"]
            while loader not in self._loaded:
                self._event(json.loads(self._socket.recv(timeout=PATIENCE)))

    def run(self, script):
        """The value of an expression, or of what it promises."""
        result = self.send(
            "Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True, userGesture=True
        )
        assert "exceptionDetails" not in result, result
        return result["result"].get("value")

    def until(self, script):
        """The value of an expression as soon as it counts as true; its last value if it never does."""
        end = time.monotonic() + PATIENCE
        while not (value := self.run(script)) and time.monotonic() < end:
            time.sleep(PAUSE)
        return value

    def size(self, width, height=900):
        """The size of the window in pixels, of a page that is open."""
        mobile = width < 500
        self.send(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=mobile,
        )
        self.until(f"matchMedia('(width: {width}px) and (height: {height}px)').matches")

    def media(self, kind="", scheme="light"):
        """Screen or paper, and light or dark."""
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        self.send("Emulation.setEmulatedMedia", media=kind, features=features)

    def press(self, key):
        """One key, down and up."""
        code = {"Tab": 9, "Enter": 13}[key]
        text = {"text": "\r"} if key == "Enter" else {}
        for kind in ("keyDown", "keyUp"):
            self.send(
                "Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code, **text
            )

    def picture(self, whole=False):
        """What is seen, or the whole page, as PNG."""
        return base64.b64decode(self.send("Page.captureScreenshot", captureBeyondViewport=whole)["data"])

    def paper(self):
        """The page as it is printed, as PDF."""
        return base64.b64decode(self.send("Page.printToPDF", preferCSSPageSize=True)["data"])


@contextmanager
def browser():
    """A browser of its own with one empty page."""
    assert CHROMIUM is not None, "install chromium"
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as home:
        process = subprocess.Popen(
            [CHROMIUM, *FLAGS, f"--user-data-dir={home}", "about:blank"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            address = _new_tab(Path(home, "DevToolsActivePort"))
            with connect(address, max_size=None, open_timeout=PATIENCE, ping_interval=None) as socket:
                yield Tab(socket)
        finally:
            process.kill()
            process.wait()


def _new_tab(file):
    """The address of a new page, as soon as the browser has said at which port it listens."""
    end = time.monotonic() + PATIENCE
    while not (file.is_file() and file.read_text()):
        assert time.monotonic() < end, "the browser did not start"
        time.sleep(PAUSE)
    port = file.read_text().splitlines()[0]
    with urlopen(Request(f"http://127.0.0.1:{port}/json/new?about:blank", method="PUT")) as answer:
        return str(json.load(answer)["webSocketDebuggerUrl"])
