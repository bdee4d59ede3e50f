// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "check/mesh_measures.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <set>
#include <unordered_map>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/mesh/import_mesh.h"
#include "doorforge/mesh/work_budget.h"

#include "apart/glb_apart.h"
#include "read/raw_mesh.h"

namespace doorforge::foreign {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostMeshBytes = 512ULL << 20;

std::string EndingOf(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

struct PositionHash {
  std::size_t operator()(const std::array<std::uint64_t, 3>& bits) const {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const std::uint64_t one : bits) {
      hash = (hash ^ one) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 29U;
    }
    return hash;
  }
};

bool IsInside(const fs::path& path, const fs::path& root) {
  const fs::path plain = root.has_filename() ? root : root.parent_path();  // "/a/b/" is "/a/b"
  const fs::path relative = path.lexically_relative(plain);
  return !relative.empty() && *relative.begin() != "..";
}

// A scheme before "://", or a drive of Windows.
std::string SchemeOf(const std::string& name) {
  const std::size_t at = name.find("://");
  if (at != std::string::npos) return name.substr(0, at);
  const bool drive = name.size() > 2 && name[1] == ':' && (name[2] == '\\' || name[2] == '/');
  return drive ? "a drive" : "";
}

// The folder `package` that the file lies in, or one beside a folder above it inside of the root.
std::optional<fs::path> PackageAbove(const fs::path& folder, const fs::path& root,
                                     const std::string& package) {
  std::error_code error;
  for (fs::path at = folder; at.has_relative_path(); at = at.parent_path()) {
    if (at.filename() == package) return at;
    if (IsInside(at, root) && !package.empty() && fs::is_directory(at / package, error))
      return at / package;
  }
  return std::nullopt;
}

}  // namespace

TriangleMesh Welded(const TriangleMesh& mesh) {
  TriangleMesh welded;
  std::unordered_map<std::array<std::uint64_t, 3>, int, PositionHash> indices;
  std::vector<int> index_of(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    std::array<std::uint64_t, 3> bits{};
    for (int k = 0; k < 3; ++k) {
      const double number = mesh.vertices[i][k] + 0.0;  // -0 is 0
      std::memcpy(&bits[static_cast<std::size_t>(k)], &number, sizeof number);
    }
    const auto [entry, is_new] = indices.emplace(bits, static_cast<int>(welded.vertices.size()));
    if (is_new) welded.vertices.push_back(mesh.vertices[i]);
    index_of[i] = entry->second;
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto at = [&](int k) { return index_of[static_cast<std::size_t>(t[k])]; };
    welded.triangles.emplace_back(at(0), at(1), at(2));
  }
  return welded;
}

std::size_t DropRepeated(TriangleMesh& mesh) {
  const auto key = [&](std::size_t i) {
    std::array<int, 3> corners = {mesh.triangles[i][0], mesh.triangles[i][1], mesh.triangles[i][2]};
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  std::vector<std::pair<std::array<int, 3>, std::size_t>> keys;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) keys.emplace_back(key(i), i);
  std::sort(keys.begin(), keys.end());
  std::vector<bool> drop(mesh.triangles.size(), false);
  std::size_t dropped = 0;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].first != keys[i - 1].first) continue;
    drop[keys[i].second] = true;
    ++dropped;
  }
  if (dropped == 0) return 0;
  std::vector<Eigen::Vector3i> kept;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!drop[i]) kept.push_back(mesh.triangles[i]);
  }
  mesh.triangles = std::move(kept);
  return dropped;
}

MeshMeasure MeasureTriangles(const TriangleMesh& mesh) {
  MeshMeasure measure;
  measure.triangles = mesh.triangles.size();
  TriangleMesh welded = Welded(mesh);
  measure.repeated = DropRepeated(welded);
  measure.topology = MeasureTopology(welded);
  CheckWork();
  return measure;
}

TriangleMesh TrianglesOf(const fs::path& file, const fs::path& root,
                         std::vector<ForeignFileName>& files) {
  const std::string ending = EndingOf(file);
  const bool ours = ending == ".obj" || ending == ".stl" || ending == ".ply" || ending == ".off" ||
                    ending == ".glb";
  if (!ours) {
    ImportedMesh mesh = ImportMesh(file, {.files_below = root});
    // they repeat others, which is what is asked
    for (ImportedPiece& piece : mesh.other_sides) mesh.pieces.push_back(std::move(piece));
    return MergedPieces(mesh);
  }
  if (ending == ".glb") return GlbTrianglesApart(file);
  const std::string bytes = ReadFile(file, kMostMeshBytes);
  if (bytes.empty()) throw RawMeshFault(0, "the file is empty");
  if (ending == ".obj") return ReadRawObj(bytes, file.string(), files);
  if (ending == ".stl") return ReadRawStl(bytes);
  if (ending == ".ply") return ReadRawPly(bytes);
  return ReadRawOff(bytes);
}

