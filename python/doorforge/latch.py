# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The latch of a door for other simulators, with numpy alone.

No exchange format has a latch but MJCF, so a door that was exported as URDF or USD opens at a touch. Here are both
laws of docs/environment.md, for a loop of your own:

    law = doorforge.latch.EffortLaw.of_door("exported/door")     # or of numbers
    while True:
        hinge, handle = ...                                      # angles [rad], 0 on the closed door at rest
        torque = law.torque(hinge, handle)                       # [N m] (hinge, handle): add them to the joints
        ...                                                      # step the simulator

All of it takes arrays as well, one element an environment. docs/python.md has the ten lines for each simulator.
"""
from __future__ import annotations

import dataclasses
import json
import os
import pathlib
from typing import Any, Optional, Union

import numpy as np

AJAR_RAD = 0.01  # from here on an effort latch does not catch

Array = np.ndarray
Path = Union[str, "os.PathLike[str]"]


def _record_of(folder: Path) -> dict[str, Any]:
    path = pathlib.Path(folder)
    path = path / "door.json" if path.is_dir() else path
    with open(path, encoding="utf-8") as file:
        record: dict[str, Any] = json.load(file)
    if record.get("schema") != "doorforge.door":
        raise ValueError(f"{path}: schema {record.get('schema')!r}, expected 'doorforge.door'")
    return record


@dataclasses.dataclass
class EffortLaw:
    """Section 3.2 of UniDoorManip: while locked the hinge feels -lock_effort_nm, else its spring.

    Positive hinge angles open, positive handle angles unlock; see docs/environment.md for the three variants of when it
    is locked. Remembers from step to step what the law remembers: call `reset()` when the door is closed anew.
    """
    unlock_angle_rad: float
    handle_done_angle_rad: float = np.inf
    lock_effort_nm: float = 150.0
    hinge_spring_nm_per_rad: float = 3.0
    handle_spring_nm_per_rad: float = 3.0
    relatch: bool = False
    unlocks_ajar: bool = False
    is_latched: bool = True  #: False: a door without a latch, which has springs alone.

    def __post_init__(self) -> None:
        self.locked: Array = np.asarray(self.is_latched)
        self.handle_done: Array = np.asarray(not self.is_latched)

    @classmethod
    def of_door(cls, door: Any) -> "EffortLaw":
        """Of a doorforge.Door, or of a folder with a door.json."""
        if isinstance(door, (str, os.PathLike)):
            latch = _record_of(door)["latch"]
            get = latch.get
        else:
            latch = door.latch
            get = lambda name, default=None: getattr(latch, name, default)  # noqa: E731
        return cls(get("unlock_angle_rad"), get("handle_done_angle_rad"), get("lock_effort_nm"),
                   get("hinge_spring_nm_per_rad"), get("handle_spring_nm_per_rad"), bool(get("relatch", False)),
                   bool(get("unlocks_ajar", False)), get("type") != "none")

    def reset(self, shape: tuple[int, ...] = (), which: Optional[Array] = None) -> None:
        """Closed and at rest. `shape`: of the environments; `which`: only those where it is True."""
        if which is None:
            self.locked = np.full(shape, self.is_latched)
            self.handle_done = np.full(shape, not self.is_latched)
        else:
            self.locked = np.where(which, self.is_latched, self.locked)
            self.handle_done = np.where(which, not self.is_latched, self.handle_done)

    def torque(self, hinge_rad: Any, handle_rad: Any) -> tuple[Array, Array]:
        """Torques on hinge and handle [N m], once a step, after the joints have come to these angles."""
        hinge, handle = np.asarray(hinge_rad, float), np.asarray(handle_rad, float)
        if self.is_latched:
            self.handle_done = self.handle_done | (handle >= self.handle_done_angle_rad)
            if self.unlocks_ajar:
                free = np.abs(hinge) > AJAR_RAD
            else:
                free = ~np.asarray(self.locked) & (hinge > AJAR_RAD) & (not self.relatch)
            self.locked = (handle <= self.unlock_angle_rad) & ~free
        held = self.locked if self.is_latched else np.zeros_like(hinge, bool)
        on_hinge = np.where(held, -self.lock_effort_nm, -self.hinge_spring_nm_per_rad * hinge)
        return on_hinge, -self.handle_spring_nm_per_rad * handle


# The bolt's numbers, those of schemas/bolt.h.
_HALF_WIDTH = 0.006
_PLAY = 0.001
_MOST_PLAY_RAD = 0.004
_CLEARANCE = 0.03
_STRIKE_THICKNESS = 0.02
_SPARE_TRAVEL = 0.002
_ORDINARY_THROW = 0.012


@dataclasses.dataclass
class BoltLaw:
    """A bolt that stands behind a strike while the handle is let go, for simulators without contact for it.

    It is caught as in doorforge, by where its tip stands. Where doorforge and the MJCF export let bolt and strike touch,
    this law holds a caught leaf by a stiff spring from the angle on at which they would: `hold_nm_per_rad`, which should
    be as stiff as the simulator's step bears. The bolt follows the handle without delay.
    """
    throw_m: float
    unlock_angle_rad: float
    hinge_spring_nm_per_rad: float
    handle_spring_nm_per_rad: float
    tip_in_leaf_m: Array              #: (3,) of the bolt thrown, in the leaf's frame at hinge angle 0.
    out_of_leaf: Array                #: (3,) unit, the way in which the bolt is thrown.
    base_from_leaf_m: Array           #: (3,) the leaf's origin, on the hinge, in the base's frame.
    hinge_axis: Array                 #: (3,) unit.
    corner_in_base_m: Array           #: (3,) of the strike.
    opens: Array                      #: (3,) unit, the way in which the edge goes as the door opens.
    play_rad: float                   #: Hinge angle at which bolt and strike touch.
    hold_nm_per_rad: float = 2e4

    def __post_init__(self) -> None:
        self.bolt_m: Array = np.asarray(0.0)
        self.locked: Array = np.asarray(True)

    @classmethod
    def of_door(cls, door: Any, hold_nm_per_rad: float = 2e4) -> "BoltLaw":
        """Of a doorforge.Door, or of a folder with a door.json and its meshes."""
        known = _door_numbers(door)
        left, pull = known["hinge_side"] == "left", known["opening"] == "pull"
        throw = known["bolt_throw_m"] if known["type"] == "bolt" else _ORDINARY_THROW
        low, high = known["leaf_low"], known["leaf_high"]
        out = np.array([0.0, 1.0 if left else -1.0, 0.0])
        opens = np.array([1.0 if pull else -1.0, 0.0, 0.0])
        edge = np.array([(low[0] + high[0]) / 2, high[1] if left else low[1], known["handle_height"]])
        drawn = np.array([opens[0] * (edge + _HALF_WIDTH * opens)[0], out[1] * edge[1]])  # beside the hinge
        radius = drawn[1]
        play = min(_PLAY, _MOST_PLAY_RAD * abs(radius))
        angle = play / max(abs(radius), 0.01)
        met = np.cos(angle) * drawn[1] - np.sin(angle) * drawn[0]
        rise = max(met - drawn[1], 0.0)
        origin = known["hinge_origin"]
        corner = origin + edge + (_HALF_WIDTH + play) * opens + (rise + _CLEARANCE * throw) * out
        return cls(throw, known["unlock_angle_rad"], known["hinge_spring_nm_per_rad"], known["handle_spring_nm_per_rad"],
                   edge + _HALF_WIDTH * opens + throw * out, out, origin, known["hinge_axis"], corner, opens, angle,
                   hold_nm_per_rad)

    def reset(self, shape: tuple[int, ...] = ()) -> None:
        """Closed, the bolt thrown."""
        self.bolt_m = np.zeros(shape)
        self.locked = np.ones(shape, bool)

    def drawn(self, handle_rad: Any) -> Array:
        """Where the handle draws the bolt [m]: 0 thrown, -throw_m at the unlock angle and beyond."""
        wanted = self.throw_m / self.unlock_angle_rad * np.asarray(handle_rad, float)
        return -np.clip(wanted, 0.0, self.throw_m)

    def is_caught(self, hinge_rad: Any, bolt_m: Any) -> Array:
        """Whether the bolt's tip stands behind the strike."""
        hinge, bolt = np.asarray(hinge_rad, float), np.asarray(bolt_m, float)
        tip = self.tip_in_leaf_m + bolt[..., None] * self.out_of_leaf
        c, s = np.cos(hinge)[..., None], np.sin(hinge)[..., None]
        k = self.hinge_axis
        turned = tip * c + np.cross(k, tip) * s + k * (tip @ k)[..., None] * (1 - c)  # Rodrigues
        from_corner = turned + self.base_from_leaf_m - self.corner_in_base_m
        return (from_corner @ self.out_of_leaf > 0) & (from_corner @ self.opens < _STRIKE_THICKNESS / 2)

    def torque(self, hinge_rad: Any, handle_rad: Any) -> tuple[Array, Array]:
        """Torques on hinge and handle [N m], once a step."""
        hinge, handle = np.asarray(hinge_rad, float), np.asarray(handle_rad, float)
        self.bolt_m = self.drawn(handle)
        self.locked = self.is_caught(hinge, self.bolt_m)
        beyond = np.maximum(hinge - self.play_rad, 0.0)
        on_hinge = -self.hinge_spring_nm_per_rad * hinge - np.where(self.locked, self.hold_nm_per_rad * beyond, 0.0)
        return on_hinge, -self.handle_spring_nm_per_rad * handle


