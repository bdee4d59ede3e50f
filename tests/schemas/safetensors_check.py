# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a safetensors file with numpy and struct alone, and writes another one for the C++ reader."""
import json
import struct
import sys

import numpy as np

TYPES = {"F64": "<f8", "F32": "<f4", "I64": "<i8", "U8": "|u1"}


def read(path):
    with open(path, "rb") as file:
        raw = file.read()
    (length,) = struct.unpack("<Q", raw[:8])
    header, data = json.loads(raw[8 : 8 + length]), raw[8 + length :]
    metadata = header.pop("__metadata__", {})
    tensors, covered = {}, 0
    for name, entry in header.items():
        begin, end = entry["data_offsets"]
        assert begin == covered, (name, begin, covered)
        covered = end
        tensors[name] = np.frombuffer(data[begin:end], TYPES[entry["dtype"]]).reshape(entry["shape"])
    assert covered == len(data)
    return tensors, metadata


def write(path, tensors, metadata):
    header, data = {"__metadata__": metadata}, b""
    names = {dtype: name for name, dtype in TYPES.items()}
    for name, value in tensors.items():
        raw = value.tobytes()
        header[name] = {"dtype": names[value.dtype.str], "shape": value.shape,
                        "data_offsets": [len(data), len(data) + len(raw)]}
        data += raw
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    with open(path, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text + data)


tensors, metadata = read(sys.argv[1])
assert metadata == {"note": 'a "quoted" word', "step": "7"}, metadata
assert tensors["b.matrix"].tolist() == np.array([[1, -2.5, 3], [4, 5, 1e-30]], "f4").tolist()
assert tensors["a.bytes"].tolist() == [0, 7, 255]
assert tensors["scalar"].shape == () and tensors["scalar"] == 0.1
assert tensors["counts"].tolist() == [[-1], [1 << 60]]
assert tensors["empty"].shape == (0, 4)
write(sys.argv[2], {"ramp": np.arange(4, dtype="<f4").reshape(2, 2), "count": np.array([-5], "<i8")}, {"format": "np"})