std::shared_ptr<const MeshMeasure> MeshMemory::Measure(const fs::path& file, const fs::path& root) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  const auto time = fs::last_write_time(file, error).time_since_epoch().count();
  const std::string key = file.string() + '\n' + std::to_string(size) + '\n' + std::to_string(time);
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
  }
  auto measure = std::make_shared<MeshMeasure>();
  try {
    std::vector<ForeignFileName> files;
    *measure = MeasureTriangles(TrianglesOf(file, root, files));
    measure->files = std::move(files);
  } catch (const RawMeshFault& fault) {
    measure->problem = fault.what();
    measure->problem_line = fault.line;
  } catch (const Error& fault) {
    measure->problem = fault.what();
  }
  const std::lock_guard lock(mutex_);
  return known_.emplace(key, std::move(measure)).first->second;
}

std::optional<fs::path> MeshFiles::Find(const ForeignFileName& name, FaultList& faults) const {
  const auto fail = [&](const char* code, const std::string& why) {
    faults.Add(name.optional ? "GEO016" : code, name.place, "\"" + name.name + "\": " + why);
    return std::nullopt;
  };
  if (name.name.empty()) return fail("GEO001", "an empty name");
  std::string rest = name.name;
  fs::path begin = places_.folder;
  const std::string scheme = SchemeOf(rest);
  if (scheme == "package" || scheme == "model") {
    const std::size_t at = scheme.size() + 3;
    const std::size_t slash = std::min(rest.find('/', at), rest.size());
    const std::string package = rest.substr(at, slash - at);
    const auto given = places_.packages.find(package);
    const auto found = given != places_.packages.end()
                           ? std::optional(given->second)
                           : PackageAbove(places_.folder, places_.root, package);
    if (!found) return fail("GEO003", "no folder \"" + package + "\" in sight");
    begin = *found;
    rest = slash < rest.size() ? rest.substr(slash + 1) : "";
  } else if (!scheme.empty()) {
    return fail("GEO002", "begins with " + scheme);
  }
  if (fs::path(rest).is_absolute()) return fail("GEO002", "is absolute");
  const fs::path path = (begin / rest).lexically_normal();
  const bool of_package = begin != places_.folder && !IsInside(begin, places_.root);
  const fs::path root = of_package ? begin : places_.root;
  if (!IsInside(path, root)) return fail("GEO002", "leads out of " + root.string());
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    return fail("GEO001", fs::exists(path, error) ? kNoRegularFile : "no such file");
  const fs::path real = fs::canonical(path, error);
  if (error || !IsInside(real, fs::canonical(root, error)))
    return fail("GEO002", "is a link that leads out of " + root.string());
  return path;
}

std::shared_ptr<const MeshMeasure> MeshFiles::Measure(const std::string& name,
                                                      const SourcePlace& place,
                                                      FaultList& faults) const {
  const auto path = Find({name, place, false}, faults);
  if (!path) return nullptr;
  static const std::set<std::string> endings = {".obj", ".stl", ".ply", ".dae", ".gltf",
                                                ".glb", ".fbx", ".3ds", ".off"};
  if (!endings.contains(EndingOf(*path))) {
    faults.Add("GEO004", place, "\"" + name + '"');
    return nullptr;
  }
  const auto measure = memory_.Measure(*path, places_.root);
  if (measure->problem.empty()) return measure;
  const std::string line =
      measure->problem_line > 0 ? ":" + std::to_string(measure->problem_line) : "";
  faults.Add("GEO005", place, "\"" + name + "\"" + line + ": " + measure->problem);
  return nullptr;
}

fs::path RootAbove(const fs::path& file, const fs::path& searched) {
  std::error_code error;
  const fs::path folder = fs::absolute(file, error).lexically_normal().parent_path();
  for (fs::path at = folder; at.has_relative_path(); at = at.parent_path()) {
    for (const char* mark : {"package.xml", "model.config", ".git"}) {
      if (fs::exists(at / mark, error)) return at;
    }
  }
  const fs::path wide = fs::absolute(searched, error).lexically_normal();
  return !searched.empty() && IsInside(folder, wide) ? wide : folder;
}

}  // namespace doorforge::foreign
