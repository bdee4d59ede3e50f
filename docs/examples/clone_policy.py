# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Behaviour cloning in PyTorch from shards, evaluated in closed loop.

    python3 docs/examples/clone_policy.py DATA DOORS --epochs 20

DATA is what `doorforge datagen open` wrote, DOORS are others than those it was made from.
"""
import argparse

import numpy as np
import torch
from torch.utils.data import DataLoader

import doorforge
from doorforge.torch_data import Decisions, ResumableSampler


class Clone(torch.nn.Module):
    """A PointNet's maximum over the cloud about the hand, beside what the robot feels of itself."""

    def __init__(self, data: Decisions) -> None:
        super().__init__()
        for name in ("proprio", "action"):
            mean, deviation = data.statistics(name)
            self.register_buffer(name + "_mean", mean)
            self.register_buffer(name + "_scale", deviation.clamp(min=1e-3))
        self.points = torch.nn.Sequential(torch.nn.Linear(3, 64), torch.nn.ReLU(), torch.nn.Linear(64, 128))
        self.head = torch.nn.Sequential(torch.nn.Linear(160, 128), torch.nn.ReLU(), torch.nn.Linear(128, 9))

    def forward(self, cloud: torch.Tensor, proprio: torch.Tensor) -> torch.Tensor:
        around_hand = (cloud[:, ::4] - proprio[:, None, 25:28]) / 0.5
        felt = (proprio - self.proprio_mean) / self.proprio_scale
        seen = self.points(around_hand).amax(dim=1)
        return self.action_mean + self.action_scale * self.head(torch.cat([seen, felt], dim=1))

    def __call__(self, *arguments):
        if len(arguments) == 2:
            return super().__call__(*arguments)
        observation: dict[str, np.ndarray] = arguments[0]  # in the evaluation
        with torch.no_grad():
            return super().__call__(torch.from_numpy(observation["cloud"])[None],
                                    torch.from_numpy(observation["proprioception"])[None])[0].numpy()


def train(data: Decisions, epochs: int, batch: int) -> Clone:
    torch.manual_seed(7)
    policy = Clone(data)
    optimizer = torch.optim.Adam(policy.parameters(), lr=1e-3)
    sampler = ResumableSampler(data, min(batch, len(data)), seed=7)
    while sampler.epoch < epochs:
        losses = []
        for sample in DataLoader(data, batch_sampler=sampler):
            error = (policy(sample["cloud"], sample["proprio"]) - sample["action"]) / policy.action_scale
            loss = error.square().mean()
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
            sampler.advance()
            losses.append(loss.item())
        print(f"epoch {sampler.epoch}: loss {np.mean(losses):.4f}")
        sampler.next_epoch()
    return policy


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data")
    parser.add_argument("doors")
    parser.add_argument("--epochs", type=int, default=20)
    parser.add_argument("--batch", type=int, default=32)
    parser.add_argument("--seeds", type=int, default=1)
    options = parser.parse_args()
    policy = train(Decisions(options.data), options.epochs, options.batch)
    print(doorforge.evaluate(policy, options.doors, seeds=options.seeds, threads=1))


if __name__ == "__main__":
    main()
