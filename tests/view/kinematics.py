# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Poses of a URDF's links, calculated without a line of the page or of the programs."""
import pathlib
import xml.etree.ElementTree

import numpy as np


def turned(axis: np.ndarray, angle: float) -> np.ndarray:
    """The matrix exponential of the axis' cross product, by its series: no formula of the page."""
    x, y, z = axis / np.linalg.norm(axis) * angle
    skew, term, total = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]), np.eye(3), np.eye(3)
    for k in range(1, 40):
        term = term @ skew / k
        total = total + term
    return total


def numbers(text: str | None) -> np.ndarray:
    return np.array([float(word) for word in (text or "0 0 0").split()])


def poses_of_urdf(path: pathlib.Path, angles: dict[str, float]) -> dict[str, np.ndarray]:
    robot = xml.etree.ElementTree.parse(path).getroot()
    poses = {"base": np.eye(4)}
    for joint in robot.findall("joint"):  # parents come first
        origin = joint.find("origin")
        step = np.eye(4)
        if origin is not None:
            roll, pitch, yaw = numbers(origin.get("rpy"))
            step[:3, :3] = turned(np.array([0, 0, 1.0]), yaw) @ turned(np.array([0, 1.0, 0]), pitch) @ turned(np.array([1.0, 0, 0]), roll)
            step[:3, 3] = numbers(origin.get("xyz"))
        if joint.get("type") != "fixed":
            step[:3, :3] = step[:3, :3] @ turned(numbers(joint.find("axis").get("xyz")), angles[joint.get("name")])
        poses[joint.find("child").get("link")] = poses[joint.find("parent").get("link")] @ step
    return poses


def matrix(pose: dict) -> np.ndarray:
    x, y, z, w = pose["quaternion_xyzw"]
    result = np.eye(4)
    result[:3, :3] = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                               [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                               [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    result[:3, 3] = pose["position_m"]
    return result
