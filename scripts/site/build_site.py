# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The documents as a site that opens from the disk and asks the network for nothing: build_site.py BUILD OUT

README.md is its first page, docs/ the others, the command line's are made from what the programs in BUILD/bin say, and doors of
the catalogue stand in it in 3D. Needs mkdocs (in packages.txt); a link that leads nowhere is an error."""
from __future__ import annotations

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import yaml

from command_pages import command_pages

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINK = re.compile(r"(?<=\]\()([^)\s]+)(?=\))")
# Pages that were moved: place in the repository -> place in the site.
MOVED = {"README.md": "index.md", "CONTRIBUTING.md": "contributing.md", "SECURITY.md": "security.md", "CHANGELOG.md": "changelog.md"}
EXAMPLES = (
    ("lever", "A lever and a bolt", ("--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--set", "latch=bolt")),
    ("window", "A window with a crank", ("--body", "window_fanned_01", "--handle", "window_crank_01")),
    ("refrigerator", "A refrigerator", ("--body", "refrigerator_arched_01", "--handle", "refrigerator_latch_01")),
)


class Stage:
    """The folder of sources that mkdocs reads."""

    def __init__(self, folder: pathlib.Path) -> None:
        self.folder = folder
        self.sources: dict[str, str] = {}  # place in the site -> place in the repository

    def add(self, place: str, source: str) -> None:
        self.sources[place] = source
        target = self.folder / place
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.endswith(".md"):
            target.write_text(self._relinked(place, source))
        else:
            shutil.copyfile(ROOT / source, target)

    def place_of(self, source: str) -> str:
        """Where a file of the repository is in the site; files beyond the documents are put beside them."""
        if source in MOVED:
            return MOVED[source]
        if (ROOT / source).is_dir():
            return self.place_of(f"{source}/index.md")
        return source.removeprefix("docs/") if source.startswith("docs/") else f"source/{source}"

    def _relinked(self, place: str, source: str) -> str:
        parts = re.split(r"(^```.*?^```$)", (ROOT / source).read_text(), flags=re.M | re.S)
        return "".join(part if part.startswith("```") else LINK.sub(lambda match: self._link(match[0], place, source), part) for part in parts)

    def _link(self, link: str, place: str, source: str) -> str:
        path, _, anchor = link.partition("#")
        if ":" in path or not path:
            return link
        target = os.path.normpath(os.path.join(os.path.dirname(source), path))
        if not (ROOT / target).exists():
            return link  # no link at all, or a dead one, which mkdocs names
        there = self.place_of(target)
        if there.startswith("source/") and there not in self.sources:
            self.add(there, target)
        return os.path.relpath(there, os.path.dirname(place) or ".") + (f"#{anchor}" if anchor else "")


def title_of(page: pathlib.Path) -> str:
    heading = re.search(r"^# (.+)$", page.read_text(), re.M)
    return heading[1].replace("`", "") if heading else page.stem


def add_documents(stage: Stage) -> None:
    stage.add("site.css", "scripts/site/site.css")
    stage.add("site.js", "scripts/site/site.js")
    stage.add("search/main.js", "scripts/site/search.js")  # in place of that of mkdocs
    for source, place in MOVED.items():
        stage.add(place, source)
    for path in sorted((ROOT / "docs").rglob("*")):
        if path.is_file():
            source = str(path.relative_to(ROOT))
            stage.add(stage.place_of(source), source)
    for folder in ("design", "design/notes"):
        pages = sorted((stage.folder / folder).glob("*.md"))
        entries = [f"- [{title_of(page)}]({page.name})" for page in pages]
        (stage.folder / folder / "index.md").write_text("\n".join([f"# {'Why it is so' if folder == 'design' else 'Notes'}", "", *entries, ""]))


def run(*command: object) -> str:
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def add_doors(stage: Stage, programs: pathlib.Path, scratch: pathlib.Path) -> None:
    doorforge = programs / "doorforge"
    folder = stage.folder / "doors"
    folder.mkdir()
    lines = ["# Doors in 3D", "", "Drag to turn, wheel to zoom; the sliders move hinge and handle, and the latch holds. Each stands on a page of its "
             "own, too, as [doorforge view](../view.md) writes it.", ""]
    for name, title, words in EXAMPLES:
        run(doorforge, "compose", *words, "--out", scratch / name)
        run(doorforge, "view", scratch / name, "--out", folder / f"{name}.html")
        lines += [f"## {title}", "", frame(name, title), "", "```text", " ".join(["doorforge compose", *words, "--out", f"doors/{name}"]), "```", ""]
    run(doorforge, "view", scratch / EXAMPLES[0][0], "--episode", "--out", folder / "opened.html")
    title = "The expert opens it"
    lines += [f"## {title}", "", frame("opened", title), ""]
    (folder / "index.md").write_text("\n".join(lines))


def frame(name: str, title: str) -> str:
    return (f'<iframe src="{name}.html" title="{title}" loading="lazy" style="width: 100%; height: 560px; border: 1px solid #ccc"></iframe>\n\n'
            f"[Alone]({name}.html)")


def navigation(stage: Stage, verbs: list[str]) -> list:
    """The list of pages in README.md, then what is made here."""
    text = (ROOT / "README.md").read_text()
    text = text[text.index("\n## Pages\n"):]
    groups: list = [{"doorforge": "index.md"}, {"In 3D": "doors/index.md"}]
    for name, rest in re.findall(r"^- \*\*(.+?)\*\*: (.+)$", text, re.M):
        links = re.findall(r"\[([^]]+)\]\((docs/[^)#]+\.md)\)", rest)
        if links:
            groups.append({name: [{title[:1].upper() + title[1:]: source.removeprefix("docs/")} for title, source in links]})
    groups.append({"Command line": ["commands/index.md", *(f"commands/{verb}" for verb in verbs)]})
    listed = {place for group in groups for entries in group.values() for entry in (entries if isinstance(entries, list) else [entries])
              for place in (entry.values() if isinstance(entry, dict) else [entry])}
    rest = sorted(str(page.relative_to(stage.folder)) for page in stage.folder.rglob("*.md"))
    design = [page for page in rest if page.startswith("design/")]
    groups.append({"Why it is so": design})
    groups.append({"More": [page for page in rest if page not in listed and page not in design]})
    return groups


def write_search_index(folder: pathlib.Path) -> None:
    """Sections of all pages as a script, which a page from the disk may load, in place of what the search of mkdocs fetches."""
    entries = json.loads((folder / "search_index.json").read_text())["docs"]
    pages = {entry["location"]: entry["title"] for entry in entries if "#" not in entry["location"]}
    sections = [{"page": pages[entry["location"].partition("#")[0]], "title": entry["title"], "location": entry["location"], "text": re.sub(r" (?=[.,;:)])", "", " ".join(entry["text"].split()))}
                for entry in entries if "#" in entry["location"]]
    (folder / "index.js").write_text("window.searchSections = " + json.dumps(sections, ensure_ascii=False, separators=(",", ":")) + ";\n")
    for name in ("search_index.json", "worker.js", "lunr.js"):
        (folder / name).unlink()


def build(programs: pathlib.Path, out: pathlib.Path, scratch: pathlib.Path) -> None:
    stage = Stage(scratch / "pages")
    stage.folder.mkdir()
    add_documents(stage)
    verbs = command_pages(programs)
    for name, text in verbs.items():
        place = stage.folder / "commands" / name
        place.parent.mkdir(exist_ok=True)
        place.write_text(text)
    add_doors(stage, programs, scratch / "doors")
    config = yaml.safe_load((pathlib.Path(__file__).parent / "mkdocs.yml").read_text())
    config |= {"docs_dir": str(stage.folder), "site_dir": str(out), "nav": navigation(stage, sorted(set(verbs) - {"index.md"}))}
    (scratch / "mkdocs.yml").write_text(yaml.safe_dump(config, sort_keys=False))
    made = subprocess.run(["mkdocs", "build", "--strict", "--clean", "--config-file", str(scratch / "mkdocs.yml")], capture_output=True, text=True, check=False)
    if made.returncode != 0:
        raise SystemExit(made.stdout + made.stderr)
    (out / "404.html").unlink()  # a server's, with links from its root
    write_search_index(out / "search")


def main() -> None:
    programs, out = pathlib.Path(sys.argv[1]).resolve() / "bin", pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as scratch:
        build(programs, out, pathlib.Path(scratch))
    print(f"{out}/index.html")


if __name__ == "__main__":
    main()
