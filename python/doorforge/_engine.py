# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Loads the extension, and says by name what is missing where it cannot be loaded."""
from __future__ import annotations

import importlib
import os
import pathlib
import sys
import types
from typing import Optional

# What the extension links beyond the C and C++ libraries of every Debian: soname -> package of Debian 12.
# tests/python/package_test.py holds it against the extension itself.
SHARED_LIBRARIES = {
    "libBulletDynamics-float64.so.3.24": "libbullet3.24",
    "libBulletCollision-float64.so.3.24": "libbullet3.24",
    "libLinearMath-float64.so.3.24": "libbullet3.24",
    "libembree3.so.3": "libembree3-3",
    "libjpeg.so.62": "libjpeg62-turbo",
    "libpng16.so.16": "libpng16-16",
    "libyaml-cpp.so.0.7": "libyaml-cpp0.7",
    "libcrypto.so.3": "libssl3",
    "libtinyxml2.so.9": "libtinyxml2-9",
}


def missing_packages() -> list[str]:
    """Debian packages whose libraries the extension needs and this system does not have."""
    import ctypes  # where nothing is missing, nobody waits for it

    missing = []
    for soname, package in SHARED_LIBRARIES.items():
        try:
            ctypes.CDLL(soname)
        except OSError:
            missing.append(package)
    return sorted(set(missing))


def _set_data_folder() -> None:
    """A wheel brings the catalogue and the robot along; an installation lies where its programs are."""
    bundled = pathlib.Path(__file__).parent / "share"
    if (bundled / "robots").is_dir():
        os.environ.setdefault("DOORFORGE_DATA", str(bundled))
    else:
        for prefix in list(pathlib.Path(__file__).parents)[2:5:2]:  # beside the package, and four folders up
            folder = prefix / "share" / "doorforge"
            if (folder / "robots").is_dir():
                os.environ.setdefault("DOORFORGE_DATA", str(folder))


def _reason(error: ImportError) -> str:
    built = list(pathlib.Path(__file__).parent.glob("_core*.so"))
    if not built:
        return ("doorforge: the extension is not here, only the Python files are; build it with `pip install .` in the "
                "sources, or install the package doorforge. Without it there are doorforge.datasets and doorforge.latch")
    packages = missing_packages()
    if packages:
        return f"doorforge needs libraries of Debian that are not installed; apt-get install {' '.join(packages)}"
    tag = f"cpython-{sys.version_info.major}{sys.version_info.minor}"
    if not any(tag in file.name for file in built):
        return (f"doorforge: the extension is {', '.join(file.name for file in built)}, but this is Python "
                f"{sys.version_info.major}.{sys.version_info.minor}; install a wheel for it with `pip install .`")
    return f"doorforge: the extension cannot be loaded: {error}"


def load() -> tuple[Optional[types.ModuleType], Optional[str]]:
    """The extension, or why there is none."""
    _set_data_folder()
    try:
        return importlib.import_module("doorforge._core"), None
    except ImportError as error:
        return None, _reason(error)


core, problem = load()


def require() -> types.ModuleType:
    """The extension. Raises ImportError that says what is missing and how to get it."""
    if core is None:
        raise ImportError(problem)
    if core.Door.__doc__ in (None, ""):
        _describe(core)
    return core


def _describe(module: types.ModuleType) -> None:
    """What `_core.pyi` says of the classes, for help(). The methods of an extension take no text: it goes to their class."""
    import ast

    stub = pathlib.Path(__file__).with_name("_core.pyi").read_text(encoding="utf-8")
    for node in ast.parse(stub).body:
        if not isinstance(node, ast.ClassDef):
            continue
        described, texts = getattr(module, node.name), [ast.get_docstring(node) or "", ""]
        for member in node.body:
            if not isinstance(member, ast.FunctionDef) or member.name.startswith("_"):
                continue
            text = ast.get_docstring(member) or ""
            if not any(ast.unparse(word) == "property" for word in member.decorator_list):
                texts.append(f"{member.name}({ast.unparse(member.args)}): {text}")
            elif isinstance(vars(described).get(member.name), property):
                vars(described)[member.name].__doc__ = text
        described.__doc__ = "\n".join(texts).rstrip()
