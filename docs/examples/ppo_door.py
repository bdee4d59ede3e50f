# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""PPO of Stable-Baselines3 on the state of a door (pip install stable-baselines3 "doorforge[gymnasium]").

    python3 docs/examples/ppo_door.py --steps 12000

An easy setting: one door, the handle turned and in the hand, states instead of clouds, small moves. What is left to learn is
to pull the leaf along its arc without losing the grip. A few hundred decisions a second, so that this is a matter of minutes.
"""
import argparse

import gymnasium
import numpy as np
from stable_baselines3 import PPO
from stable_baselines3.common.monitor import Monitor

import doorforge
import doorforge.gym  # makes the names known where the package is not installed


class Scaled(gymnasium.ObservationWrapper):
    """The state less its mean over the first episodes' scenes, in units of centimetres and tenths of a radian."""

    def __init__(self, env: gymnasium.Env) -> None:
        super().__init__(env)
        self.mean = np.mean([env.reset(seed=seed)[0] for seed in range(5)], axis=0)
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, self.mean.shape, np.float32)

    def observation(self, observation: np.ndarray) -> np.ndarray:
        return np.clip((observation - self.mean) / 0.1, -10, 10).astype(np.float32)


def play(model: PPO, env: gymnasium.Env, episodes: int) -> tuple[float, int]:
    """Mean reward of an episode [rad] and how many opened, without noise, in scenes of seeds that training has not."""
    rewards, opened = 0.0, 0
    for episode in range(episodes):
        observation, info = env.reset(seed=1000 + episode)
        over = False
        while not over:
            observation, reward, terminated, truncated, info = env.step(model.predict(observation, deterministic=True)[0])
            rewards += float(reward)
            over = terminated or truncated
        opened += info["is_success"]
    return rewards / episodes, opened


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=12000)
    parser.add_argument("--rounds", type=int, default=6, help="how often it is tried on the way")
    parser.add_argument("--episodes", type=int, default=10, help="of each try")
    parser.add_argument("--least-gain", type=float, default=-1.0, help="fail if the reward grew by less [rad]")
    options = parser.parse_args()
    door = doorforge.compose("interior_flush_01", "interior_lever_tube_01")
    env = Scaled(gymnasium.make("doorforge/OpenDoorState-v0", doors=[door], observation="door_state"))
    each = max(options.steps // options.rounds, 1)
    model = PPO("MlpPolicy", Monitor(env), n_steps=min(512, each), batch_size=64, learning_rate=1e-3, gamma=0.97,
                policy_kwargs={"log_std_init": -1.0}, seed=7, device="cpu")
    curve = []
    for done in range(options.rounds + 1):
        reward, opened = play(model, env, options.episodes)
        curve.append(reward)
        print(f"{model.num_timesteps:6d} steps: reward {reward:.3f} rad, opened {opened} of {options.episodes}", flush=True)
        if done < options.rounds:
            model.learn(each, reset_num_timesteps=False)
    if curve[-1] - curve[0] < options.least_gain:
        raise SystemExit(f"the reward grew by {curve[-1] - curve[0]:.3f} rad, expected {options.least_gain}")


if __name__ == "__main__":
    main()
