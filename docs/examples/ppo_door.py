# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""PPO of Stable-Baselines3 on the state of a door (pip install stable-baselines3 "doorforge[gymnasium]").

    python3 docs/examples/ppo_door.py

An easy setting: one door, the handle turned and in the hand, states instead of clouds, small moves. Eight scenes are learned from, each in
an environment of its own, whose beginning is kept, so that the rules take hold once and not in each episode. What is left to learn
is to pull the leaf along its arc without losing the grip; it is tried in ten other scenes. Two hundred decisions a second and core, so that this is a
matter of two minutes.
"""
import argparse

import gymnasium
import numpy as np
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import DummyVecEnv, VecMonitor

import doorforge
from doorforge.gym import OpenDoorEnv

TRAINED, UNSEEN = range(1, 9), range(1000, 1010)  # seeds of scenes


class FromOneInstant(gymnasium.Wrapper):
    """Every episode begins where that of one seed did: with the state that the rules had come to."""

    def __init__(self, door: doorforge.Door, seed: int) -> None:
        super().__init__(OpenDoorEnv([door], observation="door_state", control="delta"))
        self.env.reset(seed=seed)
        self.begin = self.env.stepper.save()

    def reset(self, *, seed=None, options=None):
        self.env.stepper.restore(self.begin)
        return self.env.stepper.arrays(["door_state"])["door_state"], {}


class Scaled(gymnasium.ObservationWrapper):
    """The state less the mean of those in which training begins, in decimetres and tenths of a radian."""

    def __init__(self, env: gymnasium.Env, centre: np.ndarray) -> None:
        super().__init__(env)
        self.centre = centre
        self.observation_space = gymnasium.spaces.Box(-10, 10, centre.shape, np.float32)

    def observation(self, observation: np.ndarray) -> np.ndarray:
        return np.clip((observation - self.centre) / 0.1, -10, 10).astype(np.float32)


def play(model: PPO, environments: list[gymnasium.Env]) -> tuple[float, int]:
    """Mean reward of an episode [rad] and how many opened, without noise."""
    rewards, opened = 0.0, 0
    for env in environments:
        observation, info = env.reset()
        over = False
        while not over:
            observation, reward, terminated, truncated, info = env.step(model.predict(observation, deterministic=True)[0])
            rewards += float(reward)
            over = terminated or truncated
        opened += info["is_success"]
    return rewards / len(environments), opened


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=20480)
    parser.add_argument("--rounds", type=int, default=8, help="how often it is tried on the way")
    parser.add_argument("--seed", type=int, default=7, help="of the learning")
    parser.add_argument("--least-opened", type=int, default=0, help=f"fail if fewer of the {len(UNSEEN)} other scenes open in the end")
    options = parser.parse_args()
    door = doorforge.compose("interior_flush_01", "interior_lever_tube_01")
    begun = [FromOneInstant(door, seed) for seed in TRAINED]
    centre = np.mean([env.reset()[0] for env in begun], axis=0)
    training = VecMonitor(DummyVecEnv([lambda env=env: Scaled(env, centre) for env in begun]))
    unseen = [Scaled(FromOneInstant(door, seed), centre) for seed in UNSEEN]
    model = PPO("MlpPolicy", training, n_steps=64, batch_size=64, learning_rate=1e-3, gamma=0.97,
                policy_kwargs={"log_std_init": -1.0}, seed=options.seed, device="cpu")
    for done in range(options.rounds + 1):
        reward, opened = play(model, unseen)
        print(f"{model.num_timesteps:6d} steps: {opened} of {len(unseen)} other scenes opened, reward {reward:.3f} rad", flush=True)
        if done < options.rounds:
            model.learn(max(options.steps // options.rounds, 1), reset_num_timesteps=False)
    if opened < options.least_opened:
        raise SystemExit(f"{opened} of {len(unseen)} scenes opened, expected {options.least_opened}")


if __name__ == "__main__":
    main()
