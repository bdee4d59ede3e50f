# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""colored_pixels.py PICTURE.png RED GREEN BLUE RIGHT: how many pixels left of RIGHT have this colour, and their mean place."""
import struct
import sys
import zlib


def rows_of(png: bytes) -> tuple[int, list[bytearray]]:
    """Width, and the rows of an 8-bit RGB picture, by the PNG specification (ISO/IEC 15948), chapters 5 and 9."""
    at, packed, width, height = 8, b"", 0, 0
    while at < len(png):
        length, kind = struct.unpack_from(">I4s", png, at)
        body = png[at + 8:at + 8 + length]
        at += 12 + length
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack_from(">IIBB", body)
            assert (depth, colour) == (8, 2), (depth, colour)
        elif kind == b"IDAT":
            packed += body
    raw, rows, before = zlib.decompress(packed), [], bytearray(3 * width)
    for y in range(height):
        start = y * (3 * width + 1)
        kind, row = raw[start], bytearray(raw[start + 1:start + 1 + 3 * width])
        for i in range(3 * width):
            a, b, c = (row[i - 3] if i >= 3 else 0), before[i], (before[i - 3] if i >= 3 else 0)
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
        rows.append(row)
        before = row
    return width, rows


def main() -> None:
    colour, right = [int(word) for word in sys.argv[2:5]], int(sys.argv[5])
    _, rows = rows_of(open(sys.argv[1], "rb").read())
    found = [(x, y) for y, row in enumerate(rows) for x in range(right)
             if all(abs(row[3 * x + k] - colour[k]) < 24 for k in range(3))]
    count = len(found)
    print(count, *(sum(place[k] for place in found) / max(1, count) for k in range(2)))


if __name__ == "__main__":
    main()
