# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Opens a report page in headless Chromium: no message in the console, and something to see.

usage: browser_check.py PAGE; exit code 77 where there is no Chromium."""
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--hide-scrollbars",
         "--disable-background-networking", "--disable-component-update", "--disable-sync", "--enable-logging=stderr"]


def rows_of(path: pathlib.Path) -> tuple[list[bytes], int]:
    """Unfiltered rows of an 8-bit RGB or RGBA PNG without interlace, and the bytes of a pixel."""
    png, at, data = path.read_bytes(), 8, b""
    width, height, depth, colour = struct.unpack(">IIBB", png[16:26])
    assert depth == 8 and colour in (2, 6)
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at:at + 8])
        data += png[at + 8:at + 8 + length] if kind == b"IDAT" else b""
        at += 12 + length
    pixel, data, rows = 3 if colour == 2 else 4, zlib.decompress(data), []
    for y in range(height):
        start = y * (width * pixel + 1)
        mode, row = data[start], bytearray(data[start + 1:start + 1 + width * pixel])
        above = rows[-1] if rows else bytes(width * pixel)
        for i in range(len(row)):
            left, up = (row[i - pixel] if i >= pixel else 0), above[i]
            corner = above[i - pixel] if i >= pixel else 0
            if mode == 4:
                estimate = left + up - corner
                near = sorted((left, up, corner), key=lambda v: abs(estimate - v))  # stable: Paeth's order
                row[i] = (row[i] + near[0]) & 255
            elif mode:
                row[i] = (row[i] + {1: left, 2: up, 3: (left + up) // 2}[mode]) & 255
        rows.append(bytes(row))
    return rows, pixel


def main(page: pathlib.Path) -> int:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if chromium is None:
        print("no chromium on this machine")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        picture = pathlib.Path(folder) / "page.png"
        result = subprocess.run([chromium, *FLAGS, f"--user-data-dir={folder}/profile", f"--screenshot={picture}",
                                 "--window-size=800,1200", page.resolve().as_uri()],
                                capture_output=True, text=True, timeout=120)
        messages = re.findall(r".*CONSOLE.*", result.stderr)
        if messages or not picture.exists():
            print("\n".join(messages) or result.stderr)
            return 1
        rows, pixel = rows_of(picture)
        colours = {row[i:i + 3] for row in rows[::7] for i in range(0, len(row), 5 * pixel)}
        blank = sum(len(set(row[i:i + 3] for i in range(0, len(row), pixel))) == 1 for row in rows)
        print(f"{len(colours)} colours, {blank} of {len(rows)} rows of one colour")
        return 0 if len(colours) > 20 and blank < 0.8 * len(rows) else 1


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
