"""Nodes of a scene with their live view, and pages in headless Chromium."""
import contextlib
import os
import queue
import shutil
import signal
import subprocess
import sys
import threading
import time

NO_BROWSER = 77

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
except ImportError:
    webdriver = None


def need_browser():
    """Ends the program where there is none."""
    if webdriver is None or not shutil.which("chromium") or not shutil.which("chromedriver"):
        sys.exit(NO_BROWSER)


class Nodes:
    """palpate run SCENE --web, until stop()."""

    def __init__(self, options, scene, port=0, arguments=()):
        environment = dict(os.environ, PALPATE_CACHE=options.cache)
        command = [f"{options.bin}/palpate", "run", f"{options.source}/scenes/{scene}", "--domain", str(options.domain),
                   "--web", str(port), *arguments]
        self.process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True)
        self.lines = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()
        self.address = self._address()

    def _read(self):
        for line in self.process.stdout:
            self.lines.put(line.rstrip())

    def _address(self):
        end = time.monotonic() + 60
        while time.monotonic() < end:
            line = self.lines.get(timeout=60)
            if line.startswith("live view: "):
                return line.removeprefix("live view: ")
        raise TimeoutError("no address was printed")

    @property
    def port(self):
        return int(self.address.split(":")[2].rstrip("/"))

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(timeout=30)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.stop()


def open_browser(width=1100, height=720):
    options = Options()
    # WebGL by software where there is no card, and else as Chromium does it by itself.
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--enable-unsafe-swiftshader",
                     f"--window-size={width},{height}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)


def open_small_browser():
    """A picture drawn without a graphics card takes the processor's time by its pixels."""
    return open_browser(740, 480)


def expect(holds, said):
    if not holds:
        raise AssertionError(said)


def wait_for(browser, expression, seconds):
    """Until the expression holds; its value. None where it does not in time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if value := browser.execute_script(f"return {expression}"):
            return value
        time.sleep(0.03)
    return None


class Page:
    """One window of a browser with the live view in it."""

    def __init__(self, browser, address, new_window=False):
        self.browser = browser
        if new_window:
            browser.switch_to.new_window("window")
        self.handle = browser.current_window_handle
        browser.get(address)
        # There is a picture to press on.
        self.wait("globalThis.palpate?.firstDrawn", 40)

    def front(self):
        self.browser.switch_to.window(self.handle)

    def get(self, expression):
        return self.browser.execute_script(f"return {expression}")

    def wait(self, expression, seconds):
        """Until the expression holds; its value."""
        if value := wait_for(self.browser, expression, seconds):
            return value
        raise AssertionError(f"not within {seconds} s: {expression}; now {self.state()}")

    def state(self):
        return self.get("""palpate.frame && (() => { const tool = palpate.frame.tools[0]; return {
            force: Math.hypot(...tool.force), holder: tool.holder, asker: tool.asker, flags: tool.flags,
            me: palpate.me, moved: Math.max(...palpate.bodies()[0]?.displacement ?? []), sample: tool.sample,
            topology: palpate.topology?.number }; })()""")

    def place(self, x, y):
        """A point of the picture by shares of it, in the window [pixel]."""
        box = self.get("(b => [b.left, b.top, b.width, b.height])"
                       "(document.getElementById('picture').getBoundingClientRect())")
        return box[0] + x * box[2], box[1] + y * box[3]

    def mouse(self, kind, x, y, pressed):
        at = self.place(x, y)
        button = "left" if pressed or kind == "mouseReleased" else "none"
        self.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {
            "type": kind, "x": at[0], "y": at[1], "button": button, "buttons": int(pressed), "clickCount": 1,
            "pointerType": "mouse"})

    def press(self, x, y):
        self.mouse("mouseMoved", x, y, False)
        self.mouse("mousePressed", x, y, True)

    def drag(self, x, y):
        self.mouse("mouseMoved", x, y, True)

    def let_go(self, x, y):
        self.mouse("mouseReleased", x, y, False)

    def key(self, key, *kinds):
        """Goes down and up, or as `kinds` say."""
        for kind in kinds or ("keyDown", "keyUp"):
            text = {"text": key} if kind == "keyDown" else {}
            self.browser.execute_cdp_cmd("Input.dispatchKeyEvent", {"type": kind, "key": key, **text})

    def touch(self, kind, *shares):
        points = [dict(zip("xy", self.place(*share)), id=finger) for finger, share in enumerate(shares)]
        self.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def errors(self):
        return [line for line in self.browser.get_log("browser") if line["level"] == "SEVERE"
                and "ERR_CONNECTION_REFUSED" not in line["message"]]


@contextlib.contextmanager
def open_page(nodes, opener=open_small_browser):
    """The page of nodes in a browser of its own."""
    browser = opener()
    try:
        yield Page(browser, nodes.address)
    finally:
        browser.quit()
