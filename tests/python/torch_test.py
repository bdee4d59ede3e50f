# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""doorforge.torch_data over a data set that any build must read; PYTHONPATH holds the package."""
import json
import os
import pathlib
import pickle
import socket
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import torch
from torch.utils.data import DataLoader

from doorforge import datasets
from doorforge.torch_data import Decisions, ResumableSampler

DATA = pathlib.Path(__file__).parents[1] / "golden" / "dataset_v1"


def train_together(out: str, stop_after: int = -1) -> list:
    """What the records of two processes say that train together."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    program = pathlib.Path(__file__).with_name("ddp_rank.py")
    ranks = [subprocess.Popen([sys.executable, "-B", str(program), str(DATA), out, str(stop_after)],
                              env={**os.environ, "RANK": str(rank), "WORLD_SIZE": "2", "MASTER_ADDR": "127.0.0.1",
                                   "MASTER_PORT": str(port), "OMP_NUM_THREADS": "1"}) for rank in range(2)]
    try:
        assert [rank.wait(300) for rank in ranks] == [0, 0]
    finally:
        for rank in ranks:
            rank.kill()
            rank.wait()
    return [json.loads(pathlib.Path(out, f"{rank}.json").read_text()) for rank in range(2)]


class Torch(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.data = Decisions(DATA, names=("cloud", "proprio", "action", "score"))

    def test_tensors_are_the_readers_rows_and_may_be_written(self) -> None:
        samples = datasets.Dataset(DATA).samples("open", "train")
        self.assertEqual(len(self.data), len(samples))
        for index in (0, len(samples) - 1):
            for name, tensor in self.data[index].items():
                np.testing.assert_array_equal(tensor.numpy(), samples[index][name])
                tensor.zero_()
        mean, deviation = self.data.statistics("action")
        self.assertEqual((mean.shape, deviation.dtype), ((9,), torch.float32))

    def test_workers_give_the_same_batches(self) -> None:
        batches = []
        for workers in (0, 2):
            sampler = ResumableSampler(self.data, 2, seed=3, drop_last=False)
            batches.append([batch["proprio"] for batch in DataLoader(self.data, batch_sampler=sampler, num_workers=workers)])
        self.assertEqual(len(batches[0]), len(batches[1]))
        for one, other in zip(*batches):
            self.assertTrue(torch.equal(one, other))

    def test_a_run_goes_on_in_the_middle_of_an_epoch(self) -> None:
        count = 103
        whole = ResumableSampler(range(count), 4, seed=5)
        whole.next_epoch()
        wanted = list(whole)
        stopped = ResumableSampler(range(count), 4, seed=5)
        stopped.next_epoch()
        taken = []
        for batch in stopped:  # workers may be far ahead of what was learned from
            taken.append(batch)
            stopped.advance()
            if len(taken) == 11:
                break
        later = ResumableSampler(range(count), 4, seed=5)
        later.load_state_dict(pickle.loads(pickle.dumps(stopped.state_dict())))
        self.assertEqual(len(later), len(wanted) - 11)
        self.assertEqual(taken + list(later), wanted)
        with self.assertRaises(ValueError):
            ResumableSampler(range(count), 8, seed=5).load_state_dict(stopped.state_dict())

    def test_processes_share_an_epoch_without_overlap_and_take_equally_many(self) -> None:
        for drop_last in (True, False):
            shares = [list(ResumableSampler(range(103), 4, seed=5, rank=rank, ranks=3, drop_last=drop_last))
                      for rank in range(3)]
            flat = [index for share in shares for batch in share for index in batch]
            self.assertEqual(len(flat), len(set(flat)))
            self.assertEqual(len(flat), 96 if drop_last else 103)
            if drop_last:
                self.assertEqual({len(share) for share in shares}, {8})

    def test_two_processes_with_workers_take_every_sample_once_an_epoch_also_after_a_stop(self) -> None:
        with tempfile.TemporaryDirectory() as whole, tempfile.TemporaryDirectory() as stopped:
            wanted = train_together(whole)
            train_together(stopped, stop_after=11)  # in the second of two epochs of eight steps
            found = train_together(stopped)
        for records in (wanted, found):
            for epoch in range(2):
                self.assertEqual(sorted(records[0]["taken"][epoch] + records[1]["taken"][epoch]), list(range(len(self.data))))
        self.assertEqual(found, wanted)  # in the same order, and with the same bits of the weights

    def test_epochs_differ_and_are_the_same_everywhere(self) -> None:
        sampler = ResumableSampler(range(10), 10, seed=1)
        first = list(sampler)[0]
        self.assertEqual(first, datasets.order(10, 1, 0).tolist())
        sampler.next_epoch()
        self.assertNotEqual(list(sampler)[0], first)
        with self.assertRaises(ValueError):
            ResumableSampler(range(10), 2, rank=3, ranks=3)


if __name__ == "__main__":
    unittest.main()
