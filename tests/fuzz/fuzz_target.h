// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include <nlohmann/json.hpp>

namespace doorforge::fuzz {

/// What the fuzzer keeps intact while it changes an input, so that it gets behind the first check.
enum class Shape {
  kBytes,    ///< Nothing.
  kJson,     ///< JSON: values, keys and branches are changed. What is no JSON is changed as bytes.
  kTar,      ///< A tar: the checksums of its headers are mended.
  kTensors,  ///< safetensors: a length, JSON, and data behind it.
  kGlb,      ///< Binary glTF: lengths, JSON, and a buffer behind it.
  kPng,      ///< A PNG: the checksums of its chunks are mended.
};

/// A reader of bytes from outside.
struct Target {
  std::string_view name;
  Shape shape = Shape::kBytes;
  /// Reads an input and checks what must hold of whatever is read. May throw Error, which is an
  /// answer; every other exception is a finding.
  void (*read)(std::string_view input) = nullptr;
};

/// Each program defines what it holds; the variable DOORFORGE_FUZZ_TARGET of the environment
/// chooses.
std::span<const Target> Targets();

/// Ends the program with a message unless it holds.
void Expect(bool holds, std::string_view promise);

/// True where another reader's opinion is compared (compare.py): each input then gives a line of
/// JSON, what Tell() was given for it or why it was refused.
bool Telling();
void Tell(nlohmann::ordered_json what);

}  // namespace doorforge::fuzz
