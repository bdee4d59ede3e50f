# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""robomimic itself on an export: its report on the file, then ten steps of its behaviour cloning.

    /usr/bin/python3 tests/dataset/robomimic_judge.py BUILD [--data DIR --stage STAGE] [--venv DIR]

It is for hand, not one of the tests of ./test.sh: robomimic comes from PyPI with what it imports (about half a minute),
into a virtual environment that borrows Debian's python3-torch, python3-h5py and python3-numpy. Ends with 0 if robomimic
found nothing wrong and its losses are finite.
"""
import argparse
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import venv

SOURCE = pathlib.Path(__file__).resolve().parents[2]
STEPS = 10
# without dependencies: they would bring a PyTorch of some gigabytes in the place of Debian's
ALONE = ["robomimic==0.3.0", "torchvision==0.15.1"]
# for Debian 12's numpy 1.24
WITH_THEIR_OWN = ["numpy<1.25", "tqdm", "termcolor", "tensorboardX", "imageio", "psutil", "matplotlib<3.9"]


def python_with_robomimic(folder: pathlib.Path) -> pathlib.Path:
    python = folder / "bin/python"
    if not python.exists():
        venv.create(folder, system_site_packages=True, with_pip=True)
        for words in (["--no-deps", *ALONE], WITH_THEIR_OWN):
            subprocess.run([python, "-m", "pip", "install", "--quiet", *words], check=True)
    return python


def settings(data: pathlib.Path, out: pathlib.Path, has_validation: bool) -> dict:
    """robomimic's own configuration of behaviour cloning, as far as it differs from its defaults."""
    return {
        "algo_name": "bc",
        "experiment": {"name": "doorforge", "validate": has_validation, "epoch_every_n_steps": STEPS,
                       "validation_epoch_every_n_steps": 1, "rollout": {"enabled": False},
                       "save": {"enabled": True, "every_n_epochs": 1}, "logging": {"log_tb": False}},
        "train": {"data": str(data), "output_dir": str(out), "hdf5_filter_key": "train",
                  "hdf5_validation_filter_key": "val" if has_validation else None, "hdf5_load_next_obs": False,
                  "batch_size": 1, "num_epochs": 1, "cuda": False, "seed": 1},
        "observation": {"modalities": {"obs": {"low_dim": ["cloud", "proprio"]}}},
    }


def run(*command: object) -> str:
    result = subprocess.run([*map(str, command)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=900)
    print(result.stdout)
    if result.returncode != 0:
        sys.exit(f"{command[:4]} ended with {result.returncode}")
    return result.stdout


def judge(python: pathlib.Path, export: pathlib.Path, folder: pathlib.Path) -> None:
    report = run(python, "-W", "ignore", "-m", "robomimic.scripts.get_dataset_info", "--dataset", export)
    config = folder / "bc.json"
    config.write_text(json.dumps(settings(export, folder / "trained", "filter key val with 0" not in report
                                          and "filter key val" in report)))
    log = run(python, "-W", "ignore", "-m", "robomimic.scripts.train", "--config", config)
    losses = [float(text) for text in re.findall(r'"Loss": ([-\w.+]+)', log)]
    if not losses or not all(map(math.isfinite, losses)) or "finished run successfully!" not in log:
        sys.exit(f"robomimic did not train: losses {losses}")
    saved = list((folder / "trained").glob("doorforge/*/models/*.pth"))
    if not saved:
        sys.exit("robomimic left no policy")
    print(f"robomimic trained {STEPS} steps; losses of training and validation: {losses}; {saved[0].name}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--data", type=pathlib.Path, default=SOURCE / "tests/golden/dataset_v1")
    parser.add_argument("--stage", default="open")
    parser.add_argument("--venv", type=pathlib.Path, help="kept for the next run, unless it is left out")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        python = python_with_robomimic(arguments.venv or folder / "venv")
        export = folder / "export.hdf5"
        run(arguments.build / "bin/doorforge-datagen", "dataset", "export", arguments.data, "--to", "robomimic",
            "--stage", arguments.stage, "--out", export)
        judge(python, export, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
