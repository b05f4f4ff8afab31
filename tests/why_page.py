# SPDX-License-Identifier: MIT
# Opens a page of `glint why --format html` in headless Chromium, clicks and types in it, and holds
# what it shows against the JSON that `glint why` gives for the same pixel.
#   why_page.py GLINT SCENE PAGE X,Y [SCREENSHOT]
# Talks to chromedriver by the WebDriver protocol (W3C Recommendation, 2018).
import base64
import json
import os
import re
import socket
import subprocess
import sys
import time
import urllib.request

glint, scene, page, place = sys.argv[1:5]
x, y = (int(word) for word in place.split(","))


class Browser:
    def __init__(self):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.driver = subprocess.Popen(["chromedriver", f"--port={self.port}"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.session = ""
        options = {"args": ["--headless=new", "--no-sandbox", "--disable-gpu",
                            "--disable-dev-shm-usage", "--window-size=1200,900"]}
        if os.environ.get("WHY_PAGE_DARK"):
            options["args"].append("--force-dark-mode")
        wanted = {"capabilities": {"alwaysMatch": {"browserName": "chrome",
                                                   "goog:chromeOptions": options}}}
        for attempt in range(100):
            try:
                self.session = "/" + self.call("POST", "", wanted)["sessionId"]
                return
            except (ConnectionError, urllib.error.URLError):
                if attempt == 99:
                    raise
                time.sleep(0.1)

    def call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        url = f"http://127.0.0.1:{self.port}/session{self.session}{path}"
        request = urllib.request.Request(url, data, {"Content-Type": "application/json"},
                                         method=method)
        with urllib.request.urlopen(request, timeout=60) as answer:
            return json.load(answer)["value"]

    def run(self, script, *arguments):
        return self.call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def wait(self, script):
        for _ in range(300):
            if self.run(script):
                return
            time.sleep(0.05)
        raise TimeoutError(script)

    def click(self, left, top):
        pointer = {"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"},
                   "actions": [{"type": "pointerMove", "x": round(left), "y": round(top)},
                               {"type": "pointerDown", "button": 0},
                               {"type": "pointerUp", "button": 0}]}
        self.call("POST", "/actions", {"actions": [pointer]})

    def press(self, *keys):
        steps = [{"type": "keyDown", "value": key} for key in keys]
        steps += [{"type": "keyUp", "value": key} for key in reversed(keys)]
        self.call("POST", "/actions", {"actions": [{"type": "key", "id": "keys",
                                                    "actions": steps}]})

    def screenshot(self, name):
        with open(name, "wb") as file:
            file.write(base64.b64decode(self.call("GET", "/screenshot")))

    def close(self):
        if self.session:
            self.call("DELETE", "")
        self.driver.terminate()
        self.driver.wait()


passed = failed = 0


def check(holds, what):
    global passed, failed
    passed += bool(holds)
    failed += not holds
    if not holds:
        print(f"FAIL page: {what}")


def numbers(text):
    return [float(word) for word in re.findall(r"-?\d+\.?\d*(?:e[-+]?\d+)?", text)]


def near(a, b):
    return len(a) == len(b) and all(abs(p - q) <= 2e-5 * max(1e-9, abs(q)) for p, q in zip(a, b))


browser = Browser()
try:
    browser.call("POST", "/url", {"url": "file://" + os.path.abspath(page)})
    browser.wait("return document.body.dataset.ready === 'yes'")
    check(browser.run("return performance.getEntriesByType('resource').every("
                      "e => e.name.startsWith('data:') || e.name.startsWith('blob:'))"),
          "it loads nothing from elsewhere")
    # The mouse: the middle of the pixel.
    spot = browser.run("""
        const box = document.getElementById('picture').getBoundingClientRect();
        return [box.left + (arguments[0] - left + 0.5) * box.width / wide,
                box.top + (arguments[1] - topmost + 0.5) * box.height / high];""", x, y)
    browser.click(*spot)
    check(browser.run("return [at.x, at.y]") == [x, y], f"a click chooses {x},{y}")
    told = json.loads(subprocess.run([glint, "why", "--format", "json", scene, place], check=True,
                                     capture_output=True).stdout)
    tree = browser.run("return document.getElementById('tree').innerText")
    hex_color = "#%02x%02x%02x" % tuple(told["rgb"])
    check(f"pixel {x},{y}: {hex_color}" in tree, "the colour of the pixel")
    linear = re.search(r"linear ([-0-9.e ]+)", tree)
    check(linear and near(numbers(linear.group(1)), told["color"]), "the linear colour")
    detail = next(s for s in told["samples"] if "rays" in s)
    count = browser.run("return document.querySelectorAll('#tree details').length")
    check(count == len(detail["rays"]), f"{count} rays, not {len(detail['rays'])}")
    for ray in detail["rays"]:
        if ray["end"] == "surface":
            check(f"surface {ray['surface']['id']}, {ray['surface_type']}" in tree,
                  f"surface {ray['surface']['id']} is named")
    # What the page says is added sums up to the sample, as far as five digits can tell.
    adds = browser.run("""
        return [...document.querySelectorAll('#tree p')].map(e => e.textContent)
            .filter(t => /adds -?[0-9]/.test(t))""")
    total = [0.0, 0.0, 0.0]
    for text in adds:
        for k, number in enumerate(numbers(re.search(r"adds ([-0-9.e+ ]+)", text).group(1))[:3]):
            total[k] += number
    check(all(abs(a - b) <= 1e-4 * (1 + abs(b)) for a, b in zip(total, detail["color"])),
          f"what is added: {total}, not {detail['color']}")
    blocked = [light for light in detail["lights"] if light["fate"] == "blocked"]
    check(tree.count("blocked by") == len(blocked), "as many blocked lights")
    if len(sys.argv) > 5:
        browser.screenshot(sys.argv[5])
    # Keys: the picture has the focus after a click.
    browser.press("\uE014")
    check(browser.run("return at.x") == x + 1, "the right arrow goes one pixel to the right")
    browser.press("\uE008", "\uE015")
    check(browser.run("return at.y") == min(y + 10, browser.run("return topmost + high - 1")),
          "Shift and the down arrow go ten pixels down")
    browser.press("\uE011")
    check(browser.run("return at.x === left"), "Home goes to the left side")
    check(browser.run("return document.getElementById('news').textContent.length > 10"),
          "what is chosen is told to screen readers")
    # The keyboard alone reaches the picture and the fields.
    browser.click(30, 5)
    browser.press("\uE004")
    check(browser.run("return document.activeElement.id") == "frame", "Tab reaches the picture")
    check(browser.run("return document.querySelectorAll('[id=x],[id=y]').length") == 2, "fields")
    browser.run("""const field = document.getElementById('x'); field.value = arguments[0];
                   field.dispatchEvent(new Event('change'))""", x)
    check(browser.run("return at.x") == x, "a number typed chooses a pixel")
    check(browser.run("return location.hash") == "#%d,%d" % tuple(browser.run(
        "return [at.x, at.y]")), "the address names the pixel")
    check(browser.run("return document.documentElement.scrollWidth <= innerWidth"),
          "nothing sticks out to the side")
finally:
    browser.close()
print(f"{passed} passed, {failed} failed")
sys.exit(failed > 0)
