# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Data sets for PyTorch: map-style, for workers and DDP, resumable in the middle of an epoch.

    from torch.utils.data import DataLoader
    from doorforge.torch_data import Decisions, ResumableSampler

    data = Decisions("data", stage="open", split="train")
    sampler = ResumableSampler(data, batch_size=64, seed=7)          # rank and ranks are DDP's if it is on
    loader = DataLoader(data, batch_sampler=sampler, num_workers=4)
    for epoch in range(sampler.epoch, 20):
        for batch in loader:
            ...                                                      # dict of tensors, (64, ...)
            sampler.advance()                                        # after the step; state_dict() then knows it
        sampler.next_epoch()

`sampler.state_dict()` goes into the checkpoint; `load_state_dict()` goes on with the next batch, whatever the workers had
read ahead. The order is a pure function of seed and epoch, on every machine.
"""
from __future__ import annotations

import os
from typing import Any, Iterator, Optional, Sequence, Union

import numpy as np

try:
    import torch
    from torch.utils.data import Dataset, Sampler
except ImportError as error:
    raise ImportError("doorforge.torch_data needs PyTorch: pip install \"doorforge[torch]\", or Debian's python3-torch with "
                      "/usr/bin/python3") from error

from . import datasets


class Decisions(Dataset):  # type: ignore[type-arg]
    """The decisions of a stage's split. data[i] is a dict of tensors: "cloud" float32 (points, 3) [m, world],
    "proprio" float32 (32,), "action" float32 (9,), and whatever else `names` picks of the data set's features.

    May be forked and pickled: workers map the shards themselves.
    """

    def __init__(self, folder: Union[str, "os.PathLike[str]"], stage: str = "open", split: str = "train",
                 names: Optional[Sequence[str]] = ("cloud", "proprio", "action"), check: bool = True) -> None:
        self.data = datasets.Dataset(os.fspath(folder), check=check)
        self.samples = self.data.samples(stage, split, names)

    def __len__(self) -> int:
        return len(self.samples)

    def __getitem__(self, index: int) -> dict[str, torch.Tensor]:
        # copies: the arrays are read-only views of the file, tensors are not
        return {name: torch.from_numpy(np.array(row)) for name, row in self.samples[index].items()}

    def statistics(self, name: str) -> tuple[torch.Tensor, torch.Tensor]:
        """Mean and standard deviation of a feature's components over the train split, float32."""
        found = self.data.statistics[name]
        return (torch.tensor(found.mean, dtype=torch.float32),
                torch.tensor(found.standard_deviation, dtype=torch.float32))


class ResumableSampler(Sampler):  # type: ignore[type-arg]
    """Batches of a data set, every sample once an epoch. Of several processes each takes its own batches, as many as the
    others; samples that do not fill a batch of every process wait for another epoch (`drop_last`), or are taken by the
    first processes."""

    def __init__(self, data: Any, batch_size: int, seed: int = 0, rank: Optional[int] = None, ranks: Optional[int] = None,
                 drop_last: bool = True) -> None:
        distributed = torch.distributed.is_available() and torch.distributed.is_initialized()
        self.rank = rank if rank is not None else (torch.distributed.get_rank() if distributed else 0)
        self.ranks = ranks if ranks is not None else (torch.distributed.get_world_size() if distributed else 1)
        if batch_size < 1 or not 0 <= self.rank < self.ranks:
            raise ValueError(f"batch_size {batch_size}, rank {self.rank} of {self.ranks}: expected a batch of 1 or more, and "
                             "a rank below the number of ranks")
        self.count, self.batch_size, self.seed, self.drop_last = len(data), batch_size, seed, drop_last
        self.epoch, self.step = 0, 0

    def _batches(self) -> list[np.ndarray]:
        order = datasets.order(self.count, self.seed, self.epoch)
        whole = self.batch_size * self.ranks
        if self.drop_last:
            order = order[:len(order) - len(order) % whole]
        return [order[i:i + self.batch_size] for i in range(0, len(order), self.batch_size)][self.rank::self.ranks]

    def __iter__(self) -> Iterator[list[int]]:
        for batch in self._batches()[self.step:]:
            yield batch.tolist()

    def __len__(self) -> int:
        return len(self._batches()) - self.step

    def advance(self) -> None:
        """A batch has been learned from."""
        self.step += 1

    def next_epoch(self) -> None:
        self.epoch, self.step = self.epoch + 1, 0

    def state_dict(self) -> dict[str, int]:
        return {"epoch": self.epoch, "step": self.step, "seed": self.seed, "batch_size": self.batch_size,
                "ranks": self.ranks, "count": self.count}

    def load_state_dict(self, state: dict[str, int]) -> None:
        """ValueError if it is of other data, another batch size or another number of processes."""
        mine = self.state_dict()
        other = [f"{name} {state.get(name)}, here {mine[name]}" for name in ("seed", "batch_size", "ranks", "count")
                 if state.get(name) != mine[name]]
        if other:
            raise ValueError(f"the state is of another sampler: {'; '.join(other)}")
        self.epoch, self.step = state["epoch"], state["step"]


__all__ = ["Decisions", "ResumableSampler"]
