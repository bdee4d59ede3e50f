// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"

#include "read/readers.h"

namespace doorforge::foreign {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostTextBytes = 16ULL << 20U;

}  // namespace

std::optional<std::string> ForeignText(const fs::path& path, FaultList& faults) {
  std::error_code error;
  const std::uint64_t size = fs::file_size(path, error);
  if (!error && size > kMostTextBytes) {
    faults.Add("FIL003", {path.string(), 0, 0, {}},
               std::to_string(size) + " bytes, more than the 16 MiB allowed");
    return std::nullopt;
  }
  try {
    return ReadFile(path, kMostTextBytes);
  } catch (const Error& problem) {
    faults.Add("FIL001", {path.string(), 0, 0, {}}, problem.what());
    return std::nullopt;
  }
}

std::optional<XmlDocument> ForeignXml(std::string_view text, const std::string& file,
                                      FaultList& faults) {
  try {
    return ParseXml(text);
  } catch (const XmlFault& fault) {
    const char* code = fault.kind == XmlFaultKind::kLimit         ? "FIL003"
                       : fault.kind == XmlFaultKind::kDeclaration ? "FIL004"
                                                                  : "FIL002";
    faults.Add(code, {file, fault.line, fault.column, {}}, fault.what());
    return std::nullopt;
  }
}

}  // namespace doorforge::foreign
