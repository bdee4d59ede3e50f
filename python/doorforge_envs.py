# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Names of doorforge's environments for Gymnasium, which asks for them when it is imported: so nothing of doorforge is
loaded here. The environments themselves are in doorforge.gym."""
from __future__ import annotations

from typing import Any

#: Name -> what differs from OpenDoorEnv's defaults.
ENVIRONMENTS: dict[str, dict[str, Any]] = {
    "doorforge/OpenDoor-v0": {},
    "doorforge/OpenDoorState-v0": {"observation": ("proprioception", "door_state"), "control": "delta"},
    "doorforge/OpenDoorStrong-v0": {"config": {"randomisation": "strong"}},
    "doorforge/OpenDoorTest-v0": {"doors": "full:test"},
    "doorforge/OpenDoorUnseen-v0": {"doors": "full:unseen_categories"},
    "doorforge/OpenDoorFixedBase-v0": {"config": {"physics": {"base": "fixed"}}},
    "doorforge/TurnHandle-v0": {"stage": "handle"},
    "doorforge/GraspDoor-v0": {"stage": "grasp"},
    "doorforge/UniDoorManip-v0": {"preset": "unidoormanip"},
    "doorforge/GAPartNet-v0": {"preset": "gapartnet"},
    "doorforge/Where2Act-v0": {"preset": "where2act"},
    "doorforge/RLAfford-v0": {"preset": "rlafford"},
    "doorforge/PartManip-v0": {"preset": "partmanip"},
    "doorforge/DoorGym-v0": {"preset": "doorgym"},
    "doorforge/EnvAfford-v0": {"preset": "envafford"},
}


def register_envs() -> None:
    """Makes the names known to gymnasium.make(); calling it again changes nothing."""
    import gymnasium
    for name, settings in ENVIRONMENTS.items():
        if name not in gymnasium.registry:
            gymnasium.register(id=name, entry_point="doorforge.gym:OpenDoorEnv", kwargs=settings)
