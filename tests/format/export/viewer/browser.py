"""Chromium without a window, driven over ChromeDriver's HTTP interface with what Python brings along."""

import base64
import json
import os
import shutil
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

START_S = 30
REQUEST_S = 120

# Nothing of the browser's own may go to a network; drawing is by software, as on a machine without a card.
FLAGS = [
    "--headless=new", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--disable-quic",
    "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-default-apps",
    "--disable-extensions", "--disable-dev-shm-usage", "--hide-scrollbars", "--force-color-profile=srgb",
]


class Browser:
    """A page in a browser of its own; a context manager."""

    def __init__(self, width=1280, height=800, flags=()):
        driver, chromium = shutil.which("chromedriver"), shutil.which("chromium")
        if not driver or not chromium:
            raise SystemExit("the viewer's test needs Debian's chromium and chromium-driver (tools/setup --test)")
        self.opened = 0
        self.profile = tempfile.mkdtemp(prefix="lyr-viewer-")
        self.driver = subprocess.Popen([driver, "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                       text=True)
        try:
            self.root = f"http://127.0.0.1:{self._port()}"
            options = {"binary": chromium,
                       "args": [*FLAGS, *flags, f"--user-data-dir={self.profile}", f"--window-size={width},{height}"]}
            answer = self._send("POST", "/session", {"capabilities": {"alwaysMatch": {
                "goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}}})
            self.session = f"/session/{answer['sessionId']}"
            self._send("POST", self.session + "/timeouts", {"script": 1000 * REQUEST_S, "pageLoad": 1000 * REQUEST_S})
            self.size(width, height)
        except BaseException:
            self._end()
            raise

    def _port(self):
        begun = time.monotonic()
        while time.monotonic() - begun < START_S:
            line = self.driver.stdout.readline()
            if "started successfully on port" in line:
                return int(line.rstrip(". \n").rsplit(" ", 1)[1])
        raise RuntimeError("ChromeDriver does not start")

    def _send(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.root + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=REQUEST_S) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"].split("\n")[0]) from None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._send("DELETE", self.session)
        finally:
            self._end()

    def _end(self):
        self.driver.terminate()
        self.driver.wait()
        shutil.rmtree(self.profile, ignore_errors=True)

    def cdp(self, command, **values):
        return self._send("POST", self.session + "/goog/cdp/execute", {"cmd": command, "params": values})

    def open(self, path, fragment=""):
        """Anew, even if it is the page that is shown."""
        self.opened += 1
        self.go(f"file://{os.path.abspath(path)}?{self.opened}{fragment}")

    def go(self, url):
        self._send("POST", self.session + "/url", {"url": url})

    def run(self, script, *values):
        """The value of a JavaScript expression or, where there is a semicolon, of a function's body; promises are
        waited for."""
        body = script if ";" in script else f"return {script}"
        return self._send("POST", self.session + "/execute/sync", {"script": body, "args": list(values)})

    def wait(self, condition, seconds=30):
        begun = time.monotonic()
        while time.monotonic() - begun < seconds:
            if self.run(condition):
                return
            time.sleep(0.02)
        raise AssertionError(f"did not come true in {seconds} s: {condition}")

    def size(self, width, height, phone=False, ratio=1):
        self.cdp("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=ratio,
                 mobile=phone)
        self.cdp("Emulation.setTouchEmulationEnabled", enabled=phone)

    def scheme(self, name):
        self.cdp("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": name}])

    def keys(self, *keys):
        """Presses and lets go, one after the other. WebDriver's code points stand for keys without a letter."""
        actions = [{"type": kind, "value": key} for key in keys for kind in ("keyDown", "keyUp")]
        self._send("POST", self.session + "/actions", {"actions": [{"type": "key", "id": "keys", "actions": actions}]})

    def pointer(self, *tracks, kind="mouse"):
        """Each track is a list of (x, y) or "down", "up": a finger, or the mouse. They go at the same time."""
        def step(what):
            if what in ("down", "up"):
                return {"type": "pointer" + what.capitalize(), "button": 0}
            return {"type": "pointerMove", "duration": 20, "x": round(what[0]), "y": round(what[1])}
        actions = [{"type": "pointer", "id": f"{kind}{i}", "parameters": {"pointerType": kind},
                    "actions": [step(what) for what in track]} for i, track in enumerate(tracks)]
        self._send("POST", self.session + "/actions", {"actions": actions})

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self._send("GET", self.session + "/screenshot")))

    def log(self, kind):
        """What came since the last call: kind "browser" is the console."""
        return self._send("POST", self.session + "/se/log", {"type": kind})

    def requests(self):
        """Addresses that pages asked for, since the last call."""
        out = []
        for entry in self.log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                out.append(message["params"]["request"]["url"])
        return out
