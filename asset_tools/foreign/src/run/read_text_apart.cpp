// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "run/read_text_apart.h"

#include <algorithm>
#include <string_view>

#include <unistd.h>

#include "doorforge/core/confined_child.h"
#include "doorforge/core/error.h"

#include "apart/glb_apart.h"
#include "run/text_message.h"

namespace doorforge::foreign {
namespace {

constexpr ChildLimits kLimits{600, 1ULL << 30U};

// The length of the answer's first part, and that part.
std::optional<std::string_view> FirstPart(std::string_view message) {
  std::uint64_t length = 0;
  if (message.size() < sizeof length) return std::nullopt;
  std::memcpy(&length, message.data(), sizeof length);
  message.remove_prefix(sizeof length);
  if (length > message.size()) return std::nullopt;
  return message.substr(0, length);
}

bool IsSound(const TextRead& read) {
  if (!HasItsVertices(read.mesh)) return false;
  for (const ForeignLink& link : read.object.links) {
    for (const ForeignShape& shape : link.shapes) {
      const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
      if (mesh != nullptr && !HasItsVertices(*mesh)) return false;
    }
  }
  return true;
}

}  // namespace

TextReadApart ReadTextApart(const std::filesystem::path& file, const MeshFiles::Places& places,
                            bool ask_urdfdom) {
  std::vector<std::string> arguments = {
      SiblingProgram("doorforge-read-model", "DOORFORGE_READ_MODEL"),
      std::to_string(::getpid()),
      "text",
      file.string(),
      places.root.string(),
      ask_urdfdom ? "1" : "0"};
  for (const auto& [name, folder] : places.packages)
    arguments.push_back(name + "=" + folder.string());
  const ChildAnswer child = AskChild(std::move(arguments), kLimits);
  const auto refuse = [&](const std::string& problem) {
    return Error(ErrorCode::kFormat, file.string() + ": " + problem);
  };
  if (child.too_long) throw refuse("what it holds takes more than the 1 GiB allowed");
  const auto first = FirstPart(child.message);
  TextAnswer answer;
  MessageReader message(first.value_or(std::string_view()));
  message(answer);
  const bool sound = first && message.AtEnd() && answer.faults.Restore() && IsSound(answer.read);
  if (!sound) throw refuse(EndOfReader(child.status));
  if (!answer.problem.empty()) throw refuse(answer.problem);
  for (std::string& note : answer.read.notes) note = Printable(note);
  TextReadApart apart{std::move(answer.read), std::move(answer.faults), {}};
  const std::size_t rest = sizeof(std::uint64_t) + first->size();
  if (ask_urdfdom && apart.read.kind == ValidatedKind::kUrdf)
    apart.urdfdom = OpinionIn("urdfdom", child.message.substr(rest), child.status);
  return apart;
}

}  // namespace doorforge::foreign
