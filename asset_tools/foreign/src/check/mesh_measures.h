// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/foreign/articulated_object.h"

#include "faults/fault_list.h"

namespace doorforge::foreign {

/// What is known of a mesh file.
struct MeshMeasure {
  std::string problem;   ///< Why it cannot be read; empty if it can.
  int problem_line = 0;  ///< 0 where the format has no lines.
  /// It is of the triangles with equal positions as one vertex and without repeated triangles.
  MeshTopology topology;
  std::size_t triangles = 0;
  std::size_t repeated = 0;
  std::vector<ForeignFileName> files;  ///< Materials, textures and buffers.
};

MeshMeasure MeasureTriangles(const TriangleMesh& mesh);

/// The mesh with vertices at the same position as one.
TriangleMesh Welded(const TriangleMesh& mesh);

/// Keeps the first of the triangles that have the same three corners; returns how many went.
std::size_t DropRepeated(TriangleMesh& mesh);

/// Remembers meshes for as long as it lives, by path, size and time of change. For several threads.
class MeshMemory {
 public:
  std::shared_ptr<const MeshMeasure> Measure(const std::filesystem::path& file,
                                             const std::filesystem::path& root);

 private:
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const MeshMeasure>> known_;
};

/// Where the files that an object names lie, and what is known of its meshes.
class MeshFiles {
 public:
  struct Places {
    std::filesystem::path folder;  ///< The file lies in it; relative names begin there.
    std::filesystem::path root;    ///< Nothing outside is opened.
    std::map<std::string, std::filesystem::path> packages;
  };

  MeshFiles(Places places, MeshMemory& memory) : places_(std::move(places)), memory_(memory) {}

  /// The file that a name stands for; GEO001, GEO002 or GEO003 where there is none (GEO016 in their
  /// place for what is optional).
  std::optional<std::filesystem::path> Find(const ForeignFileName& name, FaultList& faults) const;

  /// Null, and a finding, where it cannot be measured.
  std::shared_ptr<const MeshMeasure> Measure(const std::string& name, const SourcePlace& place,
                                             FaultList& faults) const;

  const Places& places() const { return places_; }

 private:
  Places places_;
  MeshMemory& memory_;
};

/// The nearest folder above with package.xml, model.config or .git, else the folder that was
/// searched, if the file lies in it, else the file's own.
std::filesystem::path RootAbove(const std::filesystem::path& file,
                                const std::filesystem::path& searched);

/// The triangles of a file that is read here (OBJ, STL, PLY, OFF, GLB), or by doorforge-read-mesh.
/// Throws RawMeshFault or Error.
TriangleMesh TrianglesOf(const std::filesystem::path& file, const std::filesystem::path& root,
                         std::vector<ForeignFileName>& files);

}  // namespace doorforge::foreign
