# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""One of the processes of torch_test.py that share an epoch: ddp_rank.py DATA OUT STOP_AFTER, with RANK, WORLD_SIZE,
MASTER_ADDR and MASTER_PORT as torchrun sets them. Trains for two epochs, or stops after so many steps, and goes on from
OUT's checkpoint if there is one. OUT/RANK.json has the samples of each epoch, and a digest of the weights."""
import hashlib
import json
import pathlib
import sys

import torch
from torch.nn.parallel import DistributedDataParallel
from torch.utils.data import DataLoader

from doorforge.torch_data import Decisions, ResumableSampler


class Numbered(Decisions):
    """Every sample tells which one it is."""

    def __getitem__(self, index: int) -> dict:
        return {**super().__getitem__(index), "number": torch.tensor(index)}


def main() -> None:
    folder, out, stop_after = sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3])
    torch.manual_seed(3)
    torch.set_num_threads(1)
    torch.distributed.init_process_group("gloo")
    rank = torch.distributed.get_rank()
    model = DistributedDataParallel(torch.nn.Linear(32, 9))
    optimizer = torch.optim.SGD(model.parameters(), lr=0.05)
    data = Numbered(folder, names=("proprio", "action"))
    sampler = ResumableSampler(data, 5, seed=7)
    checkpoint, record = out / "checkpoint.pt", out / f"{rank}.json"
    taken = json.loads(record.read_text())["taken"] if record.exists() else [[], []]
    if checkpoint.exists():
        saved = torch.load(checkpoint)
        model.module.load_state_dict(saved["model"])
        sampler.load_state_dict(saved["sampler"])
    steps = 0
    while sampler.epoch < 2 and steps != stop_after:
        for batch in DataLoader(data, batch_sampler=sampler, num_workers=2):
            loss = (model(batch["proprio"]) - batch["action"]).square().mean()
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
            taken[sampler.epoch] += batch["number"].tolist()
            sampler.advance()
            steps += 1
            if steps == stop_after:
                break
        else:
            sampler.next_epoch()
    if rank == 0:
        torch.save({"model": model.module.state_dict(), "sampler": sampler.state_dict()}, checkpoint)
    weights = b"".join(value.numpy().tobytes() for value in model.module.state_dict().values())
    record.write_text(json.dumps({"taken": taken, "weights": hashlib.sha256(weights).hexdigest()}))
    torch.distributed.barrier()
    torch.distributed.destroy_process_group()


if __name__ == "__main__":
    main()
