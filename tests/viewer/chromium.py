"""A headless Chromium, driven over its DevTools websocket; nothing but websockets is needed."""

import base64
import itertools
import json
import shutil
import subprocess
import tempfile
import time
import urllib.request
from contextlib import contextmanager
from pathlib import Path

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")

OPTIONS = (
    *("--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--disable-quic", "--no-first-run", "--no-default-browser-check", "--disable-sync"),
    *("--disable-background-networking", "--disable-component-update", "--disable-extensions"),
    *("--remote-debugging-port=0", "--remote-allow-origins=*", "--hide-scrollbars"),
)

COUNTING = """
(() => {
  window.seen = {poses: 0, frames: 0, first: 0, types: {}};
  const count = () => { seen.frames++; requestAnimationFrame(count); };
  requestAnimationFrame(count);
  const Plain = window.Worker;
  window.Worker = class extends Plain {
    constructor(...given) {
      super(...given);
      this.addEventListener('message', event => {
        const messages = (event.data && event.data.messages) || [];
        let moved = false;
        for (const message of messages) {
          seen.types[message.type] = (seen.types[message.type] || 0) + 1;
          moved = moved || /^Set(Orientation|Position)Message$/.test(message.type);
          if (message.type === 'MeshMessage' && !seen.first) seen.first = Date.now();
        }
        if (moved) seen.poses++;
      });
    }
  };
})();
"""
"""What a page counts of itself: frames drawn, batches with poses, messages by type, and when the
first mesh came [ms since 1970]."""


def find():
    """The browser's path; None where there is none."""
    return next(filter(None, map(shutil.which, NAMES)), None)


class Tab:
    """A tab of the browser.

    Attributes:
        asked: URLs that were asked for, also by workers.
    """

    def __init__(self, url):
        from websockets.sync.client import connect

        self._socket = connect(url, max_size=None, open_timeout=30)
        self._numbers = itertools.count(1)
        self.asked = []
        self._sessions = set()
        self.call(
            "Target.setAutoAttach", autoAttach=True, waitForDebuggerOnStart=True, flatten=True
        )
        for domain in ("Page", "Runtime", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method, session=None, **parameters):
        number = next(self._numbers)
        message = {"id": number, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        self._socket.send(json.dumps(message))
        while True:
            answer = json.loads(self._socket.recv(timeout=60))
            if answer.get("id") == number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self._note(answer)

    def _note(self, event):
        parameters = event.get("params", {})
        if event.get("method") == "Network.requestWillBeSent":
            self.asked.append(parameters["request"]["url"])
        elif event.get("method") == "Network.webSocketCreated":
            self.asked.append(parameters["url"])
        elif event.get("method") == "Target.attachedToTarget":
            # a worker waits until it is looked at, so that none of its requests is missed
            for method in ("Network.enable", "Runtime.runIfWaitingForDebugger"):
                message = {"id": next(self._numbers), "method": method, "params": {}}
                self._socket.send(json.dumps({**message, "sessionId": parameters["sessionId"]}))

    def size(self, width, height):
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width, height=height, deviceScaleFactor=1, mobile=False,
        )  # fmt: skip

    def open(self, url):
        self.call("Page.addScriptToEvaluateOnNewDocument", source=COUNTING)
        self.call("Page.navigate", url=url)

    def run(self, script):
        """The value of an expression."""
        result = self.call(
            "Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True
        )
        if "exceptionDetails" in result:
            raise RuntimeError(str(result["exceptionDetails"])[:500])
        return result["result"].get("value")

    def until(self, script, patience=30.0):
        """The value of an expression once it is true."""
        end = time.monotonic() + patience
        while time.monotonic() < end:
            value = self.run(script)
            if value:
                return value
            time.sleep(0.1)
        text = self.run("document.body.innerText")[:600]
        raise AssertionError(f"never true: {script}; the page says {text!r}")

    def place(self, script):
        """The middle of an element that an expression gives."""
        return self.run(
            f"(() => {{ const e = {script}; e.scrollIntoView({{block: 'nearest'}});"
            " const b = e.getBoundingClientRect();"
            " return [b.x + b.width / 2, b.y + b.height / 2]; })()"
        )

    def mouse(self, kind, x, y):
        pressed = {"mousePressed": 1, "mouseMoved": self._held, "mouseReleased": 0}[kind]
        self._held = pressed
        self.call(
            "Input.dispatchMouseEvent", type=kind, x=x, y=y, clickCount=1, buttons=pressed,
            button="left" if kind != "mouseMoved" or pressed else "none",
        )  # fmt: skip

    _held = 0

    def click(self, x, y):
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y)
        self.mouse("mouseReleased", x, y)

    def picture(self, path=None):
        data = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        if path is not None:
            Path(path).write_bytes(data)
        return data

    def close(self):
        self._socket.close()


@contextmanager
def chromium():
    """A browser with a profile of its own; gives a function that opens a tab, with the
    browser's ``pid``."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        process = subprocess.Popen(
            [find(), *OPTIONS, f"--user-data-dir={profile}", "about:blank"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        tabs = []
        try:
            port = _port(Path(profile) / "DevToolsActivePort")

            def tab(width=1280, height=800):
                request = urllib.request.Request(
                    f"http://127.0.0.1:{port}/json/new?about:blank", method="PUT"
                )
                with urllib.request.urlopen(request, timeout=30) as answer:
                    url = json.load(answer)["webSocketDebuggerUrl"]
                tabs.append(Tab(url))
                tabs[-1].size(width, height)
                return tabs[-1]

            tab.pid = process.pid
            yield tab
        finally:
            for opened in tabs:
                opened.close()
            process.terminate()
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()


def _port(file, patience=30.0):
    end = time.monotonic() + patience
    while time.monotonic() < end:
        if file.exists() and file.read_text().strip():
            return int(file.read_text().split()[0])
        time.sleep(0.05)
    raise RuntimeError("the browser did not start")
