# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Episodes: action by action (Stepper), or whole by policies with names (simulate)."""
from __future__ import annotations

import os
from typing import Any, Iterable, Optional, Sequence, Union

import numpy as np

from . import _engine
from .doors import Path
from .scenes import Robot

_core = _engine.require()


class Stepper:
    """Episodes of one door, action by action; see docs/step.md for stages, rewards and ends.

        stepper = doorforge.Stepper(door)
        stepper.reset(doorforge.sample_scene(door, seed=1))
        while not stepper.over:
            stepper.step(my_action(stepper.observation))

    The same scene and actions give the same bits as in C++. A stepper serves one thread at a time; several run side by
    side, since Python's lock is free while one computes.

    `first`: the stage from which on the actions are yours, "grasp", "handle" or "open"; rules do what comes before.
    `clouds`: the stages whose observations have a cloud; at others no picture is made.
    `cloud`: settings of the cloud, {"point_count": 1024, ...}. `remembered`: what a trained handle policy wants, its
    `policy.remembered`.
    """

    def __init__(self, door: Any, robot: Optional[Any] = None, *, first: str = "open", clouds: Sequence[str] = (),
                 cloud: Optional[dict[str, Any]] = None, remembered: Optional[dict[str, Any]] = None) -> None:
        cameras = {name: value for name, value in (("cloud", cloud), ("remembered", remembered)) if value is not None}
        self._held = _core.Stepper(door, robot if robot is not None else Robot(), first, list(clouds), cameras)

    def reset(self, scene: Any) -> Any:
        """Begins an episode and runs it to your first decision; gives the observation. If the rules fail before that,
        the episode is over already: sample another scene."""
        self._held.reset(scene)
        return self._held.observation

    def step(self, action: Any) -> Any:
        """Carries out an action, 1/6 s long. An Action, or nine numbers: how far the hand goes in the world [m] and the
        first two rows of world_from_hand. Gives the next observation; InvalidArgumentError on anything else."""
        self._held.step(action)
        return self._held.observation

    def save(self) -> Any:
        """The episode as it is now, to come back to."""
        return self._held.save()

    def restore(self, image: Any) -> Any:
        """Back to that point: the same actions then give the same bits."""
        self._held.restore(image)
        return self._held.observation

    def state(self) -> dict[str, Any]:
        """Where everything is: robot_position (11,) [m, rad], hinge_rad, handle_rad, locked, time_s, ..."""
        return self._held.state()

    def summary(self) -> dict[str, Any]:
        """The record so far: cause, detail, peaks [rad], simulated_s, and state_sha256, equal for equal states."""
        return self._held.summary()

    def render(self, width: int = 480, height: int = 360, **settings: Any) -> np.ndarray:
        """A picture, uint8 (height, width, 3). camera="policy": from where the policy looks; else from around the
        scene, azimuth_rad and elevation_rad."""
        return self._held.render({"width": width, "height": height, **settings})

    def arrays(self, names: Sequence[str]) -> dict[str, np.ndarray]:
        """The observation's arrays: "cloud" float32 (points, 3) [m, world], "cloud_label" uint8 (points,),
        "proprioception" float32 (32,), and "door_state" float64 (23,), which a robot would not know."""
        return self._held.arrays(list(names))

    @property
    def observation(self) -> Any:
        return self._held.observation

    @property
    def scene(self) -> Any:
        return self._held.scene

    @property
    def door(self) -> Any:
        return self._held.door

    @property
    def stage(self) -> str:
        """Of the next action: "grasp", "handle" or "open"."""
        return self._held.stage

    @property
    def reward(self) -> float:
        """What the last action was worth: the angle that it gained [rad]."""
        return self._held.reward

    @property
    def terminated(self) -> bool:
        return self._held.terminated

    @property
    def truncated(self) -> bool:
        return self._held.truncated

    @property
    def over(self) -> bool:
        return self._held.over

    @property
    def cause(self) -> Optional[str]:
        """How the episode ended, such as "opened" or "grip_lost"; None while it goes on."""
        return self._held.cause


def simulate(doors: Union[Path, Iterable[Path]], *, opener: str = "expert", handler: str = "expert",
             grasper: str = "expert", seed: int = 1, seeds: int = 1, episodes: int = 1, threads: int = 0,
             config: Optional[dict[str, Any]] = None) -> dict[str, Any]:
    """What `doorforge simulate --json` prints: "success" by category and "episodes" with their outcomes.

    Policies are names ("expert", "random") or folders of trained ones. Ctrl-C stops it.
    """
    if isinstance(doors, (str, os.PathLike)):
        doors = [doors]
    words = {"opener": opener, "handler": handler, "grasper": grasper}
    return _core.simulate([os.fspath(door) for door in doors], words,
                          {"seed": seed, "seeds": seeds, "episodes": episodes, "threads": threads, "config": config})


__all__ = ["Stepper", "simulate"]
