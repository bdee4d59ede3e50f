# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What doorforge raises: the codes and messages of the command line.

`error.exit_code` is the code with which `doorforge VERB` would have ended.
"""
from __future__ import annotations


class Error(Exception):
    """A call that could not be carried out. The message says what, where, found against allowed, and what to do."""

    exit_code = 3


class InvalidArgumentError(Error, ValueError):
    """An argument is wrong: an unknown name, an array of another shape, a number that is not finite."""

    exit_code = 2


class InvalidConfigError(Error, ValueError):
    """A setting is out of range or unknown."""

    exit_code = 2


class MissingError(Error, LookupError):
    """A file, folder, door, part or policy that is not there."""

    exit_code = 3


class FormatError(Error, ValueError):
    """A file whose content is not what its format says."""

    exit_code = 3


class FileAccessError(Error, RuntimeError):
    """The operating system refused a read or a write."""

    exit_code = 3


class IncompleteError(Error, RuntimeError):
    """A part of the work is done and recorded, the rest is not."""

    exit_code = 4
