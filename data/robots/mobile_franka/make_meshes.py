# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the meshes of mobile_franka.urdf beside this file: `python3 make_meshes.py`.

Every link is a few convex pieces of our own design that fill about the room that the real link
fills. A piece is a stack of rings ("loft"): `visual` has many points per ring, `collision` few (at
most 40 vertices), both inside the same outline. Standard library only; same bytes every time.
"""
import math
import pathlib

FOLDER = pathlib.Path(__file__).parent / "meshes"


def circle(radius, count):
    # the corners lie outside the circle so far that the area is that of the circle
    corner = radius * math.sqrt(2 * math.pi / count / math.sin(2 * math.pi / count))
    angles = [2 * math.pi * (i + 0.5) / count for i in range(count)]
    return [(corner * math.cos(a), corner * math.sin(a)) for a in angles]


def rounded_box(half_x, half_y, radius, count):
    corner_count = max(1, count // 4)
    points = []
    for quarter, (sx, sy) in enumerate([(1, 1), (-1, 1), (-1, -1), (1, -1)]):
        for i in range(corner_count):
            a = math.pi / 2 * (quarter + (i / (corner_count - 1) if corner_count > 1 else 0.5))
            points.append((sx * (half_x - radius) + radius * math.cos(a),
                           sy * (half_y - radius) + radius * math.sin(a)))
    return points


def loft(rings, place):
    """rings: [(height, outline)], outlines of equal length; place: (x, y, z) -> link frame."""
    count = len(rings[0][1])
    vertices = [place(x, y, z) for z, outline in rings for x, y in outline]
    faces = []
    for ring in range(len(rings) - 1):
        low, high = ring * count, (ring + 1) * count
        for i in range(count):
            j = (i + 1) % count
            faces += [(low + i, low + j, high + j), (low + i, high + j, high + i)]
    top = (len(rings) - 1) * count
    for i in range(1, count - 1):
        faces += [(0, i + 1, i), (top, top + i, top + i + 1)]
    return vertices, faces


def turned(axis, center):
    """Puts a loft along z onto `axis` through `center`; right-handed for each axis."""
    cx, cy, cz = center
    return {"x": lambda x, y, z: (cx + z, cy + x, cz + y),
            "y": lambda x, y, z: (cx + y, cy + z, cz + x),
            "z": lambda x, y, z: (cx + x, cy + y, cz + z)}[axis]


def profile(low, high, bevel, fine):
    """Heights and insets of a rounded edge at both ends."""
    steps = 4 if fine else 1
    ends = []
    for i in range(steps + 1):
        a = math.pi / 2 * i / steps
        ends.append((bevel * (1 - math.sin(a)), bevel * (1 - math.cos(a))))
    bottom = [(low + h, inset) for inset, h in ends]
    return bottom + [(high - h, inset) for inset, h in reversed(ends)]


def cylinder(axis, center, span, radius, bevel=0.012):
    def make(fine):
        count = 28 if fine else 10
        rings = [(z, circle(radius - inset, count))
                 for z, inset in profile(span[0], span[1], bevel, fine)]
        return loft(rings, turned(axis, center))
    return make


def block(axis, center, span, half, radius, bevel=0.006):
    def make(fine):
        count = 24 if fine else 8
        rings = [(z, rounded_box(half[0] - inset, half[1] - inset, max(radius - inset, 1e-4), count))
                 for z, inset in profile(span[0], span[1], bevel, fine)]
        return loft(rings, turned(axis, center))
    return make


def sloped_cylinder(start, end, radius_start, radius_end):
    """Forearm: circles in planes of constant z whose centre moves from `start` to `end`."""
    def make(fine):
        count, rings = (28 if fine else 12), []
        for z, t, scale in [(start[2] - 0.012, 0, 0.8), (start[2], 0, 1), (end[2], 1, 1),
                            (end[2] + 0.012, 1, 0.8)]:
            radius = scale * (radius_start + t * (radius_end - radius_start))
            cx, cy = (start[i] + t * (end[i] - start[i]) for i in (0, 1))
            rings.append((z, [(cx + x, cy + y) for x, y in circle(radius, count)]))
        if not fine:
            rings = [rings[0], rings[1], rings[2]]
        return loft(rings, turned("z", (0, 0, 0)))
    return make


def finger(sign):
    """Flat pad, 21 x 53.5 mm, its inner face in the plane y = 0; the back tapers to the tip."""
    def make(_fine):
        rings = []
        for z, back, half in [(0.0, 0.016, 0.0105), (0.030, 0.015, 0.0105), (0.0535, 0.008, 0.0105)]:
            outline = [(-half, 0.0), (half, 0.0), (half, back - 0.003), (half - 0.003, back),
                       (-half + 0.003, back), (-half, back - 0.003)]
            if sign < 0:
                outline = [(x, -y) for x, y in reversed(outline)]
            rings.append((z, outline))
        return loft(rings, turned("z", (0, 0, 0)))
    return make


PIECES = {
    "platform": block("z", (0.0, 0, 0), (-0.095, -0.012), (0.27, 0.23), 0.08, 0.012),
    "link0_foot": block("z", (-0.04, 0, 0), (-0.012, 0.07), (0.11, 0.09), 0.05),
    "link0_column": cylinder("z", (0, 0, 0), (0.0, 0.140), 0.065),
    "link1_column": cylinder("z", (0, 0, 0), (-0.190, 0.02), 0.055),
    "link1_shoulder": cylinder("y", (0, 0, 0), (-0.126, 0.04), 0.057, 0.02),
    "link2_shoulder": cylinder("z", (0, 0, 0), (-0.04, 0.126), 0.057, 0.02),
    "link2_column": cylinder("y", (0, 0, 0), (-0.192, 0.02), 0.055),
    "link3_column": cylinder("z", (0, 0, 0), (-0.119, 0.02), 0.055),
    "link3_elbow": cylinder("y", (0.0825, 0, 0), (-0.03, 0.108), 0.054, 0.02),
    "link4_elbow": cylinder("z", (0, 0, 0), (-0.03, 0.108), 0.054, 0.02),
    "link4_column": cylinder("y", (-0.0825, 0, 0), (-0.02, 0.122), 0.054),
    "link5_forearm": sloped_cylinder((0, 0, -0.25), (0, 0.062, -0.03), 0.053, 0.044),
    "link5_wrist": cylinder("y", (0, 0, 0), (0.0, 0.122), 0.050, 0.02),
    "link6_wrist": cylinder("z", (0, 0, 0), (-0.04, 0.050), 0.048, 0.02),
    "link6_flange": cylinder("y", (0.088, 0, 0), (-0.03, 0.052), 0.047, 0.02),
    "link7_flange": cylinder("z", (0, 0, 0), (0.054, 0.107), 0.044),
    "hand": block("y", (0, 0, 0.0325), (-0.102, 0.102), (0.0330, 0.0315), 0.014, 0.010),
    "finger_left": finger(1),
    "finger_right": finger(-1),
}


def decimal(number):
    text = f"{number:.6f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def to_obj(vertices, faces):
    lines = ["v " + " ".join(map(decimal, vertex)) for vertex in vertices]
    return "\n".join(lines + ["f " + " ".join(str(i + 1) for i in face) for face in faces]) + "\n"


def main():
    for kind, fine in (("visual", True), ("collision", False)):
        (FOLDER / kind).mkdir(parents=True, exist_ok=True)
        for name, make in PIECES.items():
            vertices, faces = make(fine)
            assert fine or len(vertices) <= 40, (name, len(vertices))
            (FOLDER / kind / f"{name}.obj").write_text(to_obj(vertices, faces))


if __name__ == "__main__":
    main()