def _door_numbers(door: Any) -> dict[str, Any]:
    if isinstance(door, (str, os.PathLike)):
        return _numbers_of_folder(pathlib.Path(door))
    leaf = [door.mesh(name)[0] for name in door.links["leaf"] if door.label(name) != "handle"]
    points = np.concatenate(leaf)
    latch = door.latch
    return {"type": latch.type, "bolt_throw_m": latch.bolt_throw_m, "unlock_angle_rad": latch.unlock_angle_rad,
            "hinge_spring_nm_per_rad": latch.hinge_spring_nm_per_rad,
            "handle_spring_nm_per_rad": latch.handle_spring_nm_per_rad,
            "hinge_side": door.hinge_side, "opening": door.opening, "leaf_low": points.min(0), "leaf_high": points.max(0),
            "handle_height": door.handle_joint.parent_from_child_at_zero[2, 3],
            "hinge_origin": door.hinge.parent_from_child_at_zero[:3, 3], "hinge_axis": door.hinge.axis}


def _vertices(path: pathlib.Path) -> Array:
    with open(path, encoding="ascii") as lines:
        # as the reader of the toolkit: each number is that of a float32
        return np.array([line.split()[1:4] for line in lines if line.startswith("v ")], np.float32).astype(float)



def _numbers_of_folder(folder: pathlib.Path) -> dict[str, Any]:
    record = _record_of(folder)
    latch, hinge = record["latch"], record["hinge"]
    leaf = next(link for link in record["links"] if link["name"] == "leaf")
    points = []
    for geometry in leaf["geometry"]:
        if geometry["label"] == "handle":
            continue
        if "mesh" not in geometry:
            raise ValueError(f"{folder}: the door shares its meshes with others; write it by itself first: "
                             "`doorforge compose --standalone`, or doorforge.read_door(folder).save(...)")
        points.append(_vertices(folder / geometry["mesh"]["path"]))
    cloud = np.concatenate(points)
    place = hinge["parent_from_child_at_zero"]
    return {"type": latch["type"], "bolt_throw_m": latch.get("bolt_throw_m", 0.0),
            "unlock_angle_rad": latch["unlock_angle_rad"],
            "hinge_spring_nm_per_rad": latch["hinge_spring_nm_per_rad"],
            "handle_spring_nm_per_rad": latch["handle_spring_nm_per_rad"],
            "hinge_side": record.get("hinge_side", "left"), "opening": record.get("opening", "pull"),
            "leaf_low": cloud.min(0), "leaf_high": cloud.max(0),
            "handle_height": record["handle_joint"]["parent_from_child_at_zero"]["position_m"][2],
            "hinge_origin": np.asarray(place["position_m"], float), "hinge_axis": np.asarray(hinge["axis"], float)}


__all__ = ["AJAR_RAD", "BoltLaw", "EffortLaw"]
