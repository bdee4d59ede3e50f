# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Runs a notebook from nothing and holds its text against what it came with (nbclient, ipykernel and matplotlib of PyPI).

    python tests/python/run_notebook.py docs/examples/doors.ipynb [--write]

--write puts the new outputs into the notebook.
"""
import pathlib
import sys

import nbformat
from nbclient import NotebookClient

MOST_BYTES = 500_000


def outputs(notebook) -> list:
    """What each cell printed, and how many pictures it drew."""
    told = []
    for cell in notebook.cells:
        if cell.cell_type != "code":
            continue
        text = "".join(output.text for output in cell.outputs if output.output_type == "stream" and output.name == "stdout")
        pictures = sum(1 for output in cell.outputs if "image/png" in output.get("data", {}))
        told.append((text, pictures))
    return told


def main() -> None:
    path = pathlib.Path(sys.argv[1])
    notebook = nbformat.read(path, 4)
    before = outputs(notebook)
    NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    after = outputs(notebook)
    if "--write" in sys.argv:
        for cell in notebook.cells:
            cell.metadata.pop("execution", None)  # when it was run: every run's bytes would differ
            if cell.cell_type == "code":  # figures have names that say nothing, warnings are the machine's
                cell.outputs = [output for output in cell.outputs
                                if output.output_type == "display_data" or output.get("name") == "stdout"]
        notebook.metadata = {"kernelspec": notebook.metadata["kernelspec"], "language_info": {"name": "python"}}
        nbformat.write(notebook, path)
    elif before != after:
        raise SystemExit(f"{path}: other outputs than before\n{before}\n{after}")
    if path.stat().st_size > MOST_BYTES or not any(pictures for _, pictures in after):
        raise SystemExit(f"{path}: {path.stat().st_size} bytes, at most {MOST_BYTES}, and pictures are expected")
    print(f"{path.name}: {len(after)} cells, {sum(pictures for _, pictures in after)} pictures, {path.stat().st_size} bytes")


if __name__ == "__main__":
    main()
