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
from drop_test import LEVER, box, stl  # noqa: E402
from pages import BUILD, run  # noqa: E402

SITE = pathlib.Path(__file__).resolve().parents[2] / "scripts/site/build_site.py"


def judged(browser: Browser, address: str, name: str, before=lambda: None, ready: bool = True) -> int:
    """Number of violations, on both screens, once `before` has brought the page there; `ready` if it says when it is drawn."""
    faults = 0
    for width, height in ((1200, 800), (390, 844)):
        browser.size(width, height, mobile=width < 500)
        browser.open("about:blank", ready=False)
        browser.open(address, ready)
        browser.wait("document.readyState === 'complete' && location.href !== 'about:blank'")
        before()
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
        run("datagen", "open", "--doors", folder / "doors/a", "--out", folder / "data", "--episodes", "1")
        run("dataset", "films", folder / "data", "--doors", folder / "doors/a", "--stored", "1", "--out", folder / "data.jsonl")
        run("view", folder / "data", "--doors", folder / "doors/a", "--films", folder / "data.jsonl", "--out", folder / "data.html")
        faults += judged(browser, (folder / "data.html").as_uri(), "stored episode with forces")
        run("eval", "--opener", "expert", "--doors", folder / "doors", "--seeds", "1", "--set", "scene.physics.max_opening_actions=4", "--films", "--out", folder / "report")
        films = (folder / "report/films.html").as_uri()
        faults += judged(browser, films, "report")
        faults += judged(browser, films, "film", lambda: browser.js("document.querySelector('tbody button').click()"))
        subprocess.run([sys.executable, "-B", SITE, BUILD, folder / "site"], check=True, stdout=subprocess.DEVNULL)
        for page in ("index.html", "compose.html", "commands/view.html", "doors/index.html"):
            faults += judged(browser, (folder / "site" / page).as_uri(), f"site, {page}", ready=False)

        def search() -> None:
            browser.js("$('#mkdocs_search_modal').modal('show'); 0")
            browser.wait("document.activeElement.id === 'mkdocs-search-query'")
            browser.call("Input.insertText", text="handle")
            browser.wait("document.querySelector('#mkdocs-search-results article') !== null")
        faults += judged(browser, (folder / "site/compose.html").as_uri(), "site, search", search, ready=False)
        server = subprocess.Popen([BUILD / "bin/doorforge", "serve", "--port", "0"], stdout=subprocess.PIPE, text=True)
        address = server.stdout.readline().split(": ")[0]
        faults += judged(browser, address, "composer")
        (folder / "lever.stl").write_bytes(stl(LEVER))

        def drop() -> None:
            browser.choose_files("#file", folder / "lever.stl")
            browser.wait("document.querySelector('dialog.own[open]') !== null")
            browser.js("doorforge.composer.offered.setUp('0,0.1,1'), doorforge.composer.offered.setFront('1,0.1,0')")
        faults += judged(browser, address, "composer, a dropped mesh", drop)

        def drop_two() -> None:
            browser.choose_files("#file", folder / "lever.stl", folder / "rose.stl")
            browser.wait("document.querySelector('dialog.own[open]') !== null")
            browser.js("doorforge.composer.offered.setBeside('rose.stl')")
        (folder / "rose.stl").write_bytes(stl(box((-26, -26, 0), (26, 26, 8))))
        faults += judged(browser, address, "composer, two dropped meshes", drop_two)
        faults += judged(browser, address, "composer, all settings", lambda: browser.js("document.querySelector('.more').open = true"))
        server.send_signal(signal.SIGTERM)
        server.wait(20)
        return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
