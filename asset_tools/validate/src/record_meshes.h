// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/parts/grasp.h"
#include "doorforge/parts/line_hits.h"
#include "doorforge/schemas/mesh_file.h"

#include "findings.h"
#include "memo.h"

namespace doorforge::internal {

/// A mesh file as it lies on disk.
struct MeshOnDisk {
  TriangleMesh mesh;   ///< Empty if the file cannot be read.
  std::string sha256;  ///< It hashes the canonical text of `mesh`.
  Findings findings;   ///< MSH001 to MSH004, with `where` as the record names the file.
};
using SharedMesh = std::shared_ptr<const MeshOnDisk>;

/// Where lines along x meet a leaf, and its bounds.
struct LeafLines {
  explicit LeafLines(const TriangleMesh& leaf);

  LinesAlongX lines;
  Eigen::AlignedBox3d bounds;
  bool closed;  ///< Else a line may find the back of it where its front is missing.
};

/// What a run has found out about mesh contents. Keys are hashes of contents (for files: of what
/// names them), so the findings of a door do not depend on the doors before it.
struct ValidationMemory {
  Memo<MeshOnDisk> files{std::size_t{256}
                         << 20};  ///< It holds meshes of pools and is weighed in bytes.
  Memo<Findings> pieces{std::size_t{1} << 20};   ///< CheckPiece(), weighed in findings.
  Memo<GraspFit> fits{std::size_t{1} << 16};     ///< MeasureGrasp(), weighed one each.
  Memo<double> volumes{std::size_t{1} << 20};    ///< Signed [m3].
  Memo<LeafLines> leaves{std::size_t{1} << 24};  ///< Weighed in triangles.
};

/// Reads the meshes of one record. What cannot be read becomes a finding and an empty mesh, so that
/// the rest of the record is still checked.
class RecordMeshes {
 public:
  /// @param record "door.json" or "part.json", for messages.
  RecordMeshes(std::filesystem::path folder, std::string record, ValidationMemory& memory);

  MeshReader Reader();
  /// What an author drew and cannot be read becomes a finding and a surface without triangles.
  VisualReader Visuals();

  /// The meshes that Reader() has read, in that order.
  const std::vector<SharedMesh>& read() const { return read_; }
  Findings FindingsOfFiles() const;

 private:
  SharedMesh Load(const std::string& relative, const std::string& sha256);
  MeshOnDisk LoadFile(const std::string& relative, const std::string& sha256) const;
  std::filesystem::path FileOf(const std::string& relative, const std::string& sha256) const;
  const char* CodeOf(const std::string& relative, const Error& error) const;
  bool LinksOut(const std::string& relative) const;

  std::filesystem::path folder_;
  std::string record_;
  std::string pool_;  ///< Absolute path of the pool beside the folder.
  ValidationMemory& memory_;
  std::vector<SharedMesh> read_;
  Findings visual_findings_;
};

}  // namespace doorforge::internal
