# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Reads data sets that `doorforge datagen` wrote, with numpy alone.

    data = doorforge.datasets.Dataset("data")
    data.samples("open", "train")[17]["cloud"]     # float32 (points, 3) [m, world]

The same names as the one-file module `doorforge_reader`, which goes on working wherever it was copied. For PyTorch see
doorforge.torch_data.
"""
from doorforge_reader import (CorruptError, Dataset, DatasetError, Episode, Episodes, Feature, MissingError, Part, Samples,
                              Shard, Statistics, VersionError, crc32c, order, read_npy, stream)

__all__ = ["CorruptError", "Dataset", "DatasetError", "Episode", "Episodes", "Feature", "MissingError", "Part", "Samples",
           "Shard", "Statistics", "VersionError", "crc32c", "order", "read_npy", "stream"]
