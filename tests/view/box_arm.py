# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""A robot of somebody else's as a URDF: seven turning joints, a gripper of two sliding fingers, boxes."""

SEGMENTS = (  # name, place of its joint on the parent, axis, size and centre of its box
    ("shoulder", (0, 0, 0.12), (0, 0, 1), (0.12, 0.12, 0.2), (0, 0, 0.1)),
    ("upper", (0, 0.1, 0.22), (0, 1, 0), (0.09, 0.07, 0.42), (0, 0, 0.2)),
    ("fore", (0, -0.08, 0.42), (0, 1, 0), (0.08, 0.07, 0.18), (0, 0, 0.1)),
    ("roll", (0, 0, 0.2), (0, 0, 1), (0.07, 0.07, 0.18), (0, 0, 0.1)),
    ("wrist1", (0, 0.08, 0.2), (0, 1, 0), (0.07, 0.07, 0.1), (0, 0, 0)),
    ("wrist2", (0, 0.09, 0), (0, 0, 1), (0.07, 0.07, 0.09), (0, 0, 0)),
    ("flange", (0.08, 0, 0), (1, 0, 0), (0.06, 0.07, 0.1), (0.03, 0, 0)))


def _words(numbers: tuple) -> str:
    return " ".join(map(str, numbers))


def _link(name: str, mass: float, size: tuple, center: tuple) -> str:
    inertia = [mass / 12 * (size[(k + 1) % 3] ** 2 + size[(k + 2) % 3] ** 2) for k in range(3)]
    shape = f'<origin xyz="{_words(center)}"/><geometry><box size="{_words(size)}"/></geometry>'
    return (f'<link name="{name}"><inertial><origin xyz="{_words(center)}"/><mass value="{mass}"/>'
            f'<inertia ixx="{inertia[0]}" iyy="{inertia[1]}" izz="{inertia[2]}" ixy="0" ixz="0" iyz="0"/></inertial>'
            f"<visual>{shape}</visual><collision>{shape}</collision></link>")


def _joint(kind: str, parent: str, child: str, place: tuple, axis: tuple, limit: tuple) -> str:
    lower, upper, effort = limit
    return (f'<joint name="{child}_joint" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{_words(place)}"/>'
            f'<axis xyz="{_words(axis)}"/><limit lower="{lower}" upper="{upper}" effort="{effort}" velocity="2"/></joint>')


def box_arm() -> str:
    text, parent = _link("pedestal", 5, (0.16, 0.16, 0.1), (0, 0, 0.05)), "pedestal"
    for name, place, axis, size, center in SEGMENTS:
        text += _link(name, 2, size, center) + _joint("revolute", parent, name, place, axis, (-2.8, 2.8, 150))
        parent = name
    for name, way in (("left", 1), ("right", -1)):
        text += _link(name, 0.1, (0.07, 0.02, 0.012), (0.06, 0, way * 0.006)) + _joint("prismatic", "flange", name, (0.03, 0, 0), (0, 0, way), (0, 0.04, 80))
    return f'<robot name="box_arm">{text}</robot>'
