# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Success of any policy in closed loop, with the report of `doorforge eval`."""
from __future__ import annotations

import os
from typing import Any, Callable, Iterable, Optional, Sequence, Union

import numpy as np

from . import _engine
from .doors import Path

_core = _engine.require()

PolicyLike = Union[str, "os.PathLike[str]", Callable[[dict[str, np.ndarray]], Any]]
GrasperLike = Union[str, "os.PathLike[str]", Callable[[dict[str, Any]], Any]]


class Report:
    """What an evaluation found. `record` is report.json (docs/format-report.md); print it for the table."""

    def __init__(self, record: dict[str, Any], table: str, notes: list[str]) -> None:
        self.record = record
        self.table = table
        self.notes = notes

    @property
    def success(self) -> dict[str, Any]:
        """By category and "overall": rate with its 95 % interval (low, high) and the number of episodes."""
        return self.record["success"]

    @property
    def causes(self) -> dict[str, int]:
        """Episodes that failed, by cause; "policy_failed" where the policy had no action to give, "door_gone" where the
        door's folder could be read no more."""
        return self.record["causes"]

    @property
    def episodes(self) -> list[dict[str, Any]]:
        return self.record["episodes"]

    def __str__(self) -> str:
        return self.table

    def __repr__(self) -> str:
        overall = self.success["overall"]
        return f"<doorforge.Report {overall['rate']:.3f} of {overall['episodes']} episodes>"


def evaluate(policy: PolicyLike, doors: Union[Path, Iterable[Path]], *, handler: PolicyLike = "expert",
             grasper: GrasperLike = "expert", observation: Sequence[str] = ("cloud", "proprioception"),
             seeds: Optional[int] = None, seed: Optional[int] = None, per_category: int = 0, threads: int = 0,
             config: Optional[dict[str, Any]] = None, data: Sequence[Path] = (), allow_seen: bool = False,
             out: Optional[Path] = None, overwrite: bool = False) -> Report:
    """Lets a policy open doors and counts what came of it.

    `policy` is called with a dict of the arrays named in `observation` (see Stepper.arrays) at each decision and gives
    nine numbers: how far the hand goes in the world [m], and the first two rows of world_from_hand. Beside those of a
    stepper there are "image" uint8 (height, width, 3), "depth" float32 (height, width) [m along the optical axis, inf:
    nothing] of the policies' camera, and "cloud_rgb" uint8 (4096, 3): what `pictures.cameras=[{name: own, at: scene}]`
    records. If it has a method
    `reset()`, that is called at the beginning of each episode. A name or a folder of a trained policy will do as well,
    and so for `handler`, who turns the handle. `grasper` takes hold: it is called once an episode with one look at the
    closed door, {"cloud": float32 (points, 3) [m, world], "cloud_label": uint8 (points,), 1 on the handle, "approach":
    float64 (3,), the way into the leaf, "hand_from_tcp": float64 (4, 4), "episode": text}, and gives the contact in the
    world [m] and the two rows, or None where it sees nothing to take hold of. An exception, an array of another shape or
    a number that is not finite ends that episode with the cause "policy_failed"; the evaluation goes on.

    A callable with `reset()` is taken to remember things: then episodes run one after the other. Others are called from
    several threads, one call at a time. `seeds` scenes of each door are tried, from `seed` on; `config` holds other
    settings of `doorforge eval --set`. `out` is a folder for report.json and report.html. Ctrl-C stops it.

    MissingError if doors are missing in the beginning; one that goes away later costs its episodes alone, with the
    cause "door_gone". InvalidArgumentError if doors were trained on (`allow_seen`), as the command line.
    """
    config = dict(config or {})
    if seeds is not None:
        config["seeds"] = seeds
    if seed is not None:
        config["first_seed"] = seed
    if isinstance(doors, (str, os.PathLike)):
        doors = [doors]
    if any(hasattr(who, "reset") for who in (policy, handler, grasper)):
        threads = 1
    found = _core.evaluate({
        "opener": _word(policy), "handler": _word(handler), "grasper": _word(grasper),
        "observation": list(observation), "doors": [os.fspath(door) for door in doors], "per_category": per_category,
        "threads": threads, "config": config, "data": [os.fspath(folder) for folder in data], "allow_seen": allow_seen,
        "out": "" if out is None else os.fspath(out), "overwrite": overwrite})
    return Report(found["report"], found["table"], found["notes"])


def _word(policy: Any) -> Any:
    return os.fspath(policy) if isinstance(policy, os.PathLike) else policy


__all__ = ["Report", "evaluate"]
