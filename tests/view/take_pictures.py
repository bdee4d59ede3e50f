# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Takes the pictures of docs/images that show the page of `doorforge serve`; they are looked at before they are kept.

usage: take_pictures.py BUILD"""
import pathlib
import unittest

from drop_test import LEVER, DroppedMeshes, box, stl

IMAGES = pathlib.Path(__file__).resolve().parents[2] / "docs/images"


class Pictures(DroppedMeshes):
    def take(self, name: str) -> None:
        self.browser.wait("[...document.images].every((image) => image.complete && image.style.visibility !== 'hidden')")
        self.browser.settle()
        self.browser.screenshot(IMAGES / name)

    def runTest(self) -> None:
        self.browser.size(1200, 760)
        self.browser.open(self.address)
        self.settled()
        self.set("category", "refrigerator")
        self.settled()
        self.take("composer.png")
        self.browser.size(1300, 800)
        self.drop(self.file("my_lever.stl", stl(LEVER)), self.file("my_rose.stl", stl(box((-26, -26, 0), (26, 26, 8)))))
        self.set("own-mechanism", "lever")
        self.set("own-beside", "my_rose.stl")
        self.click_face(2, 0)
        self.set("own-up", "y")
        self.browser.js("(() => { const { stage } = doorforge.composer.offered; stage.camera.position.set(0.5, -0.75, -0.42); stage.controls.update(); stage.changed(); document.activeElement.blur(); })()")
        self.take("composer_drop.png")


if __name__ == "__main__":
    result = unittest.TextTestRunner().run(unittest.TestSuite([Pictures()]))
    raise SystemExit(0 if result.wasSuccessful() else 1)
