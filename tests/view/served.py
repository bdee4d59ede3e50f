# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of `doorforge serve` share: a server, its page in the browser, and requests past the page."""
import http.client
import io
import pathlib
import signal
import socket
import subprocess
import zipfile

from pages import BUILD, PageTest


def files_of(folder: pathlib.Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def members_of(archive: bytes) -> dict[str, bytes]:
    """Files of a door in a ZIP file, without the folder's name."""
    with zipfile.ZipFile(io.BytesIO(archive)) as members:
        assert members.testzip() is None
        return {name.removeprefix("door/"): members.read(name) for name in members.namelist()}


class ServedTest(PageTest):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.server = subprocess.Popen([BUILD / "bin/doorforge", "serve", "--port", "0"], stdout=subprocess.PIPE, text=True)
        cls.addClassCleanup(cls.stop)
        cls.address = cls.server.stdout.readline().split(": ")[0]
        cls.port = int(cls.address.rstrip("/").rpartition(":")[2])

    @classmethod
    def stop(cls) -> None:
        cls.server.send_signal(signal.SIGTERM)
        assert cls.server.wait(300) == 0
        cls.server.stdout.close()

    def tearDown(self) -> None:
        self.assertIsNone(self.server.poll(), "the server has ended")
        ours = [url for url in self.browser.foreign_requests() if not url.startswith(self.address)]
        self.assertEqual(ours, [])

    def ask(self, method: str, path: str, body: str | bytes | None = None, **headers: str) -> tuple[int, bytes]:
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        given = {"Content-Type": "application/json"} if method == "POST" else {}
        try:
            connection.request(method, path, body, given | {name.replace("_", "-"): value for name, value in headers.items()})
        except (BrokenPipeError, ConnectionResetError):
            pass  # what is refused is not read to its end: the answer is there before all was sent
        try:
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def ask_raw(self, head: str) -> bytes:
        """The whole answer to a request of which these lines are sent, and no body."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=120) as raw:
            raw.sendall(head.encode())
            answer = b""
            while more := raw.recv(1 << 16):
                answer += more
            return answer

    def settled(self) -> None:
        self.browser.wait("window.doorforge?.composer && doorforge.composer.composed === doorforge.composer.request")

    def set(self, field: str, value: object) -> None:
        self.browser.js(f"(() => {{ const f = document.getElementById('{field}'); f.value = '{value}'; f.dispatchEvent(new Event(f.tagName === 'SELECT' ? 'change' : 'input')); }})()")
