# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""`doorforge serve`: the page in a real Chromium against `doorforge compose` byte by byte, and requests that are refused.

usage: composer_test.py BUILD"""
import concurrent.futures
import json
import pathlib
import shlex
import socket
import unittest

from pages import BUILD, run
from served import ServedTest, files_of, members_of

BODY, LEVER = "interior_flush_01", "interior_lever_tube_01"


class ComposerPage(ServedTest):
    def request(self, **settings: object) -> str:
        return json.dumps({"body": BODY, "handle": LEVER, "settings": settings})

    def choose(self) -> None:
        self.browser.open(self.address)
        self.settled()
        self.browser.js("(() => { const c = document.getElementById('category'); c.value = 'interior'; c.dispatchEvent(new Event('change')); })()")
        for role, part in (("body", BODY), ("handle", LEVER)):
            self.browser.js(f"(() => {{ const g = doorforge.composer.grids.{role}; g.element.scrollTop = Math.floor(g.items.findIndex((i) => i.id === '{part}') / g.columns) * g.rowHeight; }})()")
            self.browser.settle()
            self.browser.wait(f"[...document.querySelectorAll('.card:not([hidden]) .open')].some((b) => b.textContent === '{part}')")
            self.browser.js(f"[...document.querySelectorAll('.card:not([hidden]) .open')].find((b) => b.textContent === '{part}').click(), 0")
        self.settled()

    def test_what_is_composed_is_compose_s_folder(self) -> None:
        self.choose()
        marked = self.browser.js("[...document.querySelectorAll('.card:not([hidden]) [aria-pressed=true]')].map((b) => b.textContent)")
        self.assertEqual(marked, [BODY, LEVER])
        self.set("hinge_side", "right")
        self.set("latch", "bolt")
        self.set("leaf_width_m", 0.85)
        self.settled()
        self.assertEqual(self.browser.js("doorforge.view.record.hinge_side"), "right")
        self.assertEqual(self.browser.js("doorforge.view.record.latch.type"), "bolt")
        self.assertEqual(self.browser.js("(doorforge.view.moveHinge(0.5), doorforge.view.latch.hinge < 0.01)"), True)
        self.browser.js("doorforge.composer.download()")
        got = bytes(self.browser.js("[...doorforge.composer.downloaded]"))
        members = members_of(got)
        command = shlex.split(self.browser.js("document.querySelector('.command code').textContent"))
        self.assertEqual(command[0], "doorforge")
        out = self.folder / "by_command"
        command[command.index("--out") + 1] = str(out)
        run(*command[1:])
        self.assertEqual(members, files_of(out))
        self.assertEqual(self.browser.errors, [])

    def test_what_a_category_begins_with_is_marked(self) -> None:
        self.browser.open(self.address)
        self.settled()
        self.set("category", "refrigerator")
        self.settled()
        marked = self.browser.js("[...document.querySelectorAll('.card:not([hidden]) [aria-pressed=true]')].map((b) => b.textContent)")
        self.assertEqual(marked, self.browser.js("[doorforge.composer.chosen.body, doorforge.composer.chosen.handle]"))

    def test_exports_are_export_s(self) -> None:
        run("compose", "--body", BODY, "--handle", LEVER, "--out", self.folder / "plain")
        for name in ("mjcf", "glb"):
            run("export", self.folder / "plain", "--format", name, "--out", self.folder / name)
            code, got = self.ask("POST", f"/download?format={name}", self.request())
            self.assertEqual(code, 200)
            self.assertEqual(members_of(got), files_of(next((self.folder / name).iterdir())))

    def test_does_it_open(self) -> None:
        self.choose()
        self.browser.js("doorforge.composer.open()")
        self.browser.wait("document.querySelector('dialog[open]') && !doorforge.composer.film.playing")
        self.assertEqual(self.browser.js("document.querySelector('dialog .chip').textContent"), "Opened")
        self.assertGreater(self.browser.js("doorforge.composer.film.episode.hinge.at(-1)"), 0.785)
        self.assertEqual(self.browser.errors, [])

    def test_what_is_wrong_is_said_and_the_page_goes_on(self) -> None:
        self.choose()
        self.set("leaf_width_m", 0.01)
        self.browser.wait("document.querySelector('.asked').classList.contains('refused')")
        self.assertIn("leaf_width_m", self.browser.js("document.querySelector('.asked').textContent"))
        self.set("leaf_width_m", "")
        self.browser.wait("document.querySelector('.asked').textContent === ''")
        self.settled()

    def hold_compositions(self) -> None:
        """Requests for a composition wait in `held` until they are let go, so that answers come in an order of the test's choice."""
        self.browser.js("""(() => {
          const real = window.fetch;
          window.held = [];
          window.fetch = (path, options) => (path === '/compose' ? new Promise((sent) => held.push(sent)).then(() => real(path, options)) : real(path, options));
        })()""")

    def held(self, count: int) -> None:
        self.browser.wait(f"held.length === {count}")

    def test_what_was_refused_stays_when_an_earlier_request_is_answered(self) -> None:
        self.choose()
        self.hold_compositions()
        self.set("leaf_width_m", 0.9)
        self.held(1)
        self.browser.js("doorforge.composer.drop([new File(['x'], 'notes.txt')])")
        said = "document.querySelector('.asked').textContent"
        self.assertIn("notes.txt", self.browser.js(said))
        self.browser.js("(held[0](), 0)")
        self.settled()
        self.assertIn("notes.txt", self.browser.js(said))
        self.assertEqual(self.browser.js("document.querySelector('.asked').classList.contains('refused')"), True)
        # until one goes on
        self.set("leaf_width_m", 0.85)
        self.held(2)
        self.browser.js("(held[1](), 0)")
        self.settled()
        self.assertEqual(self.browser.js(said), "")

    def test_a_refusal_of_settings_that_were_changed_since_is_not_said(self) -> None:
        self.choose()
        self.hold_compositions()
        self.set("leaf_width_m", 0.01)
        self.held(1)
        self.set("leaf_width_m", 0.9)
        self.held(2)
        self.browser.js("(held[1](), 0)")
        self.settled()
        self.browser.js("(held[0](), 0)")
        self.browser.wait("doorforge.composer.pending === 0")
        self.assertEqual(self.browser.js("document.querySelector('.asked').textContent"), "")

    def test_foreign_pages_and_names_are_refused(self) -> None:
        port, good = self.port, self.request()
        self.assertEqual(self.ask("POST", "/compose", good)[0], 200)
        for headers in ({"Host": "evil.example"}, {"Host": f"evil.example:{port}"}, {"Host": "127.0.0.1"}, {"Host": ""},
                        {"Origin": "http://evil.example"}, {"Origin": "null"}, {"Origin": f"http://127.0.0.1:{port + 1}"}, {"Sec_Fetch_Site": "cross-site"}):
            for method, path in (("GET", "/"), ("POST", "/compose")):
                self.assertIn(self.ask(method, path, good if method == "POST" else None, **headers)[0], (400, 403), headers)
        self.assertEqual(self.ask("POST", "/compose", good, Content_Type="text/plain")[0], 415)

    def test_bad_requests_are_refused(self) -> None:
        for body, code in (("", 400), ("{", 400), ("[]", 400), ("{}", 400), ('{"body": 1, "handle": 2}', 400), ("[" * 30000, 400),
                           (json.dumps({"body": "../../etc/passwd", "handle": LEVER}), 404), (json.dumps({"body": "interior_*", "handle": LEVER}), 404),
                           (json.dumps({"body": str(BUILD), "handle": LEVER}), 404), (json.dumps({"body": BODY, "handle": LEVER, "out": "/"}), 400),
                           (self.request(id="../../escaped"), 400), (self.request(no_such_setting=1), 400), (self.request(handle_scale=1e9), 400),
                           (json.dumps({"body": LEVER, "handle": BODY}), 400)):
            for path in ("/compose", "/open", "/download"):
                status, answer = self.ask("POST", path, body)
                self.assertEqual(status, code, (path, body[:80], answer[:300]))
                self.assertGreater(len(json.loads(answer)["error"]), 10)
        self.assertEqual(self.ask("POST", "/download?format=exe", self.request())[0], 400)
        self.assertEqual(self.ask("GET", "/thumbnail/..%2f..%2fetc%2fpasswd")[0], 404)
        self.assertEqual(self.ask("GET", "/thumbnail/no_such_part")[0], 404)
        self.assertEqual(self.ask("GET", "/../../etc/passwd")[0], 404)

    def test_large_bodies_are_refused(self) -> None:
        self.assertEqual(self.ask("POST", "/compose", b"x" * (1 << 20))[0], 413)
        announced = self.ask_raw(f"POST /compose HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nContent-Type: application/json\r\nContent-Length: {2 << 30}\r\n\r\n")
        self.assertIn(b"413", announced.splitlines()[0])
        self.assertEqual(self.ask("GET", "/")[0], 200)

    def test_the_page_does_not_wait_to_be_compressed(self) -> None:
        page = self.ask("GET", "/")[1]
        self.assertEqual(self.ask("GET", "/", Accept_Encoding="gzip, deflate, br, zstd"), (200, page))

    def test_two_tabs_at_once(self) -> None:
        def composed(side: str) -> bytes:
            return self.ask("POST", "/download", self.request(hinge_side=side))[1]
        alone = {side: composed(side) for side in ("left", "right")}
        self.assertNotEqual(alone["left"], alone["right"])
        sides = ["left", "right"] * 6
        with concurrent.futures.ThreadPoolExecutor(6) as pool:
            self.assertEqual(list(pool.map(composed, sides)), [alone[side] for side in sides])

    def test_no_other_machine_reaches_it(self) -> None:
        listening = [line.split() for line in pathlib.Path("/proc/net/tcp").read_text().splitlines()[1:]]
        ours = [words[1] for words in listening if words[3] == "0A" and int(words[1].partition(":")[2], 16) == self.port]
        self.assertEqual([address.partition(":")[0] for address in ours], ["0100007F"])

    def test_small_screen(self) -> None:
        self.choose()
        self.browser.size(390, 844, mobile=True)
        self.assertLessEqual(self.browser.js("document.documentElement.scrollWidth"), 390)


class ServeEnds(unittest.TestCase):
    def test_a_port_that_is_taken_is_told(self) -> None:
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            result = run("serve", "--port", taken.getsockname()[1], code=3)
            self.assertIn("is taken", result.stderr)

    def test_a_folder_that_is_not_there_is_told(self) -> None:
        self.assertIn("nowhere", run("serve", "--port", "0", "--parts", "nowhere", code=3).stderr)


if __name__ == "__main__":
    unittest.main()
