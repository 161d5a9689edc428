"""`durer view` in a browser, and as a stranger on the same machine sees it.

With Chromium (Debian: chromium, chromium-driver) and Selenium: the picture forms, turns, is explained, shows other views, follows changes
of its file and keeps the last good picture when there is an error; the finished picture is that of `durer render`, byte for byte. The
times to the first picture and to the reaction to a drag are measured on the gallery and printed. Without a browser: wrong addresses,
many connections and clients that stop reading.

    python3 tests/outside/check_view.py --durer target/release/durer [--screenshots docs/view] [--gallery scenes]
"""

import argparse
import http.client
import json
import os
import resource
import shutil
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from urllib.parse import urlsplit

SCENE = """#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2, -6> look_at <0, 0.6, 0> }
light_source { <5, 8, -6>, 1 }
plane { y, 0 pigment { checker rgb 0.9, rgb 0.6 } }
difference {
  sphere { <0, 1, 0>, 1 }
  box { <-2, 1.2, -2>, <2, 3, 2> }
  pigment { rgb <0.8, 0.4, 0.3> }
  finish { reflection 0.2 }
}
"""


class Failed(Exception):
    pass


def check(condition, what):
    if not condition:
        raise Failed(what)


class Server:
    """A running `durer view`."""

    def __init__(self, durer, scene, *options):
        start = time.monotonic()
        self.process = subprocess.Popen([durer, "view", str(scene), *options], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.address = self.process.stdout.readline().strip()
        check(self.address.startswith("http://127.0.0.1:"), f"no address for {scene}: {self.address!r}")
        self.ready = 1e3 * (time.monotonic() - start)
        parts = urlsplit(self.address)
        self.port, self.token = parts.port, parts.path.strip("/")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()

    def ask(self, path, method="GET", body=None, headers=None):
        """Status and body of an answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        try:
            connection.request(method, path, body, headers or {})
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def get(self, path):
        return self.ask(f"/{self.token}/{path}")

    def post(self, path, value):
        return self.ask(f"/{self.token}/{path}", "POST", json.dumps(value))

    def memory(self):
        """Resident memory in bytes."""
        for line in Path(f"/proc/{self.process.pid}/status").read_text().splitlines():
            if line.startswith("VmRSS"):
                return int(line.split()[1]) * 1024
        return 0

    def picture(self, name="picture.png"):
        """The finished picture."""
        for _ in range(600):
            status, body = self.get(name)
            if status == 200:
                return body
            check(status == 409, f"{name}: {status}")
            time.sleep(0.1)
        raise Failed("the picture is never finished")


def rendered(durer, scene, folder, *options, ending="png"):
    out = Path(folder) / f"render.{ending}"
    subprocess.run([durer, "render", str(scene), "-o", str(out), "--no-progress", *options], check=True, stderr=subprocess.DEVNULL)
    return out.read_bytes()


# ---- the picture ----------------------------------------------------------------------------------


def check_pictures(durer, folder, gallery):
    """The finished picture is that of `durer render`, byte for byte."""
    scene, mesh = Path(folder) / "scene.pov", Path(folder) / "mesh.obj"
    scene.write_text(SCENE)
    mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    cases = [(scene, []), (scene, ["--aa", "method2"]), (scene, ["--aa", "method1,0.1,2"]), (scene, ["--aa", "2x2"]), (mesh, [])]
    cases += [(gallery / name, []) for name in ["sphere.pov", "csg.pov", "blob.pov"]]
    size = ["--width", "212", "--height", "149"]
    for path, options in cases:
        with Server(durer, path, *size, *options) as server:
            for ending in ["png", "exr"]:
                want = rendered(durer, path, folder, *size, *options, ending=ending)
                check(server.picture(f"picture.{ending}") == want, f"{path.name} {options}: the {ending} differs from `durer render`'s")
    # The camera's text gives the picture that is seen.
    with Server(durer, scene, *size) as server:
        server.post("move", {"move": "orbit", "x": 0.7, "y": -0.2})
        server.post("move", {"move": "zoom", "by": 0.8})
        picture = server.picture()
        turned = Path(folder) / "turned.pov"
        lines = SCENE.splitlines(keepends=True)
        lines[2] = first_event(server)["camera"] + "\n"
        turned.write_text("".join(lines))
        check(picture == rendered(durer, turned, folder, *size), "the camera's text gives another picture")
    print(f"pictures: {len(cases)} scenes as PNG and EXR, and one with a turned camera, are those of `durer render`")


def first_event(server):
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=30)
    connection.request("GET", f"/{server.token}/events")
    answer = connection.getresponse()
    while True:
        line = answer.readline().decode()
        if line.startswith("data: {"):
            connection.close()
            return json.loads(line[6:])


# ---- strangers ------------------------------------------------------------------------------------


def check_strangers(durer, folder):
    scene = Path(folder) / "strange.pov"
    scene.write_text(SCENE)
    with Server(durer, scene, "--width", "640", "--height", "480") as server:
        own = f"/{server.token}/"
        wrong = server.token[:-1] + ("0" if server.token[-1] != "0" else "1")
        for path in ["/", "/favicon.ico", f"/{wrong}/", f"/{wrong}/pixel?x=1&y=1", f"/{server.token[:-1]}/", f"/{server.token}0/", "//"]:
            check(server.ask(path)[0] == 404, f"{path} is answered")
        for path in ["../", "..%2f..%2fetc/passwd", "../../etc/passwd", "scene.pov", "strange.pov", "/etc/passwd", "page/app.js"]:
            check(server.ask(own + path)[0] == 404, f"{path} is answered")
        for host in ["example.com", f"example.com:{server.port}", "127.0.0.1", f"127.0.0.1:{server.port + 1}", "", f"127.0.0.1.example.com:{server.port}"]:
            check(server.ask(own, headers={"Host": host})[0] in (400, 403), f"the host {host!r} is served")
        check(server.ask(own[:-1])[0] == 308, "the page without a slash is not found")
        check(server.ask(own, headers={"Origin": "http://example.com"})[0] == 403, "another origin is served")
        check(server.ask(own, headers={"Host": f"localhost:{server.port}"})[0] == 200, "localhost is refused")
        for method in ["PUT", "DELETE", "OPTIONS"]:
            check(server.ask(own, method)[0] == 405, f"{method} is answered")
        for query in ["", "?x=1", "?x=-1&y=0", "?x=640&y=0", "?x=1e9&y=0", "?x=99999999999999999999&y=1"]:
            check(server.get("pixel" + query)[0] == 400, f"pixel{query} is answered")
        for body in ["", "{", "[]", '{"move":"orbit"}', '{"move":"orbit","x":1e999,"y":0}', '{"move":"fly"}']:
            check(server.ask(own + "move", "POST", body)[0] == 400, f"the move {body!r} is done")
        check(server.ask(own + "move", "POST", "x" * 100_000)[0] in (413, 400), "a long request is read")
        listeners = subprocess.run(["ss", "-ltn"], capture_output=True, text=True).stdout if shutil.which("ss") else ""
        check(f"0.0.0.0:{server.port}" not in listeners and f"[::]:{server.port}" not in listeners, "it listens to other machines")
        server.picture()
        check_connections(server)
        check_lazy_clients(server)
    print("strangers: wrong tokens, hosts, paths, methods and bodies are refused")


def check_connections(server):
    """Ten thousand connections, many at a time, silent or half-spoken."""
    before, count, held = server.memory(), 10_000, []
    most = min(900, resource.getrlimit(resource.RLIMIT_NOFILE)[0] - 100)
    start = time.monotonic()
    for i in range(count):
        try:
            stranger = socket.create_connection(("127.0.0.1", server.port), timeout=10)
            if i % 3 == 1:
                stranger.send(b"GET / HTTP/1.1\r\nHost: 127.0")
            elif i % 3 == 2:
                stranger.send(b"\0" * 100)
        except OSError:
            continue
        held.append(stranger)
        if len(held) >= most:
            for old in held[: most // 2]:
                old.close()
            del held[: most // 2]
    took = time.monotonic() - start
    # Those that are still open are closed by the server, and it answers again.
    deadline = time.monotonic() + 15
    while True:
        try:
            if server.get("")[0] == 200:
                break
        except OSError:
            pass
        check(time.monotonic() < deadline, "it no longer answers after many connections")
        time.sleep(0.2)
    for stranger in held:
        stranger.close()
    growth = server.memory() - before
    check(growth < 48 << 20, f"{count} connections took {growth >> 20} MB")
    print(f"connections: {count} in {took:.1f} s survived, memory grew by {growth / 2**20:.1f} MB")


def check_lazy_clients(server):
    """Clients that ask for pixels and read nothing, while the picture changes again and again."""
    lazy = []
    for _ in range(6):
        client = socket.socket()
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        client.connect(("127.0.0.1", server.port))
        client.send(f"GET /{server.token}/events HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n\r\n".encode())
        lazy.append(client)
    time.sleep(0.5)
    before = server.memory()
    for i in range(60):
        check(server.post("move", {"move": "orbit", "x": 0.05, "y": 0.0})[0] == 200, "a move is refused")
        if i % 10 == 0:
            server.picture()
    check(server.get("")[0] == 200 and server.get("pixel?x=9&y=9")[0] == 200, "it no longer answers beside lazy clients")
    growth = server.memory() - before
    check(growth < 24 << 20, f"lazy clients took {growth >> 20} MB")
    # Too many windows are refused.
    statuses = []
    for _ in range(4):
        connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=30)
        connection.request("GET", f"/{server.token}/events")
        answer = connection.getresponse()
        statuses.append(answer.status)
        lazy.append(answer)
    check(statuses == [200, 200, 503, 503], f"streams for many windows: {statuses}")
    for client in lazy:
        client.close()
    print(f"lazy clients: 6 that stop reading survived, memory grew by {growth / 2**20:.1f} MB")


# ---- the browser ----------------------------------------------------------------------------------


def browser(width, height, dark=False):
    from selenium import webdriver

    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium") or "/usr/bin/chromium"
    flags = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--hide-scrollbars"]
    flags += ["--disable-background-networking", "--disable-component-update", "--disable-sync", f"--window-size={width},{height}"]
    for flag in [*flags, "--user-data-dir=" + tempfile.mkdtemp(prefix="durer-view-")]:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))
    metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    scheme = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": scheme})
    return driver


class Page:
    def __init__(self, driver, server):
        self.driver = driver
        driver.get(server.address)

    def find(self, name):
        return self.driver.find_element("id", name)

    def text(self, name):
        return self.find(name).text

    def wait(self, script, what, seconds=30.0):
        """Waits until a JavaScript expression is true, and returns its value."""
        deadline = time.monotonic() + seconds
        while True:
            value = self.driver.execute_script(f"return {script}")
            if value:
                return value
            check(time.monotonic() < deadline, f"{what}: not seen within {seconds:.0f} s; status: {self.text('status')!r}")
            time.sleep(0.02)

    def finished(self, seconds=60.0):
        self.wait("/ms$| s$/.test(document.getElementById('status').textContent)", "a finished picture", seconds)

    def pixels(self):
        """A short print of the pixels."""
        return self.driver.execute_script(
            "const c = document.getElementById('canvas');"
            "const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
            "let a = 1, b = 0; for (let i = 0; i < d.length; i++) { a = (a + d[i]) % 65521; b = (b + a) % 65521; } return b * 65536 + a;"
        )

    def actions(self):
        from selenium.webdriver.common.action_chains import ActionChains

        return ActionChains(self.driver, duration=15)

    def drag(self, x, y, steps=4):
        chain = self.actions().move_to_element(self.find("picture")).click_and_hold()
        for _ in range(steps):
            chain.move_by_offset(x, y)
        chain.release().perform()

    def click(self, x, y):
        """Clicks at a place relative to the middle of the picture."""
        self.actions().move_to_element_with_offset(self.find("picture"), x, y).click().perform()
        self.wait("document.querySelector('#answer .seen') && document.getElementById('panel').getAttribute('aria-busy') === 'false'", "an answer")
        time.sleep(0.4)

    def keys(self, *keys):
        self.find("picture").send_keys(*keys)

    def errors(self):
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]

    def shot(self, folder, name, whole=False):
        if folder is None:
            return
        Path(folder).mkdir(parents=True, exist_ok=True)
        if whole:
            height = self.driver.execute_script("return document.documentElement.scrollHeight")
            width = self.driver.execute_script("return innerWidth")
            metrics = {"width": width, "height": min(height, 3000), "deviceScaleFactor": 1, "mobile": width < 600}
            self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
            time.sleep(0.3)
        self.driver.save_screenshot(str(Path(folder) / f"{name}.png"))


def check_page(durer, folder, shots):
    """First pixels, refinement, orbit, click, views, a change of the file, an error."""
    scene = Path(folder) / "page.pov"
    scene.write_text(SCENE)
    driver = browser(1280, 900)
    try:
        with Server(durer, scene, "--width", "640", "--height", "480", "--aa", "method2") as server:
            page = Page(driver, server)
            page.wait("Object.keys(durerTimings.tiles).length > 0", "first pixels")
            page.finished()
            check(page.text("name") == "page.pov", "the name is missing")
            first = page.pixels()

            page.drag(40, 5)
            page.wait("Object.keys(durerTimings.asked).length > 0", "a move")
            page.wait("document.getElementById('reset').disabled === false", "a moved camera")
            page.wait("Object.keys(durerTimings.pass).filter(k => Number(k.split('/')[0]) > 1).length >= 3", "refinement in passes")
            page.finished()
            check(page.pixels() != first, "a drag turns nothing")
            page.find("camera-box").find_element("tag name", "summary").click()
            check(page.text("camera").startswith("camera {\n  perspective\n  location <"), "the camera's text is missing")
            page.find("reset").click()
            page.wait("document.getElementById('reset').disabled", "the scene's own camera")
            page.finished()
            check(page.pixels() == first, "the scene's own camera shows another picture")

            # Keys turn, shift and zoom, too.
            from selenium.webdriver.common.keys import Keys

            for keys in [[Keys.ARROW_LEFT], [Keys.SHIFT, Keys.ARROW_UP], ["+"], ["-"], ["l"]]:
                before = page.text("camera")
                page.keys(*keys)
                page.wait(f"document.getElementById('camera').textContent !== {json.dumps(before)}", f"a move by {keys}")
            page.actions().move_to_element_with_offset(page.find("picture"), 60, 60).double_click().perform()
            page.keys("r")
            page.wait("document.getElementById('reset').disabled", "the scene's own camera by a key")
            page.finished()

            page.click(0, 20)
            answer = page.text("answer")
            for word in ["page.pov, line 7", "bracket", "normal", "uv", "entering", "Along the ray", "closest: object 1"]:
                check(word in answer, f"the answer lacks {word!r}")
            check(driver.find_element("css selector", ".code .word").text == "sphere", "the wrong word is underlined")
            check(len(driver.find_elements("css selector", ".along .enter, .along .leave")) >= 3, "crossings are not drawn")
            check(len(driver.find_elements("css selector", ".along .span")) >= 2, "stretches inside solids are not drawn")
            rays = [li.text for li in driver.find_elements("css selector", ".rays li")]
            check(any("reflected" in ray for ray in rays) and any("shadow ray to light 0" in ray for ray in rays), "the tree of rays is not whole")
            x, y = (int(page.find(name).get_attribute("value")) for name in ("pixel-x", "pixel-y"))
            page.keys("s", "s", "d", Keys.ENTER)
            page.wait(f"document.querySelector('.seen').textContent.includes('{x + 1}, {y + 2}')", "a pixel chosen by keys")

            shown = {first}
            for i, name in enumerate(["picture", "depth", "normal", "object", "uv", "bound", "steps", "inside"]):
                page.keys(str(i + 1))
                page.wait(f"document.getElementById('channel').value === '{name}'", f"the view {name}")
                page.finished()
                check(page.find("legend").is_displayed() == (name != "picture"), f"the legend of {name}")
                check(server.get("picture.png")[0] == (200 if name == "picture" else 409), f"a PNG while {name} is shown")
                check(server.get("picture.exr")[1][:4] == b"\x76\x2f\x31\x01", f"no EXR while {name} is shown")
                shown.add(page.pixels())
                if name in ("normal", "steps"):
                    page.shot(shots, name)
            check(len(shown) == 8, "some views look the same")
            page.keys("1")
            page.finished()

            # A change appears by itself; an error is shown and the picture stays.
            reads = "Number(document.getElementById('name').dataset.reads)"
            scene.write_text(SCENE.replace("<0.8, 0.4, 0.3>", "<0.2, 0.4, 0.9>"))
            page.wait(f"{reads} === 2", "a changed scene")
            page.finished()
            changed = page.pixels()
            check(changed != first, "a changed scene looks the same")
            scene.write_text(SCENE.replace("plane {", "plain {"))
            page.wait("!document.getElementById('error').hidden", "an error")
            message = page.text("error")
            check("page.pov:5:1:" in message and "^^^^^" in message, f"the error is not underlined: {message}")
            check(page.pixels() == changed, "the last good picture is lost")
            page.shot(shots, "error")
            scene.write_text(SCENE)
            page.wait("document.getElementById('error').hidden", "the repaired scene")
            page.finished()
            check(page.pixels() == first, "the repaired scene looks different")
            check(not page.errors(), f"the page has errors: {page.errors()}")
    finally:
        driver.quit()
    print("page: first pixels, refinement, orbit, keys, click, 8 views, reload and error are as they should be")


def take_screenshots(durer, gallery, shots):
    for name, width, height, dark in [("light", 1280, 900, False), ("dark", 1280, 900, True), ("phone", 390, 844, False)]:
        driver = browser(width, height, dark)
        try:
            with Server(durer, gallery / "sphere.pov", "--width", "640", "--height", "480", "--aa", "method2") as server:
                page = Page(driver, server)
                page.finished()
                page.click(*((60, 60) if width > 600 else (30, 35)))
                page.shot(shots, name, whole=True)
                overflow = driver.execute_script("return document.documentElement.scrollWidth - innerWidth")
                check(overflow <= 0, f"the page is wider than the window by {overflow} pixels in {name}")
        finally:
            driver.quit()


def measure(durer, gallery, count):
    """The times to the first picture and to the reaction to a drag, in milliseconds."""
    scenes = sorted(gallery.glob("*.pov"))[:: 1 if count is None else max(1, len(list(gallery.glob("*.pov"))) // count)]
    driver = browser(1280, 900)
    ready, first, opened, drags, eighths = [], [], [], [], []
    try:
        for path in scenes:
            with Server(durer, path, "--width", "640", "--height", "480") as server:
                ready.append(server.ready)
                # The picture begins to form when the first page opens.
                page = Page(driver, server)
                first.append(page.wait("durerTimings.picture", "the first picture", 120))
                page.finished(180)
                # Opened once more, with the picture finished.
                page = Page(driver, server)
                opened.append(page.wait("durerTimings.picture", "the first picture", 120))
                page.finished()
                for turn in [(25, 0), (-20, 6)]:
                    page.drag(*turn, steps=3)
                    time.sleep(0.25)
                time.sleep(0.5)
                times = driver.execute_script("return durerTimings")
                last = max(map(int, times["asked"]), default=0)
                page.wait(f"durerTimings.pass['{last}/2'] ?? durerTimings.pass['{last}/3']", "an eighth after a drag", 120)
                times = driver.execute_script("return durerTimings")
                reaction = [times["pass"][g + "/1"] - asked for g, asked in times["asked"].items() if times["pass"].get(g + "/1")]
                check(reaction, f"{path.name}: no reaction to a drag")
                drags.append(statistics.median(reaction))
                passed = times["pass"].get(f"{last}/2") or times["pass"][f"{last}/3"]
                eighths.append(passed - times["asked"][str(last)])
                print(f"  {path.stem:24} program {ready[-1]:6.0f}   first {first[-1]:6.0f}   again {opened[-1]:6.0f}   drag {drags[-1]:6.0f}   an eighth {eighths[-1]:6.0f}")
    finally:
        driver.quit()
    print(f"times at 640x480 on {os.cpu_count()} processors, {len(scenes)} scenes, medians in ms:")
    for what, values in [
        ("from the start of the program to its address", ready),
        ("first picture, from opening the first page", first),
        ("finished picture, from opening a second page", opened),
        ("reaction to a drag: the whole picture, coarsely", drags),
        ("an eighth of the pixels after a drag", eighths),
    ]:
        print(f"  {what:48} {statistics.median(values):6.0f}   (slowest {max(values):.0f})")
    return statistics.median(first), statistics.median(drags)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--durer", required=True)
    parser.add_argument("--gallery", default=Path(__file__).parents[2] / "scenes", type=Path)
    parser.add_argument("--screenshots", type=Path, help="a folder to keep screenshots in")
    parser.add_argument("--scenes", type=int, help="measure about this many scenes of the gallery only")
    parser.add_argument("--limit", type=float, help="fail if the median times are longer than this, in ms")
    parser.add_argument("--only", choices=["pictures", "strangers", "page", "screenshots", "times"])
    options = parser.parse_args()
    try:
        import selenium  # noqa: F401

        has_browser = shutil.which("chromium") and shutil.which("chromedriver")
    except ImportError:
        has_browser = False
    wanted = lambda name: options.only in (None, name)  # noqa: E731
    try:
        with tempfile.TemporaryDirectory() as folder:
            if wanted("pictures"):
                check_pictures(options.durer, folder, options.gallery)
            if wanted("strangers"):
                check_strangers(options.durer, folder)
            if not has_browser:
                print("not run: the page in a browser, because Chromium, its driver or Selenium is missing")
                return 0
            if wanted("page"):
                check_page(options.durer, folder, options.screenshots)
            if options.screenshots and wanted("screenshots"):
                take_screenshots(options.durer, options.gallery, options.screenshots)
            if wanted("times"):
                times = measure(options.durer, options.gallery, options.scenes)
                check(options.limit is None or max(times) <= options.limit, f"slower than {options.limit} ms")
    except Failed as failed:
        print(f"FAILED: {failed}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
