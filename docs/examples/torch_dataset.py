# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""A PyTorch data set over doorforge shards, and a small network trained from it.

    PYTHONPATH=python python3 docs/examples/torch_dataset.py DIR --epochs 2 --workers 2 --checkpoint run.pt

Run it again with more epochs and it goes on where it stopped, in the middle of an epoch if need be:
the order of samples is a pure function of seed and epoch, so the step is all there is to remember.
"""
import argparse
import hashlib
import os
from typing import Iterator

import torch
from torch.utils.data import DataLoader, Dataset, Sampler

import doorforge_reader


class DoorDecisions(Dataset):
    """Map-style: one item a decision. Workers map the shards themselves, so it may be forked or pickled."""

    def __init__(self, folder: str, split: str = "train", stage: str = "open",
                 names: tuple[str, ...] = ("cloud", "proprio", "action")) -> None:
        self.data = doorforge_reader.Dataset(folder)
        self.samples = self.data.samples(stage, split, names)

    def __len__(self) -> int:
        return len(self.samples)

    def __getitem__(self, index: int) -> dict[str, torch.Tensor]:
        # a copy: the arrays are read-only views of the file, tensors are not
        return {name: torch.from_numpy(row.copy()) for name, row in self.samples[index].items()}


class ResumableSampler(Sampler):
    """Every sample once an epoch, in an order drawn from (seed, epoch), from sample `start` on.

    With several processes (`rank` of `ranks`) each takes every ranks-th sample, none twice.
    """

    def __init__(self, count: int, seed: int, rank: int = 0, ranks: int = 1) -> None:
        self.count, self.seed, self.rank, self.ranks = count, seed, rank, ranks
        self.set(epoch=0, start=0)

    def set(self, epoch: int, start: int) -> None:
        """`start` counts the samples that this process has taken of the epoch."""
        self.epoch, self.start = epoch, start

    def _mine(self) -> Iterator[int]:
        return doorforge_reader.order(self.count, self.seed, self.epoch)[self.rank::self.ranks][self.start:]

    def __iter__(self) -> Iterator[int]:
        return (int(i) for i in self._mine())

    def __len__(self) -> int:
        return len(self._mine())


class Normalize(torch.nn.Module):
    """Scales a feature by the statistics of the train split in dataset.json."""

    def __init__(self, statistics: doorforge_reader.Statistics) -> None:
        super().__init__()
        deviation = torch.tensor(statistics.standard_deviation, dtype=torch.float32)
        self.register_buffer("mean", torch.tensor(statistics.mean, dtype=torch.float32))
        self.register_buffer("scale", torch.where(deviation > 1e-6, 1 / deviation, torch.zeros_like(deviation)))

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return (x - self.mean) * self.scale


class Policy(torch.nn.Module):
    """A PointNet's maximum over the cloud, beside what the robot feels of itself."""

    def __init__(self, data: doorforge_reader.Dataset) -> None:
        super().__init__()
        self.cloud, self.proprio = Normalize(data.statistics["cloud"]), Normalize(data.statistics["proprio"])
        self.points = torch.nn.Sequential(torch.nn.Linear(3, 32), torch.nn.ReLU(), torch.nn.Linear(32, 64))
        self.head = torch.nn.Sequential(torch.nn.Linear(64 + 32, 64), torch.nn.ReLU(), torch.nn.Linear(64, 9))

    def forward(self, batch: dict[str, torch.Tensor]) -> torch.Tensor:
        seen = self.points(self.cloud(batch["cloud"])).amax(dim=1)
        return self.head(torch.cat([seen, self.proprio(batch["proprio"])], dim=1))


def digest(policy: torch.nn.Module) -> str:
    state = hashlib.sha256()
    for name, value in policy.state_dict().items():
        state.update(name.encode() + value.numpy().tobytes())
    return state.hexdigest()


def train(options: argparse.Namespace) -> None:
    torch.manual_seed(options.seed)
    dataset = DoorDecisions(options.folder)
    sampler = ResumableSampler(len(dataset), options.seed)
    policy = Policy(dataset.data)
    optimizer = torch.optim.Adam(policy.parameters(), lr=1e-3)
    target = Normalize(dataset.data.statistics["action"])
    epoch, taken, steps, loss_sum, loss_count = 0, 0, 0, 0.0, 0
    if options.checkpoint and os.path.exists(options.checkpoint):
        saved = torch.load(options.checkpoint)
        policy.load_state_dict(saved["policy"])
        optimizer.load_state_dict(saved["optimizer"])
        epoch, taken, loss_sum, loss_count = (saved[key] for key in ("epoch", "taken", "loss_sum", "loss_count"))
        print(f"going on at epoch {epoch}, sample {taken}")
    while epoch < options.epochs and (options.steps is None or steps < options.steps):
        sampler.set(epoch, taken)
        loader = DataLoader(dataset, options.batch, sampler=sampler, num_workers=options.workers)
        for batch in loader:
            loss = (policy(batch) - target(batch["action"])).square().mean()
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
            taken, steps = taken + len(batch["action"]), steps + 1
            loss_sum, loss_count = loss_sum + loss.item(), loss_count + 1
            if steps == options.steps:
                break
        if taken == len(dataset):
            print(f"epoch {epoch}: loss {loss_sum / loss_count:.4f}")
            epoch, taken, loss_sum, loss_count = epoch + 1, 0, 0.0, 0
    if options.checkpoint:
        torch.save({"policy": policy.state_dict(), "optimizer": optimizer.state_dict(),
                    "epoch": epoch, "taken": taken, "loss_sum": loss_sum, "loss_count": loss_count},
                   options.checkpoint)
    print(f"policy sha256 {digest(policy)}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--epochs", type=int, default=2)
    parser.add_argument("--steps", type=int, help="stop after so many steps, wherever the epoch is")
    parser.add_argument("--batch", type=int, default=16)
    parser.add_argument("--workers", type=int, default=0)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--checkpoint", help="file to go on from and to write")
    train(parser.parse_args())


if __name__ == "__main__":
    main()
