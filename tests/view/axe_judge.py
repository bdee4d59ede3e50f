# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Pages of every kind before axe-core, on a wide and on a small screen; see axe_judge.sh.

usage: axe_judge.py BUILD AXE"""
import pathlib
import signal
import subprocess
import sys
import tempfile

AXE = pathlib.Path(sys.argv.pop(2)).read_text()

from browser import Browser  # noqa: E402
from pages import BUILD, run  # noqa: E402


def judged(browser: Browser, address: str, name: str) -> int:
    faults = 0
    for width, height in ((1200, 800), (390, 844)):
        browser.size(width, height, mobile=width < 500)
        browser.open(address)
        browser.js(AXE + ";0")
        for fault in browser.js("axe.run().then((r) => r.violations.map((v) => `${v.id}: ${v.help}: ${v.nodes[0].html.slice(0, 120)}`))"):
            print(f"{name}, {width} px: {fault}")
            faults += 1
    print(f"{name}: looked at")
    return faults


def main() -> int:
    with tempfile.TemporaryDirectory(dir=BUILD) as scratch, Browser() as browser:
        folder = pathlib.Path(scratch)
        run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--set", "latch=bolt", "--out", folder / "doors/a")
        run("compose", "--body", "safe_box_small_01", "--handle", "safe_dial_lever_01", "--out", folder / "doors/b")
        faults = 0
        for name, options in (("door", ()), ("gallery", ("--gallery",)), ("episode", ("--episode",))):
            run("view", folder / "doors", *options, "--out", folder / f"{name}.html")
            faults += judged(browser, (folder / f"{name}.html").as_uri(), name)
        server = subprocess.Popen([BUILD / "bin/doorforge", "serve", "--port", "0"], stdout=subprocess.PIPE, text=True)
        faults += judged(browser, server.stdout.readline().split(": ")[0], "composer")
        server.send_signal(signal.SIGTERM)
        server.wait(20)
        return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
