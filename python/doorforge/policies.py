# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Policies of doorforge: the rule-based expert, and networks that `doorforge train` wrote."""
from __future__ import annotations

import os
from typing import Any, Optional

from . import _engine
from .doors import Path

_core = _engine.require()

Policy = _core.Policy


def load_policy(word: Path = "expert", stage: str = "open", config: Optional[dict[str, Any]] = None) -> Any:
    """A policy that opens ("open") or turns the handle ("handle"): "expert", or the folder of a trained one.

    `policy.act(observation)` gives an Action; `policy.reset()` begins an episode. The observation is a Stepper's, or a
    dict with "cloud" float32 (4096, 3) [m, world; point 0 nearest to the hand] and "proprioception" float32 (32,), which
    is enough for trained policies; the expert reads what only the simulator knows. MissingError with the nearest name.

    A handler may remember what the camera saw before the robot came, since the hand hides the handle: `policy.remembered`
    then has a "finer" above 0, as that of the policies in `data/policies`. With a Stepper: Stepper(door,
    remembered=policy.remembered, ...). With arrays of your own: policy.reset(before=points), float32 (points, 3) [m, world],
    of a camera with "finer" times as many pixels along each side, and as "cloud" every point that is visible, not 4096 of
    them; or a cloud that holds both, with "remembered": True in the dict. InvalidArgumentError where it is given neither.
    """
    return _core.Policy(os.fspath(word), stage, config)


def policy_names(stage: str = "open") -> list[str]:
    """The names at a stage: "grasp", "handle" or "open"."""
    return _core.policy_names(stage)


__all__ = ["Policy", "load_policy", "policy_names"]
