"""The page of a print, in Chromium, against lyrrun and lyrctl themselves: a dry run, in real time.

    page_test.py --build BUILD
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../format/export/viewer"))
from browser import Browser  # noqa: E402

# Warm in seconds.
PRINTER = """
name = "Page test"
[axis.x]
steps_per_mm = 20
max_speed_mm_s = 100
max_acceleration_mm_s2 = 1000
range_mm = [-10, 200]
[axis.y]
steps_per_mm = 20
max_speed_mm_s = 100
max_acceleration_mm_s2 = 1000
range_mm = [-10, 200]
[axis.z]
steps_per_mm = 100
max_speed_mm_s = 12
max_acceleration_mm_s2 = 200
range_mm = [0, 200]
[axis.e]
steps_per_mm = 100
max_speed_mm_s = 60
max_acceleration_mm_s2 = 5000
[heater.tool]
min_extrude_c = 30
kp = 0.1
ki = 0.02
kd = 0.05
guard.rate_c_s = 1000
model.power_w = 400
model.capacity_j_k = 30
model.loss_w_k = 1
model.lag_s = 0.8
[fan.part]
cycle_s = 1
"""


def gcode(layers):
    """Rounded squares, each layer some seconds."""
    lines = ["G21", "G90", "M83", "M109 S50"]
    for layer in range(layers):
        lines += [f";LAYER:{layer}", f"G0 X20 Y10 Z{0.2 * (layer + 1):.1f} F3000"]
        for k in range(3):
            d, e = 4 * k, 3.0
            lines += [";TYPE:WALL-OUTER", f"G0 X{20 + d} Y{10 + d} F3000",
                      f"G1 X{80 - d} Y{10 + d} E{e} F1800", f"G3 X{90 - d} Y{20 + d} I0 J10 E0.8",
                      f"G1 X{90 - d} Y{80 - d} E{e}", f"G3 X{80 - d} Y{90 - d} I-10 J0 E0.8",
                      f"G1 X{20 + d} Y{90 - d} E{e}", f"G1 X{20 + d} Y{10 + d} E{e}"]
    return "\n".join(lines) + "\n"


class Print:
    """lyrrun at work; a context manager."""

    def __init__(self, build, folder):
        self.build, self.folder = build, folder
        for name, text in (("p.toml", PRINTER), ("part.gcode", gcode(30))):
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        self.tool("lyrview", "--from-gcode", "part.gcode", "-o", "part.lyr")
        self.process = subprocess.Popen(
            [os.path.join(build, "lyrrun"), "part.lyr", "--dry-run", "--printer", "p.toml", "--socket", "s"],
            cwd=folder, stdout=subprocess.DEVNULL)
        self.page = subprocess.Popen([os.path.join(build, "lyrctl"), "web", "0", "--socket", "s"], cwd=folder,
                                     stdout=subprocess.PIPE, text=True)
        self.url = self.page.stdout.readline().strip()
    def tool(self, name, *arguments):
        return subprocess.run([os.path.join(self.build, name), *arguments], cwd=self.folder, check=True,
                              stdout=subprocess.PIPE, text=True).stdout

    def status(self):
        return json.loads(self.tool("lyrctl", "status", "--json", "--socket", "s"))

    def wait(self, condition, seconds=20):
        begun = time.monotonic()
        while time.monotonic() - begun < seconds:
            if condition(self.status()):
                return
            time.sleep(0.05)
        raise AssertionError(f"the print did not get there: {self.status()}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in (self.page, self.process):
            if process.poll() is None:
                process.kill()
            process.wait()


def colours(browser, canvas):
    return browser.run("""
        const canvas = document.getElementById(arguments[0]), seen = new Set();
        const data = new Uint32Array(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.buffer);
        for (const value of data) seen.add(value);
        return seen.size;""", canvas)


def check(true, what):
    if not true:
        raise AssertionError(what)


def shows_the_print(browser, work):
    browser.go(work.url)
    browser.wait("lyr.page.status && lyr.page.print ? true : false")
    check(browser.run("location.hash") == "", "the token stays in the address")
    check(browser.run("document.getElementById('title').textContent") == "part.lyr on Page test", "title")
    work.wait(lambda status: status["state"] == "printing" and status["layer"] > 0)
    browser.wait("document.getElementById('state').textContent === 'Printing' && lyr.page.status.layer > 0")
    check(browser.run("document.getElementById('tool-now').textContent")[0] in "45", "temperature")
    browser.wait("lyr.page.temperatures.samples.length > 1")
    check(colours(browser, "chart") > 5, "the chart is empty")
    check(colours(browser, "plan") > 20, "the layer is not drawn")


def follows_the_head(browser):
    """The head is where the page draws the end of what is printed."""
    look = """
        const {page} = lyr, {status, place} = page, layer = page.print.layer(status.layer - 1), q = page.print.quantum_mm;
        const at = place.done < layer.motions.count ? layer.motions.pointAt(place.done, place.share) : null;
        return {layer: status.layer, done: place.done, share: place.share, head: status.position_mm,
            drawn: at && [at.x * q, at.y * q]};"""
    # On its way to where the first layer begins it is not on the path yet.
    browser.wait("lyr.page.place.done !== Infinity && lyr.page.place.done + lyr.page.place.share > 0")
    seen = []
    for _ in range(6):
        seen.append(browser.run(look))
        time.sleep(0.3)
    order = [(place["layer"], place["done"], place["share"]) for place in seen]
    check(order == sorted(order) and order[0] < order[-1], f"the print does not go on: {order}")
    for place in seen:
        if place["head"] and place["drawn"]:
            away = max(abs(a - b) for a, b in zip(place["head"], place["drawn"]))
            check(away < 0.2, f"the head is drawn elsewhere: {place}")


def controls(browser, work):
    click = "document.getElementById(arguments[0]).click();"
    browser.run("""
        const {elements} = document.getElementById("settings");
        elements.tool_c.value = "60";
        elements.speed.value = "80";
        document.getElementById("set").click();""")
    work.wait(lambda status: status["speed"] == 0.8 and status["heaters"]["tool"]["target_c"] == 60)
    browser.run("""
        document.getElementById("settings").elements.tool_c.value = "400";
        document.getElementById("set").click();""")
    browser.wait("document.getElementById('notice').textContent.includes('goes up to 270')")
    browser.run(click, "pause")
    work.wait(lambda status: status["state"] == "paused")
    browser.wait("!document.getElementById('resume').disabled")
    browser.run(click, "resume")
    work.wait(lambda status: status["state"] == "printing")


def refuses_strangers(browser, work):
    page = work.url.split("#")[0]
    token = work.url.split("=")[1]
    # Another site's page, which has even learnt the token.
    browser.go("data:text/html,<p>evil")
    sent = browser.run("""
        const headers = {"Content-Type": "application/json", "Authorization": "Bearer " + arguments[1]};
        const ask = (options) => fetch(arguments[0] + "command", {method: "POST", body: '{"command":"pause"}', ...options})
            .then((answer) => answer.type, () => "failed");
        return Promise.all([ask({headers}), ask({headers, mode: "no-cors"}), ask({mode: "no-cors"})]);""", page, token)
    check(sent[0] == "failed", f"another site reads answers: {sent}")
    browser.log("browser")
    browser.go(page)
    browser.run("sessionStorage.clear();")
    browser.go(page)
    browser.wait("lyr.page.status !== null")
    check(browser.run("document.getElementById('controls').disabled && document.getElementById('stop').disabled"),
          "there is control without a token")
    answer = browser.run("return lyr.page.send({command: 'pause'});")
    check(answer["error"]["code"] == "forbidden", answer)
    browser.run("""
        document.getElementById("token").value = "wrong-wrong-wrong";
        document.querySelector("#enter button").click();""")
    check(browser.run("return lyr.page.send({command: 'pause'});")["error"]["code"] == "forbidden", "a wrong token")
    check(not browser.run("document.getElementById('enter').hidden"), "the token is not asked for again")
    check(work.status()["state"] == "printing", "a stranger has paused the print")
    for entry in browser.log("browser"):
        check("403" in entry["message"], entry["message"])
    browser.run("document.getElementById('token').value = arguments[0]; "
                "document.querySelector('#enter button').click();", token)


def stops(browser, work):
    browser.run("document.getElementById('stop').click();")
    check(work.process.wait(20) == 8, f"lyrrun ended with {work.process.returncode}")
    browser.wait("document.getElementById('state').textContent === 'Stopped'")
    check(browser.run("document.getElementById('message').textContent").startswith("Emergency stop"), "why it ended")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", required=True)
    build = os.path.abspath(parser.parse_args().build)
    pictures = os.path.join(build, "control-page")
    os.makedirs(pictures, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="lyr-page-") as folder, Print(build, folder) as work, Browser() as browser:
        shows_the_print(browser, work)
        follows_the_head(browser)
        browser.screenshot(os.path.join(pictures, "page.png"))
        controls(browser, work)
        for entry in browser.log("browser"):
            raise AssertionError(entry["message"])
        browser.size(390, 844, phone=True)
        browser.scheme("dark")
        browser.wait("lyr.page.theme.name === 'dark'")
        time.sleep(0.3)
        browser.screenshot(os.path.join(pictures, "phone.png"))
        browser.size(1280, 800)
        for url in browser.requests():
            own = url.startswith(work.url.split("#")[0])
            check(own or not url.startswith(("http", "ws", "file")), f"the page asks {url}")
        refuses_strangers(browser, work)
        stops(browser, work)
    print("page_test: all right")


main()
