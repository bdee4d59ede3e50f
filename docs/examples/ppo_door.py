# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""PPO of Stable-Baselines3 on the state of a door (pip install stable-baselines3 "doorforge[gymnasium]").

    python3 docs/examples/ppo_door.py --steps 6144

An easy setting: one door, the handle turned and in the hand, states instead of clouds, small moves, and in training one scene, whose
beginning is kept, so that the rules take hold once and not in each episode. What is left to learn is to pull the leaf along
its arc without losing the grip. A few hundred decisions a second, so that this is a matter of a minute or two.
"""
import argparse

import gymnasium
import numpy as np
from stable_baselines3 import PPO
from stable_baselines3.common.monitor import Monitor

import doorforge
from doorforge.gym import OpenDoorEnv


class FromOneInstant(gymnasium.Wrapper):
    """Every episode begins where the first did: with the state that the rules had come to."""

    def __init__(self, env: OpenDoorEnv, seed: int) -> None:
        super().__init__(env)
        env.reset(seed=seed)
        self.begin = env.stepper.save()

    def reset(self, *, seed=None, options=None):
        self.env.stepper.restore(self.begin)
        return self.env.stepper.arrays(["door_state"])["door_state"], {}


class Scaled(gymnasium.ObservationWrapper):
    """The state less the one in which training begins, in decimetres and tenths of a radian."""

    def __init__(self, env: gymnasium.Env, centre: np.ndarray) -> None:
        super().__init__(env)
        self.centre = centre
        self.observation_space = gymnasium.spaces.Box(-10, 10, centre.shape, np.float32)

    def observation(self, observation: np.ndarray) -> np.ndarray:
        return np.clip((observation - self.centre) / 0.1, -10, 10).astype(np.float32)


def play(model: PPO, env: gymnasium.Env, seeds: range) -> tuple[float, int]:
    """Mean reward of an episode [rad] and how many opened, without noise."""
    rewards, opened = 0.0, 0
    for seed in seeds:
        observation, info = env.reset(seed=seed)
        over = False
        while not over:
            observation, reward, terminated, truncated, info = env.step(model.predict(observation, deterministic=True)[0])
            rewards += float(reward)
            over = terminated or truncated
        opened += info["is_success"]
    return rewards / len(seeds), opened


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=6144)
    parser.add_argument("--rounds", type=int, default=6, help="how often it is tried on the way")
    parser.add_argument("--unseen", type=int, default=5, help="scenes that training has not, tried before and after")
    parser.add_argument("--least-gain", type=float, default=-1.0, help="fail if the reward grew by less in training [rad]")
    options = parser.parse_args()
    door = doorforge.compose("interior_flush_01", "interior_lever_tube_01")
    settings = {"observation": "door_state", "control": "delta"}
    begin = FromOneInstant(OpenDoorEnv([door], **settings), seed=1)
    env = Scaled(begin, begin.reset()[0])
    tried = Scaled(FromOneInstant(OpenDoorEnv([door], **settings), seed=1), env.centre)  # training is amid an episode of its own
    unseen, seeds = Scaled(OpenDoorEnv([door], **settings), env.centre), range(1000, 1000 + options.unseen)
    each = max(options.steps // options.rounds, 1)
    monitor = Monitor(env)
    model = PPO("MlpPolicy", monitor, n_steps=min(256, each), batch_size=64, learning_rate=1e-3, gamma=0.97,
                policy_kwargs={"log_std_init": -1.0}, seed=7, device="cpu")
    for done in range(options.rounds + 1):
        print(f"{model.num_timesteps:6d} steps: reward {play(model, tried, range(1))[0]:.3f} rad", flush=True)
        if done in (0, options.rounds):
            print("        in {} other scenes: reward {:.3f} rad, opened {}".format(len(seeds), *play(model, unseen, seeds)), flush=True)
        if done < options.rounds:
            model.learn(each, reset_num_timesteps=False)
    fifths = np.array_split(monitor.get_episode_rewards(), 5)  # one episode without noise says less
    begin, end = fifths[0].mean(), fifths[-1].mean()
    print(f"in training: reward {begin:.3f} rad in the first fifth of the episodes, {end:.3f} in the last")
    if end - begin < options.least_gain:
        raise SystemExit(f"the reward grew by {end - begin:.3f} rad, expected {options.least_gain}")


if __name__ == "__main__":
    main()
