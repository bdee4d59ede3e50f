// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "run/read_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/read_beginning.h"

#include "read/glb_file.h"
#include "read/readers.h"

namespace doorforge::foreign {
namespace {

namespace fs = std::filesystem;

bool IsUsd(const std::string& ending) {
  return ending == ".usda" || ending == ".usd" || ending == ".usdc" || ending == ".usdz";
}

bool IsGltf(const std::string& ending) { return ending == ".glb" || ending == ".gltf"; }

bool IsXml(const std::string& ending) {
  static const std::set<std::string> endings = {".urdf", ".sdf",   ".xml",
                                                ".mjcf", ".world", ".model"};
  return endings.contains(ending);
}

/// Reads one file's text.
class TextReader {
 public:
  TextReader(const fs::path& file, const MeshFiles::Places& places, FaultList& faults)
      : file_(file), name_(file.string()), places_(places), faults_(faults) {}

  TextRead Read() {
    std::string ending = file_.extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    read_.kind = KindByEnding(ending);
    if (IsGltf(ending))
      Gltf();
    else if (IsUsd(ending))
      Usd();
    else
      Xml();
    return std::move(read_);
  }

 private:
  SourcePlace Whole() const { return {name_, 0, 0, {}}; }

  void Judge(ArticulatedObject object) {
    read_.object = std::move(object);
    read_.after = AfterText::kJudge;
  }

  void Xml() {
    const auto text = ForeignText(file_, faults_);
    if (!text) return;
    const auto document = ForeignXml(*text, name_, faults_);
    if (!document) {
      read_.after = AfterText::kAsk;
      return;
    }
    const XmlElement& root = *document->root;
    if (root.name == "mujocoinclude") {
      read_.kind = ValidatedKind::kMjcf;
      read_.notes.emplace_back("a fragment, which is judged with the files that include it");
      return;
    }
    const std::array<std::pair<const char*, ValidatedKind>, 3> kinds = {
        {{"robot", ValidatedKind::kUrdf},
         {"mujoco", ValidatedKind::kMjcf},
         {"sdf", ValidatedKind::kSdf}}};
    const auto known = std::find_if(kinds.begin(), kinds.end(),
                                    [&](const auto& one) { return root.name == one.first; });
    const bool other = known != kinds.end() && read_.kind != ValidatedKind::kUnknown &&
                       read_.kind != known->second;
    if (known == kinds.end() || other)
      return faults_.Add("FIL005", PlaceOf(name_, root), "the root element is <" + root.name + ">");
    read_.kind = known->second;
    if (read_.kind == ValidatedKind::kUrdf) Judge(ReadForeignUrdf(*document, name_, faults_));
    if (read_.kind == ValidatedKind::kMjcf)
      Judge(ReadForeignMjcf(*document, name_, places_.root, faults_));
    if (read_.kind == ValidatedKind::kSdf) Judge(ReadForeignSdf(*document, name_, faults_));
  }

  void Usd() {
    const std::string begin = ReadBeginning(file_, 8);
    const std::string_view magic = begin;
    if (magic == "PXR-USDC" || magic.starts_with("PK")) {
      read_.kind = ValidatedKind::kUnknown;
      const bool crate = magic == "PXR-USDC";
      return faults_.Add("FIL011", Whole(), crate ? "binary USD (crate)" : "a package (usdz)");
    }
    const auto text = ForeignText(file_, faults_);
    if (!text) return;
    if (!text->starts_with("#usda"))
      return faults_.Add("FIL005", Whole(), "the file does not begin with #usda");
    ArticulatedObject object = ReadForeignUsda(*text, name_, faults_);
    if (!faults_.HasError() || !(faults_.Has("FIL002") || faults_.Has("FIL003")))
      Judge(std::move(object));
  }

  void Gltf() {
    MeshMemory memory;
    const MeshFiles files(places_, memory);
    const BufferReader buffers = [&](const ForeignFileName& name) -> std::optional<std::string> {
      const auto path = files.Find(name, faults_);
      if (!path) return std::nullopt;
      return ReadFile(*path, 512ULL << 20U);
    };
    read_.after = AfterText::kAsk;
    try {
      const std::string bytes = ReadFile(file_, 512ULL << 20U);
      read_.mesh = CheckGltf(bytes, name_, buffers, faults_);
      read_.after = AfterText::kJudge;
    } catch (const Error& error) {
      faults_.Add("FIL001", Whole(), error.what());
    }
  }

  const fs::path& file_;
  std::string name_;
  const MeshFiles::Places& places_;
  FaultList& faults_;
  TextRead read_;
};

}  // namespace

bool IsText(const std::string& ending) { return IsGltf(ending) || IsUsd(ending) || IsXml(ending); }

ValidatedKind KindByEnding(const std::string& ending) {
  if (IsGltf(ending)) return ValidatedKind::kGltf;
  if (IsUsd(ending)) return ValidatedKind::kUsda;
  if (ending == ".urdf") return ValidatedKind::kUrdf;
  if (ending == ".mjcf") return ValidatedKind::kMjcf;
  return ending == ".sdf" ? ValidatedKind::kSdf : ValidatedKind::kUnknown;
}

TextRead ReadText(const fs::path& file, const MeshFiles::Places& places, FaultList& faults) {
  return TextReader(file, places, faults).Read();
}

}  // namespace doorforge::foreign
