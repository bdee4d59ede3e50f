# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes: everything that decides an episode but the policies. Robots, observations, actions."""
from __future__ import annotations

from typing import Any, Optional

from . import _engine

_core = _engine.require()

Action = _core.Action
Observation = _core.Observation
Robot = _core.Robot
Scene = _core.Scene


def sample_scene(door: Any, seed: int = 1, episode: int = 0, config: Optional[dict[str, Any]] = None,
                 robot: Optional[Any] = None) -> Any:
    """Draws episode number `episode` of a door: the scene that `doorforge simulate --seed` runs.

    `config` holds settings that differ from the defaults, as those of `--set scene.*`:
    {"randomisation": "strong", "physics": {"max_opening_actions": 40}}.
    """
    return _core.sample_scene(door, seed, episode, config, robot if robot is not None else robot_of(config))


def environments() -> list[str]:
    """Names of the environments of others, such as "doorgym"; docs/environment.md has the table."""
    return list(_core.environments())


def environment(name: str) -> dict[str, Any]:
    """The settings of such an environment, {"scene": {...}, "cloud": {...}}; a path of a .yaml file will do as well."""
    return dict(_core.environment(name))


def robot_of(config: Optional[dict[str, Any]]) -> Any:
    """The robot that a scene's settings mean: the built-in one unless they name a URDF."""
    settings = config or {}
    return Robot(settings.get("robot", ""), settings.get("physics", {}).get("base", "sliders"))


__all__ = ["Action", "Observation", "Robot", "Scene", "environment", "environments", "robot_of", "sample_scene"]
