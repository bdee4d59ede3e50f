# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""A headless Chromium, driven by the DevTools protocol; WebGL is drawn by its software renderer."""
import asyncio
import base64
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import time
import urllib.request

import websockets

CODES = {"Tab": 9, "Escape": 27, "ArrowDown": 40, "Enter": 13}
FLAGS = ["--headless=new", "--no-sandbox", "--disable-quic", "--no-first-run", "--hide-scrollbars", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--disable-extensions", "--remote-debugging-port=0", "--remote-allow-origins=*"]


def chromium() -> str:
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    assert found, "no chromium on this machine; it is in packages.txt"
    return found


class Browser:
    """One page. `errors` holds what the console said, `requests` the addresses asked for, beside the page's own."""

    def __init__(self, *flags: str, width: int = 1200, height: int = 800) -> None:
        self.folder = tempfile.TemporaryDirectory()
        self.loop = asyncio.new_event_loop()
        self.process = subprocess.Popen([chromium(), *FLAGS, *flags, f"--user-data-dir={self.folder.name}", f"--window-size={width},{height}", "about:blank"],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        port_file = pathlib.Path(self.folder.name) / "DevToolsActivePort"
        deadline = time.monotonic() + 60
        while not port_file.exists() or not port_file.read_text().strip():
            assert time.monotonic() < deadline and self.process.poll() is None, "chromium does not start"
            time.sleep(0.05)
        port = port_file.read_text().split()[0]
        target = None  # the port is there a moment before the page
        while target is None:
            assert time.monotonic() < deadline, "chromium shows no page"
            with urllib.request.urlopen(f"http://127.0.0.1:{port}/json") as answer:
                target = next((t for t in json.load(answer) if t["type"] == "page"), None)
        self.socket = self.loop.run_until_complete(self._connect(target["webSocketDebuggerUrl"]))
        self.count = 0
        self.errors: list[str] = []
        self.requests: list[str] = []
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def __enter__(self) -> "Browser":
        return self

    def __exit__(self, *_: object) -> None:
        self.loop.run_until_complete(self.socket.close())
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.loop.close()
        for _ in range(50):  # its children may still write
            try:
                return self.folder.cleanup()
            except OSError:
                time.sleep(0.1)

    @staticmethod
    async def _connect(address: str) -> websockets.WebSocketClientProtocol:
        return await websockets.connect(address, max_size=None)

    def _note(self, message: dict) -> None:
        method, params = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            self.errors.append(json.dumps(params["exceptionDetails"])[:1000])
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning", "assert"):
            self.errors.append(json.dumps(params["args"])[:1000])
        elif method == "Log.entryAdded" and params["entry"]["level"] in ("error", "warning"):
            if "GPU stall due to ReadPixels" not in params["entry"]["text"]:  # the driver's advice, where it is software
                self.errors.append(json.dumps(params["entry"])[:1000])
        elif method == "Network.requestWillBeSent":
            self.requests.append(params["request"]["url"][:200])

    def call(self, method: str, timeout: float = 300, **params: object) -> dict:
        return self.loop.run_until_complete(asyncio.wait_for(self._call(method, params), timeout))

    async def _call(self, method: str, params: dict) -> dict:
        self.count += 1
        number = self.count
        await self.socket.send(json.dumps({"id": number, "method": method, "params": params}))
        while True:
            message = json.loads(await self.socket.recv())
            self._note(message)
            if message.get("id") == number:
                assert "error" not in message, message
                return message["result"]

    def js(self, expression: str) -> object:
        """The value of an expression, awaited."""
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True, userGesture=True)
        assert "exceptionDetails" not in result, result
        return result["result"].get("value")

    def open(self, url: str, ready: bool = True) -> None:
        self.errors.clear()
        self.requests.clear()
        self.call("Page.navigate", url=url)
        if ready:
            self.wait("document.documentElement?.dataset.ready !== undefined && location.href !== 'about:blank'")

    def wait(self, expression: str, seconds: float = 300) -> None:
        deadline = time.monotonic() + seconds
        while not self.js(expression):
            assert time.monotonic() < deadline, (expression, self.errors)
            time.sleep(0.02)

    def size(self, width: int, height: int, mobile: bool = False) -> None:
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=mobile)
        self.settle()

    def settle(self) -> None:
        """Two frames, so that what changed is drawn."""
        self.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")

    def click(self, x: float, y: float) -> None:
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
        self.settle()

    def click_on(self, selector: str) -> None:
        box = self.js(f"(() => {{ const e = document.querySelector({json.dumps(selector)}); e.scrollIntoView({{block: 'center'}}); "
                      "const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })()")
        self.click(*box)

    def choose_files(self, selector: str, *paths: pathlib.Path) -> None:
        """Puts files into a field for files, as its dialog does."""
        root = self.call("DOM.getDocument")["root"]["nodeId"]
        field = self.call("DOM.querySelector", nodeId=root, selector=selector)["nodeId"]
        self.call("DOM.setFileInputFiles", nodeId=field, files=[str(path) for path in paths])

    def key(self, key: str, modifiers: int = 0) -> None:
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=key, modifiers=modifiers,
                      windowsVirtualKeyCode=CODES.get(key, 0), **({"text": "\r"} if key == "Enter" else {}))
        self.settle()

    def screenshot(self, path: pathlib.Path | None = None) -> bytes:
        picture = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        if path is not None:
            path.write_bytes(picture)
        return picture

    def processor_s(self) -> float:
        """Processor's time of all its processes so far, which hangs little on what else the machine does."""
        stats = {}
        for path in pathlib.Path("/proc").glob("[0-9]*/stat"):
            try:
                words = path.read_text().rpartition(")")[2].split()
            except OSError:
                continue  # it has ended
            stats[int(path.parent.name)] = (int(words[1]), int(words[11]) + int(words[12]))
        ours = {self.process.pid}
        while more := {pid for pid, (parent, _) in stats.items() if parent in ours} - ours:
            ours |= more
        return sum(stats[pid][1] for pid in ours if pid in stats) / os.sysconf("SC_CLK_TCK")

    def foreign_requests(self) -> list[str]:
        return [url for url in self.requests if not url.startswith(("file:", "data:", "blob:", "about:"))]
