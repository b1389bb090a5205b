"""Shared parts of page tests: a scene, files of its runs, and headless Chromium by its debugging pipe: JSON messages separated by
zero bytes, with the standard library only."""

import base64
import contextlib
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time


# Grains falling into a box; tests set stages and probes.
BOX_OF_GRAINS = {
    "title": "grains in a <box> & a probe",
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"density": 2600, "contact_modulus": "1 MPa", "friction_angle": "30 deg"}},
    "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
        "type": "cloud", "low": [0, 0, 0], "high": ["8 mm", "6 mm", "10 mm"], "count": 40,
        "sizes": {"type": "uniform", "smallest": "1 mm", "largest": "1.5 mm"}}}},
    "walls": {"box": {"type": "box", "low": [0, 0, 0], "high": ["8 mm", "6 mm", "12 mm"], "open": ["z_high"], "material": "sand"}},
    "engines": {"gravity": {"type": "gravity"}, "damping": {"type": "local-damping", "coefficient": 0.2}},
}
GRAINS = "document.querySelector('figure.grains').grains"
MAP = "document.querySelector('figure.map').map"


class PageError(Exception):
    pass


def find_chromium():
    return next((path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None)


def skip(why):
    """Ends the tests with the status that CTest reports as skipped."""
    print("skipped:", why)
    sys.exit(77)


def h5py_or_skip():
    try:
        import h5py
    except ImportError:
        skip("Python's h5py is not installed (Debian: python3-h5py)")
    return h5py


def write_scene(folder, name, scene):
    (folder / f"{name}.json").write_text(json.dumps(scene))


class Browser:
    """A browser with one page. `width` × `height` in CSS pixels; `scheme`: light or dark."""

    def __init__(self, program, width=1400, height=1000, scheme="light", timeout=60):
        self.timeout = timeout
        self.profile = tempfile.mkdtemp(prefix="grit-browser-")
        to_browser, self.write_end = os.pipe()
        self.read_end, from_browser = os.pipe()
        words = [program, "--headless=new", "--remote-debugging-pipe", f"--user-data-dir={self.profile}", "--no-first-run",
                 "--disable-background-networking", "--disable-component-update", "--disable-extensions",
                 "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars", "--disable-dev-shm-usage",
                 # As where there is no graphics processor: only WebGL is emulated, which took half of the tests' time for all else.
                 "--disable-accelerated-2d-canvas", "--disable-gpu-compositing"]
        if os.geteuid() == 0:
            words.append("--no-sandbox")

        def connect():  # the ends of the pipe are descriptors 3 and 4
            ends = os.dup(to_browser), os.dup(from_browser)
            os.dup2(ends[0], 3)
            os.dup2(ends[1], 4)

        self.process = subprocess.Popen(words + ["about:blank"], preexec_fn=connect, pass_fds=(3, 4), stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.waiting, self.number, self.session, self.events = b"", 0, None, []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        # Workers have separate sessions, and start when these are attached.
        self.call("Target.setAutoAttach", autoAttach=True, waitForDebuggerOnStart=True, flatten=True)
        self.resize(width, height)
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        for end in (self.write_end, self.read_end):
            os.close(end)
        shutil.rmtree(self.profile, ignore_errors=True)

    def receive(self, deadline):
        while b"\0" not in self.waiting:
            left = deadline - time.monotonic()
            if left <= 0 or not select.select([self.read_end], [], [], left)[0]:
                raise PageError(f"the browser has not answered for {self.timeout} s")
            part = os.read(self.read_end, 1 << 20)
            if not part:
                raise PageError("the browser has ended")
            self.waiting += part
        text, self.waiting = self.waiting.split(b"\0", 1)
        message = json.loads(text)
        if message.get("method") == "Target.attachedToTarget" and message.get("sessionId", "") == self.session:
            for method in ("Network.enable", "Runtime.enable", "Runtime.runIfWaitingForDebugger"):
                self.send(method, message["params"]["sessionId"])
        return message

    def send(self, method, session, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        os.write(self.write_end, json.dumps(message).encode() + b"\0")
        return self.number

    def call(self, method, **parameters):
        number = self.send(method, self.session, **parameters)
        deadline = time.monotonic() + self.timeout
        while True:
            answer = self.receive(deadline)
            if answer.get("id") == number:
                if "error" in answer:
                    raise PageError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            if "method" in answer:
                self.events.append(answer)

    def open(self, path):
        """Opens a file or an address; returns the seconds until its scripts have run."""
        began, self.events = time.monotonic(), []
        self.call("Page.navigate", url=path if str(path).startswith(("http:", "about:")) else "file://" + os.path.abspath(path))
        deadline = began + self.timeout
        while not any(event["method"] == "Page.loadEventFired" for event in self.events):
            self.events.append(self.receive(deadline))
        return time.monotonic() - began

    def evaluate(self, expression):
        """The value of a JavaScript expression, or of its promise."""
        answer = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise PageError(details.get("exception", {}).get("description", details["text"]))
        return answer["result"].get("value")

    def wait(self, condition):
        """Waits until a JavaScript expression is true."""
        promise = f"new Promise((done) => {{ const look = () => ({condition}) ? done(true) : setTimeout(look, 20); look(); }})"
        return self.evaluate(promise)

    @contextlib.contextmanager
    def paused(self):
        """Pauses the scripts of the page, but not those of its workers."""
        self.call("Debugger.enable")
        self.send("Runtime.evaluate", self.session, expression="debugger")
        deadline, message = time.monotonic() + self.timeout, {}
        while message.get("method") != "Debugger.paused":
            message = self.receive(deadline)
            if "method" in message:
                self.events.append(message)
        yield
        self.call("Debugger.disable")

    def complaints(self):
        """Errors and warnings of the console, and uncaught exceptions."""
        said = []
        for event in self.events:
            of = event["params"]
            if event["method"] == "Runtime.exceptionThrown":
                said.append(of["exceptionDetails"].get("exception", {}).get("description", of["exceptionDetails"]["text"]))
            elif event["method"] == "Runtime.consoleAPICalled" and of["type"] in ("error", "warning", "assert"):
                said.append(" ".join(str(argument.get("value", argument.get("description"))) for argument in of["args"]))
            elif event["method"] == "Log.entryAdded" and of["entry"]["level"] in ("error", "warning"):
                said.append(of["entry"]["text"])
        # A remark on the emulated graphics processor, about tests that read what it has drawn.
        return [one for one in said if "GPU stall due to ReadPixels" not in one]

    def requests(self):
        """Addresses that the page requested, except its own file and embedded data."""
        asked = [event["params"]["request"]["url"] for event in self.events if event["method"] == "Network.requestWillBeSent"]
        return [url for url in asked[1:] if not url.startswith(("data:", "blob:"))]

    def resize(self, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)

    def screenshot(self, path, whole=False):
        picture = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        with open(path, "wb") as file:
            file.write(base64.b64decode(picture["data"]))
