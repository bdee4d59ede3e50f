# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""LeRobot and Hugging Face's datasets on exports of a dataset of doorforge:

    lerobot_judge.py values DATASET EXPORT [STAGE]     LeRobotDataset and load_dataset: every value is the shard's, statistics are exact
    lerobot_judge.py video DATASET EXPORT [STAGE]      the same with pictures as video, which may lose a little
    lerobot_judge.py killed DATASET FOLDER             killed at many moments, an export ends with the same files
    lerobot_judge.py converted DATASET EXPORT          an export in v2.1 that LeRobot's own script converts to v3.0

tests/python/lerobot_judge.sh installs what is needed and calls it."""
import hashlib
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "python"))

import doorforge_reader as reader  # noqa: E402

LEAST_PSNR_DB = 32.0


def opened(export):
    from lerobot.datasets.lerobot_dataset import LeRobotDataset
    return LeRobotDataset("local/doors", root=export)


def episodes_of(data, stage):
    splits = sorted({part.split for part in data.parts if part.stage == stage}, key=lambda split: split != "train")
    return [(split, episode) for split in splits for episode in data.episodes(stage, split)]


class Compared:
    """Counts the numbers that were compared, and the worst picture of a video."""

    def __init__(self, lossy):
        self.lossy, self.numbers, self.worst_db = lossy, 0, float("inf")

    def same(self, found, expected, what):
        found = np.asarray(found)
        if found.shape != expected.shape or not np.array_equal(found, expected):
            sys.exit(f"{what}: differs: {found.shape} {expected.shape}")
        self.numbers += expected.size

    def picture(self, found, expected, what):
        octets = np.rint(255 * found.numpy()).astype(np.uint8).transpose(1, 2, 0)
        if not self.lossy:
            return self.same(octets, expected, what)
        error = np.mean((octets.astype(float) - expected) ** 2)
        decibel = float(10 * np.log10(255 ** 2 / max(error, 1e-9)))
        self.worst_db = min(self.worst_db, decibel)
        if decibel < LEAST_PSNR_DB:
            sys.exit(f"{what}: {decibel:.1f} dB from the shard's picture")
        self.numbers += expected.size
        return None


def compare_frame(compared, row, episode, t, where):
    compared.same(row["observation.state"], episode["proprio"][t], where + " state")
    compared.same(row["action"], episode["action"][t], where + " action")
    compared.same(np.ravel(row["next.reward"]), episode["score"][t], where + " reward")
    last = t == episode.decisions - 1
    if bool(row["next.done"]) != last or bool(row["next.success"]) != (last and episode.meta["success"]):
        sys.exit(where + ": done or success")
    for name, value in row.items():
        camera = name.removeprefix("observation.images.")
        if name == "observation.pointcloud":
            compared.same(value, episode["cloud"][t][:len(value)], where + " cloud")
        elif name == "observation.pointcloud_rgb":
            compared.same(value, episode["cloud_rgb"][t][:len(value)], where + " colours")
        elif camera != name and camera.endswith("_depth"):
            compared.same(value[0].numpy(), episode["depth_" + camera.removesuffix("_depth")][t].astype(np.float32), where + name)
        elif camera != name:
            compared.picture(value, episode["rgb_" + camera][t], where + name)


def compare_with_shards(data, export, stage, lossy):
    compared, frame = Compared(lossy), 0
    taken = opened(export)
    ranges = {}
    for i, (split, episode) in enumerate(episodes_of(data, stage)):
        ranges.setdefault(split, [i, i])[1] = i + 1
        meta = taken.meta.episodes[i]
        if (meta["dataset_from_index"], meta["dataset_to_index"]) != (frame, frame + episode.decisions):
            sys.exit(f"episode {i}: frames {meta['dataset_from_index']}")
        for t in range(episode.decisions):
            row = taken[frame]
            if (int(row["episode_index"]), int(row["frame_index"]), int(row["index"])) != (i, t, frame):
                sys.exit(f"frame {frame}: numbers")
            if abs(float(row["timestamp"]) - t / 6) > 1e-6 or row["task"] != meta["tasks"][0]:
                sys.exit(f"frame {frame}: timestamp or task")
            compare_frame(compared, row, episode, t, f"episode {i} frame {t}")
            frame += 1
    if taken.num_frames != frame or taken.meta.info.splits != {k: f"{a}:{b}" for k, (a, b) in ranges.items()}:
        sys.exit(f"{taken.num_frames} frames, {taken.meta.info.splits}")
    loss = f", pictures within {compared.worst_db:.1f} dB" if lossy else ""
    print(f"LeRobotDataset: {frame} frames, {compared.numbers} numbers equal the shards'{loss}; tasks {len(taken.meta.tasks)}")
    return taken


def compare_statistics(data, export, taken):
    from lerobot.datasets.compute_stats import aggregate_stats
    from lerobot.datasets.io_utils import load_nested_dataset
    from lerobot.utils.utils import unflatten_dict
    rows = load_nested_dataset(pathlib.Path(export) / "meta/episodes")
    train = range(*map(int, taken.meta.info.splits["train"].split(":")))
    each = [unflatten_dict({key.removeprefix("stats/"): np.array(value) for key, value in rows[i].items()
                            if key.startswith("stats/")}) for i in train]
    pooled = aggregate_stats(each)
    for feature, stats in taken.meta.stats.items():
        for name in ("mean", "std", "min", "max", "count"):
            np.testing.assert_allclose(stats[name], pooled[feature][name], rtol=1e-6, atol=1e-7, err_msg=f"{feature} {name}")
    own = data.statistics
    for feature, source in (("action", "action"), ("observation.state", "proprio"), ("next.reward", "score")):
        for name, value in (("mean", own[source].mean), ("std", own[source].standard_deviation), ("min", own[source].minimum),
                            ("max", own[source].maximum)):
            np.testing.assert_allclose(taken.meta.stats[feature][name], value, atol=1e-6, err_msg=f"{feature} {name}")
    print(f"statistics: {len(pooled)} features agree with LeRobot's aggregate of the episodes' and with dataset.json")


def compare_with_datasets(data, export, stage):
    import datasets
    folder = datasets.load_dataset(str(export))
    expected = {split: sum(e.decisions for s, e in episodes_of(data, stage) if s == split) for split, _ in episodes_of(data, stage)}
    if {split: len(table) for split, table in folder.items()} != expected:
        sys.exit(f"datasets: {folder}")
    first = folder["train"][0]
    episode = episodes_of(data, stage)[0][1]
    np.testing.assert_array_equal(np.float32(first["observation.state"]), episode["proprio"][0])
    if "observation.pointcloud" in first:
        cloud = np.float32(first["observation.pointcloud"])
        np.testing.assert_array_equal(cloud, episode["cloud"][0][:len(cloud)])
    for name, value in first.items():
        camera = name.removeprefix("observation.images.")
        if camera != name and not camera.endswith("_depth"):
            np.testing.assert_array_equal(np.array(value), episode["rgb_" + camera][0])
    print(f"datasets {datasets.__version__}: {expected} rows, pictures and clouds as in the shards")


def judge_values(data, export, stage, lossy=False):
    taken = compare_with_shards(data, export, stage, lossy)
    compare_statistics(data, export, taken)
    compare_with_datasets(data, export, stage)


def content(folder):
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(pathlib.Path(folder).rglob("*")) if path.is_file()}


# Files of 1 MB, so that there are many; each of them takes a while.
SMALL_FILES = ("import runpy, sys; sys.path.insert(0, sys.argv.pop(1)); import doorforge_lerobot as made; made.FILE_BYTES = 1 << 20; "
               "sys.exit(made.main())")


def judge_killed(data_folder, folder):
    def command(out):
        return [sys.executable, "-c", SMALL_FILES, str(SOURCE / "python"), str(data_folder), "--out", str(out)]
    began = time.monotonic()
    subprocess.run(command(folder / "whole"), check=True)
    whole_s = time.monotonic() - began
    whole, rng, kills = content(folder / "whole"), random.Random(7), 0
    for number, how in enumerate([signal.SIGKILL] * 6 + [signal.SIGTERM] * 2):
        out = folder / f"cut{number}"
        while True:
            child = subprocess.Popen(command(out), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            try:
                child.communicate(timeout=whole_s * rng.uniform(0.2, 0.9))
            except subprocess.TimeoutExpired:
                child.send_signal(how)
                told = child.communicate()[1]
                kills += 1
                if how == signal.SIGTERM and child.returncode == 143 and "the same command goes on" not in told:
                    sys.exit("stopped by SIGTERM, it does not say how to go on")
                continue
            if child.returncode != 0:
                sys.exit(f"going on ended with {child.returncode}")
            break
        if content(out) != whole:
            sys.exit(f"{out}: other files than without a kill")
        shutil.rmtree(out)
    print(f"killed {kills} times in 8 exports of {sum(name.startswith('data/') for name in whole)} files: the same bytes each time")


def judge_converted(data, export):
    """LeRobot's script wants a repository's folder, and leaves the converted one in its place."""
    root = pathlib.Path(export).parent
    subprocess.run([sys.executable, "-m", "lerobot.scripts.convert_dataset_v21_to_v30", "--repo-id", pathlib.Path(export).name,
                    "--root", str(root / pathlib.Path(export).name), "--push-to-hub", "false"], check=True)
    compare_with_shards(data, export, "open", lossy=False)
    print("v2.1: converted by LeRobot's own script, equal as well")


def main():
    what, data_folder, export, *rest = sys.argv[1:]
    os.environ["HF_HUB_OFFLINE"] = "1"
    data = reader.Dataset(data_folder)
    stage = rest[0] if rest else "open"
    if what == "killed":
        judge_killed(data_folder, pathlib.Path(export))
    elif what == "converted":
        judge_converted(data, export)
    else:
        judge_values(data, export, stage, lossy=what == "video")


if __name__ == "__main__":
    main()
