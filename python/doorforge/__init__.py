# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Doors for robot learning: composed, simulated, opened, recorded and judged.

    import doorforge

    door = doorforge.compose("interior_flush_01", "interior_lever_tube_01", latch="bolt")
    door.save("doors/mine")
    doorforge.validate("doors/mine").errors
    doorforge.simulate("doors/mine", episodes=5)["success"]["overall"]

Metres, radians, kilograms and seconds everywhere. World: z up, x out of the door towards the robot, floor at z = 0.
Transforms `a_from_b` are float64 (4, 4) and map coordinates in frame b to frame a. docs/python.md tells the rest.
"""
from __future__ import annotations

import importlib
import warnings
from typing import TYPE_CHECKING, Any

from . import _engine, errors
from .errors import (Error, FileAccessError, FormatError, IncompleteError, InvalidArgumentError, InvalidConfigError,
                     MissingError)

if TYPE_CHECKING:
    from . import datasets, doors, evaluation, gym, latch, lerobot, policies, scenes, simulation, torch_data, vector
    from .doors import Door, catalogue, compose, find_doors, preview, read_door, validate
    from .evaluation import evaluate
    from .policies import load_policy
    from .scenes import Robot, Scene, environment, environments, sample_scene
    from .simulation import Stepper, simulate
    from .vector import VectorEnv

if _engine.problem is not None:
    warnings.warn(_engine.problem, stacklevel=2)
elif _engine.core is not None:
    __version__ = _engine.core.code_version()

# Where each name of the package is; what is not asked for is not loaded.
_NAMES = {
    "Door": "doors", "catalogue": "doors", "compose": "doors", "find_doors": "doors", "preview": "doors",
    "read_door": "doors", "validate": "doors",
    "evaluate": "evaluation", "load_policy": "policies",
    "Robot": "scenes", "Scene": "scenes", "sample_scene": "scenes", "environment": "scenes",
    "environments": "scenes", "Action": "scenes", "Observation": "scenes",
    "Stepper": "simulation", "simulate": "simulation", "VectorEnv": "vector",
}
_MODULES = ("datasets", "doors", "evaluation", "gym", "latch", "lerobot", "policies", "scenes", "simulation", "torch_data",
            "vector")

__all__ = [*_NAMES, *_MODULES, "Error", "FileAccessError", "FormatError", "IncompleteError", "InvalidArgumentError",
           "InvalidConfigError", "MissingError", "errors"]


def __getattr__(name: str) -> Any:
    if name in _NAMES:
        return getattr(importlib.import_module(f"doorforge.{_NAMES[name]}"), name)
    if name in _MODULES:
        return importlib.import_module(f"doorforge.{name}")
    raise AttributeError(f"module 'doorforge' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
