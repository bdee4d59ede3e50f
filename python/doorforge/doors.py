# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Doors: compose, read, change, save, export, validate, draw.

Door frame: x out of the leaf towards who stands in front of the handle, z up, z = 0 the lowest point, y to that person's
right. All link frames are parallel to it at zero angles. Positive hinge angles open, positive handle angles unlock.
"""
from __future__ import annotations

import dataclasses
import os
import pathlib
import shutil
import subprocess
import tempfile
from typing import Any, Iterable, Literal, Optional, Sequence, Union

import numpy as np

from . import _engine
from .errors import Error, InvalidArgumentError, InvalidConfigError, MissingError

_core = _engine.require()

Path = Union[str, "os.PathLike[str]"]
Door = _core.Door
Joint = _core.Joint
Latch = _core.Latch
Format = Literal["urdf", "mjcf", "sdf", "glb", "usda"]


def _export(self: Any, folder: Path, *formats: str, overwrite: bool = False) -> None:
    """Writes the door for other simulators: urdf, mjcf, sdf, glb, usda, all into one folder.

    MissingError and InvalidArgumentError as `doorforge export`.
    """
    self._export(os.fspath(folder), list(formats), overwrite)


def _files_of(door: Any) -> tuple[Any, tuple[dict[str, bytes]]]:
    """For pickle: a door is the files of its folder."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch) / "door"
        door.save(folder)
        return _door_of_files, ({str(path.relative_to(folder)): path.read_bytes()
                                 for path in folder.rglob("*") if path.is_file()},)


def _door_of_files(files: dict[str, bytes]) -> Any:
    with tempfile.TemporaryDirectory() as scratch:
        for name, content in files.items():
            path = pathlib.Path(scratch) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        return _core.read_door(scratch)


Door.export = _export
Door.__reduce__ = _files_of
Door.__copy__ = lambda self: self  # nothing changes a door
Door.__deepcopy__ = lambda self, memo: self


def _is_to_import(name: str) -> bool:
    path = pathlib.Path(name)
    if (path / "part.json").exists() or any(letter in name for letter in "*?["):
        return False
    return path.exists() or bool(path.suffix)


def compose(body: Path, handle: Path, **settings: Any) -> Any:
    """Puts a handle on a body of the same category.

    `body` and `handle` are ids of the catalogue (see `catalogue()`), folders with a part.json, or mesh files and objects
    of other data sets, which the program `doorforge` beside this package repairs and imports first (it is GPL and not
    part of the package). `settings` are those of `doorforge compose --set`: latch="bolt", leaf_width_m=0.9,
    handle_height_m=1.05, hinge_side="right", opening="push", seed=3, ...

    Raises InvalidArgumentError, which begins with the code of the rule, if the two are no door; InvalidConfigError on a
    setting out of range; MissingError if there is no such part.
    """
    names = os.fspath(body), os.fspath(handle)
    if any(_is_to_import(name) for name in names):
        return _compose_by_program(*names, settings)
    return _core.compose(*names, settings)


def _compose_by_program(body: str, handle: str, settings: dict[str, Any]) -> Any:
    program = shutil.which("doorforge")
    if program is None:
        raise MissingError(f"compose: {body}, {handle}: a mesh is repaired and imported by the program `doorforge`, which "
                           "is not on PATH; install the package doorforge, or import the part elsewhere and give its folder")
    with tempfile.TemporaryDirectory() as scratch:
        out = pathlib.Path(scratch) / "door"
        words = [word for name, value in settings.items() for word in ("--set", f"{name}={_yaml(value)}")]
        run = subprocess.run([program, "compose", "--body", body, "--handle", handle, "--out", str(out), *words],
                             capture_output=True, text=True, check=False)
        if run.returncode != 0:
            message = run.stderr.strip().removeprefix("doorforge: ")
            raise {2: InvalidArgumentError, 3: MissingError}.get(run.returncode, Error)(message)
        return _core.read_door(str(out))


def _yaml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value)


def read_door(folder: Path) -> Any:
    """The door in a folder with a door.json. MissingError or FormatError as the command line."""
    return _core.read_door(os.fspath(folder))


def catalogue(role: Optional[str] = None, category: Optional[str] = None) -> list[dict[str, str]]:
    """The parts of the catalogue: {"id", "role": "body" or "handle", "category", "mechanism", "family"}."""
    return [row for row in _core.catalogue()
            if role in (None, row["role"]) and category in (None, row["category"])]


@dataclasses.dataclass(frozen=True)
class Finding:
    """One place where a rule is broken; see docs/validation-rules.md for the rules."""
    folder: str
    code: str
    severity: str
    where: str
    measured: str
    allowed: str
    fix: str
    fixable: bool


