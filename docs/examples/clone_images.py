# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Behaviour cloning from RGB-D pictures in PyTorch, evaluated in closed loop under appearances that were never seen.

    doorforge datagen open --doors full:train doors --out data --episodes 2000 --set scene.appearance=full \\
        --set pictures.cameras='[{name: own, at: scene}]' --set pictures.streams='[rgb, depth32]' --set pictures.samples=1
    python3 docs/examples/clone_images.py data full:test doors --epochs 8

DATA holds pictures of the policies' own camera, which `evaluate` shows as "image" and "depth".
"""
import argparse
import os
from typing import Any, Optional

import numpy as np
import torch
from torch.utils.data import DataLoader

import doorforge
from doorforge.torch_data import Decisions, ResumableSampler

SIDE = 128  # of the pictures that the network reads
FAR_M = 4.0


def pictures(rgb: torch.Tensor, depth_m: torch.Tensor) -> torch.Tensor:
    """Four channels, -0.5 to 0.5, of pictures (batch, height, width, 3) and depths (batch, height, width)."""
    color = rgb.permute(0, 3, 1, 2).float() / 255
    seen = torch.where(torch.isfinite(depth_m) & (depth_m > 0), depth_m, torch.tensor(FAR_M)).clamp(max=FAR_M) / FAR_M
    return torch.nn.functional.adaptive_avg_pool2d(torch.cat([color, seen[:, None]], dim=1), SIDE) - 0.5


def convolution(inputs: int, outputs: int, stride: int) -> list[torch.nn.Module]:
    return [torch.nn.Conv2d(inputs, outputs, 3, stride, 1), torch.nn.GroupNorm(8, outputs), torch.nn.ReLU()]


class ImageClone(torch.nn.Module):
    """Where things are in the picture (a spatial softmax, Levine et al. 2016), beside what the robot feels of itself."""

    def __init__(self, data: Optional[Decisions] = None) -> None:
        super().__init__()
        for name, size in (("proprio", 32), ("action", 9)):
            mean, deviation = data.statistics(name) if data else (torch.zeros(size), torch.ones(size))
            self.register_buffer(name + "_mean", mean)
            self.register_buffer(name + "_scale", deviation.clamp(min=1e-3))
        self.eyes = torch.nn.Sequential(*convolution(4, 24, 2), *convolution(24, 48, 2), *convolution(48, 64, 1),
                                        *convolution(64, 64, 1), torch.nn.Conv2d(64, 48, 1))
        self.head = torch.nn.Sequential(torch.nn.Linear(3 * 48 + 32, 256), torch.nn.ReLU(),
                                        torch.nn.Linear(256, 256), torch.nn.ReLU(), torch.nn.Linear(256, 9))
        steps = torch.linspace(-1, 1, SIDE // 4)
        self.register_buffer("across", steps.repeat(SIDE // 4))
        self.register_buffer("down", steps.repeat_interleave(SIDE // 4))

    def forward(self, seen: torch.Tensor, proprio: torch.Tensor) -> torch.Tensor:
        maps = self.eyes(seen).flatten(2)
        where = maps.softmax(dim=2)
        places = torch.cat([(where * self.across).sum(2), (where * self.down).sum(2), maps.amax(2) / 10], dim=1)
        felt = (proprio - self.proprio_mean) / self.proprio_scale
        return self.action_mean + self.action_scale * self.head(torch.cat([places, felt], dim=1))

    def act(self, observation: dict[str, np.ndarray]) -> np.ndarray:
        with torch.no_grad():
            seen = pictures(torch.from_numpy(observation["image"])[None], torch.from_numpy(observation["depth"])[None])
            return self.forward(seen, torch.from_numpy(observation["proprioception"])[None])[0].numpy()


def keep(path: str, value: Any) -> None:
    """Whole or not at all: an end in the middle of writing leaves the file of before."""
    torch.save(value, path + ".new")
    os.replace(path + ".new", path)


def train(data: Decisions, epochs: int, batch: int, seed: int, checkpoint: str) -> ImageClone:
    """Goes on after the last whole epoch that CHECKPOINT, a file or "", holds."""
    torch.manual_seed(seed)
    policy = ImageClone(data)
    sampler = ResumableSampler(data, min(batch, len(data)), seed=seed)
    steps = epochs * len(sampler)
    optimizer = torch.optim.Adam(policy.parameters(), lr=1e-3)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimizer, 1e-3, max(steps, 4))
    parts = {"policy": policy, "optimizer": optimizer, "schedule": schedule, "sampler": sampler}
    if os.path.exists(checkpoint):
        for name, state in torch.load(checkpoint).items():
            parts[name].load_state_dict(state)
    while sampler.epoch < epochs:
        losses = []
        for sample in DataLoader(data, batch_sampler=sampler):
            seen = pictures(sample["rgb_own"], sample["depth32_own"])
            error = (policy(seen, sample["proprio"]) - sample["action"]) / policy.action_scale
            loss = error.abs().mean()
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
            schedule.step()
            sampler.advance()
            losses.append(loss.item())
        print(f"epoch {sampler.epoch}: loss {np.mean(losses):.4f}", flush=True)
        sampler.next_epoch()
        if checkpoint:
            keep(checkpoint, {name: part.state_dict() for name, part in parts.items()})
    return policy


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data")
    parser.add_argument("doors", nargs="+", help="folders, with a split such as full:test before them")
    parser.add_argument("--epochs", type=int, default=8)
    parser.add_argument("--batch", type=int, default=32)
    parser.add_argument("--seed", type=int, default=7, help="of the training")
    parser.add_argument("--seeds", type=int, default=1, help="scenes a door that it is judged in")
    parser.add_argument("--per-category", type=int, default=0, help="doors; 0: all")
    parser.add_argument("--weights", default="", help="file to keep them in, and to take them from if it is there; "
                        "a training that was stopped goes on from the one beside it")
    options = parser.parse_args()
    data = Decisions(options.data, names=("rgb_own", "depth32_own", "proprio", "action"))
    try:
        policy = ImageClone(data)
        policy.load_state_dict(torch.load(options.weights))
    except FileNotFoundError:
        checkpoint = options.weights and options.weights + ".checkpoint"
        policy = train(data, options.epochs, options.batch, options.seed, checkpoint)
        if options.weights:
            keep(options.weights, policy.state_dict())
            os.remove(checkpoint)
    policy.eval()
    print(doorforge.evaluate(policy.act, options.doors, observation=["image", "depth", "proprioception"],
                             seeds=options.seeds, per_category=options.per_category, threads=1,
                             config={"scene": {"appearance": "full"}}))


if __name__ == "__main__":
    main()
