# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""PPO of Stable-Baselines3 on the state of a door (pip install stable-baselines3 "doorforge[gymnasium]").

    python3 docs/examples/ppo_door.py --steps 20000

States instead of clouds: a few hundred decisions a second, so that this is a matter of minutes and not of days.
"""
import argparse

import gymnasium
from stable_baselines3 import PPO

import doorforge
import doorforge.gym  # makes the names known where the package is not installed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=20000)
    options = parser.parse_args()
    door = doorforge.compose("interior_flush_01", "interior_lever_tube_01")
    env = gymnasium.make("doorforge/OpenDoorState-v0", doors=[door], observation="door_state")
    model = PPO("MlpPolicy", env, n_steps=min(256, options.steps), batch_size=64, seed=7, verbose=1, device="cpu")
    model.learn(options.steps)
    observation, info = env.reset(seed=1)
    over = False
    while not over:
        action, _ = model.predict(observation, deterministic=True)
        observation, reward, terminated, truncated, info = env.step(action)
        over = terminated or truncated
    print(f"{info['door']}: {info['cause']}, hinge {info['hinge_rad']:.2f} rad")


if __name__ == "__main__":
    main()