@dataclasses.dataclass(frozen=True)
class Validation:
    """What `doorforge validate` finds."""
    findings: list[Finding]
    folders: int
    missing: list[dict[str, Any]]

    @property
    def errors(self) -> list[Finding]:
        return [finding for finding in self.findings if finding.severity == "error"]

    @property
    def warnings(self) -> list[Finding]:
        return [finding for finding in self.findings if finding.severity == "warning"]

    @property
    def ok(self) -> bool:
        """There is something that was checked, and it has no errors."""
        return self.folders > 0 and not self.errors and not self.missing


def validate(what: Any, profile: Literal["urdf", "physics", "openable"] = "physics", threads: int = 0) -> Validation:
    """Checks a Door, a folder of a door or part, or folders of these, by the rules of `doorforge validate`."""
    if isinstance(what, Door):
        with tempfile.TemporaryDirectory() as scratch:
            what.save(os.path.join(scratch, "door"))
            return validate(scratch, profile, threads)
    paths = [what] if isinstance(what, (str, os.PathLike)) else list(what)
    record = _core.validate([os.fspath(path) for path in paths], profile, threads)
    return Validation([Finding(**finding) for finding in record["findings"]], record["counts"]["folders"],
                      record["missing"])


def preview(what: Any, **settings: Any) -> np.ndarray:
    """A picture, uint8 (height, width, 3), of a Door or of folders of doors and parts.

    Settings: hinge_deg, handle_deg, azimuth_deg, width, focus ("all", "whole", "handle"), collision.
    """
    if isinstance(what, Door):
        with tempfile.TemporaryDirectory() as scratch:
            folder = os.path.join(scratch, "door")
            what.save(folder)
            return preview(folder, **settings)
    folders = [what] if isinstance(what, (str, os.PathLike)) else list(what)
    return _core.preview([os.fspath(folder) for folder in folders], settings)


def find_doors(words: Union[Path, Iterable[Path]], default_side: str = "test", per_category: int = 0) -> list[str]:
    """Folders of the doors that --doors means: folders, and at most one split such as "full:test"; sorted by id."""
    if isinstance(words, (str, os.PathLike)):
        words = [words]
    return _core.find_doors([os.fspath(word) for word in words], default_side, per_category)


class DoorPool(Sequence[Any]):
    """Doors by number, made when they are asked for and kept while they are among the last `keep`.

    Of folders and splits, as the command line's --doors; a split alone ("full:train") means all doors that its side's
    parts of the catalogue make, composed as they are needed.
    """

    def __init__(self, doors: Any, default_side: str = "train", keep: int = 32) -> None:
        self._kept: dict[int, Any] = {}
        self._keep = keep
        if isinstance(doors, (str, os.PathLike, Door)):
            doors = [doors]
        doors = list(doors)
        if not doors:
            raise InvalidArgumentError("doors: there is none; give doors, folders of doors, or a split such as full:train")
        given = [door for door in doors if isinstance(door, Door)]
        words = [os.fspath(door) for door in doors if not isinstance(door, Door)]
        self._items: list[Any] = list(given)
        if words and not any(os.path.isdir(word) for word in words):
            if len(words) != 1:
                raise MissingError(f"doors: {', '.join(words)}: no such folders")
            self._items += _pairs_of_split(words[0], default_side)
        elif words:
            self._items += find_doors(words, default_side)

    def __len__(self) -> int:
        return len(self._items)

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        item = self._items[index]
        if isinstance(item, Door):
            return item
        index = index % len(self)
        door = self._kept.pop(index, None)
        if door is None:
            door = read_door(item) if isinstance(item, str) else compose(*item)
        self._kept[index] = door
        if len(self._kept) > self._keep:
            self._kept.pop(next(iter(self._kept)))
        return door

    def number_of(self, name: str) -> int:
        """The number of the door with this id or in this folder. MissingError if there is none."""
        for index, item in enumerate(self._items):
            if isinstance(item, Door):
                found = item.id == name
            elif isinstance(item, str):
                found = os.path.abspath(item) == os.path.abspath(name) or os.path.basename(item) == name
            else:
                found = "__".join(item) == name
            if found:
                return index
        raise MissingError(f"door: there is no \"{name}\" among the {len(self)} doors")


def _pairs_of_split(word: str, default_side: str) -> list[tuple[str, str]]:
    name, _, side = word.partition(":")
    side = side or default_side
    try:
        sides = _core.split_sides(name)
    except MissingError:
        raise MissingError(f"doors: \"{word}\" is neither a folder nor a split; there is the split full, as in "
                           "full:train") from None
    if side not in sides:
        raise InvalidArgumentError(f"doors: {word}: there is no side \"{side}\"; there are {', '.join(sides)}")
    parts = set(sides[side])
    rows = [row for row in catalogue() if row["id"] in parts]
    return [(body["id"], handle["id"]) for body in rows if body["role"] == "body"
            for handle in rows if handle["role"] == "handle" and handle["category"] == body["category"]]


__all__ = ["Door", "DoorPool", "Finding", "InvalidConfigError", "Joint", "Latch", "Validation", "catalogue", "compose",
           "find_doors", "preview", "read_door", "validate"]
