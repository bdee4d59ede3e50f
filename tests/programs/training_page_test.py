# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The page of curves that `train` writes: its dots are the numbers of losses.json, it marks the best epoch, and it
needs nothing from elsewhere."""
import json
import math
import pathlib
import re
import tempfile
import unittest
import xml.etree.ElementTree

from programs import BINARY_DIR, ProgramTest, run

DEGREES = 180 / math.pi
FACTORS = {"actor.position_m": 1000, "actor.rotation_rad": DEGREES, "actor.divergence": 1, "critic.score_rad": DEGREES,
           "discriminator.score_rad": DEGREES, "affordance.score_rad": DEGREES}
HTML = "{http://www.w3.org/1999/xhtml}"
SVG = "{http://www.w3.org/2000/svg}"


class TrainingPage(ProgramTest):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory(dir=BINARY_DIR)
        cls.addClassCleanup(folder.cleanup)
        cls.data = pathlib.Path(folder.name)
        door = cls.data / "door"
        run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--out", door)
        for stage, episodes in (("open", 2), ("grasp", 8)):
            run("datagen", stage, "--doors", door, "--out", cls.data / stage, "--episodes", episodes, "--seed", 3, "--set",
                "preview=false")

    def train(self, stage: str, out: pathlib.Path, *more: object):
        own = ["--set", "sampled_orientations=10"] if stage == "grasp" else []
        result = run("train", stage, "--data", self.data / stage, "--out", out, "--set", "batch_size=4", "--set",
                     "validation_share=0.5", *own, *more)
        self.assert_ends(result, 0)
        return result

    def page(self, out: pathlib.Path) -> xml.etree.ElementTree.Element:
        return xml.etree.ElementTree.fromstring((out / "training.html").read_text())

    def dots(self, figure) -> dict[tuple[int, str], str]:
        titles = [title.text for title in figure.iterfind(f".//{SVG}circle/{SVG}title")]
        return {(int(epoch), name): value for epoch, name, value in
                (re.fullmatch(r"epoch (\d+), (\w+): (\S+)", title).groups() for title in titles)}

    def check_curves(self, out: pathlib.Path) -> None:
        page = self.page(out)
        curves = json.loads((out / "losses.json").read_text())["curves"]
        best = json.loads((out / "best/policy.json").read_text())["provenance"]["best_epoch"]
        figures = [figure for figure in page.iter(f"{HTML}figure") if figure.find(f"{HTML}h3").text != "Learning rate"]
        self.assertEqual(len(figures), len(curves))
        for figure, curve in zip(figures, curves):
            expected = {(int(epoch), side): f"{FACTORS[curve['name']] * value:.4f}"
                        for side, name in (("training", "train"), ("validation", "validation"))
                        for epoch, value in zip(curve["epoch"], curve[name]) if value is not None}
            self.assertGreater(len(expected), 0)
            found = self.dots(figure)
            self.assertEqual(found.keys(), expected.keys())
            for dot, value in expected.items():
                self.assertAlmostEqual(float(found[dot]), float(value), delta=1.1e-4)
            marks = [title.text for title in figure.iterfind(f".//{SVG}g/{SVG}title")]
            self.assertEqual(marks, [f"best epoch: {best[curve['name'].split('.')[0]]}"])

    def test_its_curves_are_those_of_the_training(self):
        out = self.folder / "policy"
        printed = self.train("open", out, "--epochs", 3).stdout
        self.assertIn(f"curves:     {out / 'training.html'}", printed)
        self.check_curves(out)
        text = (out / "training.html").read_text()
        self.assertNotIn('http-equiv="refresh"', text)
        self.assertIsNone(re.search(r'(src|href)="|url\(|@import', text), "needs another file")
        entries = dict(zip((e.text for e in self.page(out).iter(f"{HTML}dt")), (e.text for e in self.page(out).iter(f"{HTML}dd"))))
        self.assertEqual((entries["epochs"], entries["batch_size"], entries["schedule"]), ("3", "4", "cosine"))

    def test_both_networks_of_the_grasp_have_curves(self):
        out = self.folder / "policy"
        self.train("grasp", out, "--epochs", 2)
        self.check_curves(out)

    def test_while_it_is_not_done_a_browser_looks_again(self):
        out = self.folder / "policy"
        self.train("open", out, "--epochs", 3, "--minutes", 0.00001)
        text = (out / "training.html").read_text()
        self.assertIn('http-equiv="refresh"', text)
        self.assertIn("0 of 3", text)
        self.train("open", out, "--epochs", 3, "--resume")
        self.check_curves(out)

    def test_lines_of_the_steps_name_epoch_and_learning_rate(self):
        out = self.folder / "policy"
        self.train("open", out, "--epochs", 3, "--set", "schedule=constant", "--set", "warmup_steps=0")
        lines = [json.loads(line) for line in (out / "losses.jsonl").read_text().splitlines()]
        self.assertEqual([line["step"] for line in lines], list(range(1, len(lines) + 1)))
        per_epoch = len(lines) // 3
        self.assertEqual([line["epoch"] for line in lines], [i // per_epoch + 1 for i in range(len(lines))])
        self.assertEqual({line["learning_rate"] for line in lines}, {0.001})


if __name__ == "__main__":
    unittest.main(verbosity=2)
