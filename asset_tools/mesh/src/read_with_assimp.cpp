// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <string>

#include <Eigen/LU>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"

#include "mesh_readers.h"
#include "polygon_soup.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// Opens files below one folder only: a mesh may not point at files elsewhere.
class FolderIo : public Assimp::DefaultIOSystem {
 public:
  explicit FolderIo(const fs::path& folder) : folder_(fs::weakly_canonical(folder)) {}

  bool Exists(const char* file) const override {
    return IsBelow(file) && Assimp::DefaultIOSystem::Exists(file);
  }

  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return IsBelow(file) ? Assimp::DefaultIOSystem::Open(file, mode) : nullptr;
  }

 private:
  bool IsBelow(const char* file) const {
    std::error_code error;
    const fs::path relative = fs::weakly_canonical(file, error).lexically_relative(folder_);
    return !error && !relative.empty() && *relative.begin() != "..";
  }

  fs::path folder_;
};

Eigen::Matrix4d MatrixOf(const aiMatrix4x4& m) {
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column)
      matrix(row, column) = m[static_cast<unsigned>(row)][column];
  }
  return matrix;
}

Eigen::Vector4d ColorOf(const aiScene& scene, const aiMesh& mesh) {
  Eigen::Vector4d color = ImportedPiece{}.color_rgba;
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return color;
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  aiColor4D diffuse;
  if (material.Get(AI_MATKEY_BASE_COLOR, diffuse) != aiReturn_SUCCESS &&
      material.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) != aiReturn_SUCCESS)
    return color;
  color = {diffuse.r, diffuse.g, diffuse.b, diffuse.a};
  ai_real opacity = 1;
  if (material.Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS) color.w() *= opacity;
  return color.allFinite() ? color : ImportedPiece{}.color_rgba;
}

void AddMesh(const aiScene& scene, const aiMesh& mesh, const Eigen::Matrix4d& file_from_node,
             PolygonSoup& soup) {
  const std::string name = mesh.mName.C_Str();
  soup.BeginPiece(name, ColorOf(scene, mesh));
  // a mirrored node turns its faces inside out
  const bool mirrored = file_from_node.topLeftCorner<3, 3>().determinant() < 0;
  std::vector<Eigen::Vector3d> corners;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    corners.clear();
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      const unsigned index = face.mIndices[mirrored ? face.mNumIndices - 1 - k : k];
      if (index >= mesh.mNumVertices)
        throw Error(ErrorCode::kFormat, "a face of \"" + name + "\" names vertex " +
                                            std::to_string(index) + ", allowed 0.." +
                                            std::to_string(mesh.mNumVertices - 1));
      const aiVector3D& v = mesh.mVertices[index];
      corners.push_back((file_from_node * Eigen::Vector4d(v.x, v.y, v.z, 1)).head<3>());
    }
    soup.AddPolygon(corners);
  }
}

// Metres per unit of the file, where assimp has not applied it already (as it does for DAE).
double MetresPerUnit(const aiScene& scene, const std::string& ending) {
  double centimetres = 1;
  float centimetres_float = 1;
  if (ending != ".fbx" || scene.mMetaData == nullptr) return 1;
  if (scene.mMetaData->Get("UnitScaleFactor", centimetres)) return centimetres / 100;
  if (scene.mMetaData->Get("UnitScaleFactor", centimetres_float)) return centimetres_float / 100;
  return 0.01;
}

ImportedMesh MeshOf(const aiScene& scene, const std::string& ending,
                    const MeshImportLimits& limits) {
  struct Visit {
    const aiNode* node;
    Eigen::Matrix4d file_from_parent;
  };
  Eigen::Matrix4d scale = Eigen::Matrix4d::Identity();
  scale.topLeftCorner<3, 3>() *= MetresPerUnit(scene, ending);
  // assimp turns 3DS to y up in the root; the raw frame is wanted
  if (ending == ".3ds") scale = MatrixOf(scene.mRootNode->mTransformation).inverse();
  PolygonSoup soup(limits);
  std::vector<Visit> pending{{scene.mRootNode, scale}};
  while (!pending.empty()) {
    const Visit visit = pending.back();
    pending.pop_back();
    const Eigen::Matrix4d file_from_node =
        visit.file_from_parent * MatrixOf(visit.node->mTransformation);
    for (unsigned i = 0; i < visit.node->mNumMeshes; ++i)
      AddMesh(scene, *scene.mMeshes[visit.node->mMeshes[i]], file_from_node, soup);
    for (unsigned i = visit.node->mNumChildren; i-- > 0;)
      pending.push_back({visit.node->mChildren[i], file_from_node});
  }
  return std::move(soup).Finish();
}

void RefuseDoctype(const fs::path& path, const MeshImportLimits& limits) {
  const std::string text = ReadFile(path, limits.max_file_bytes);
  if (text.find("<!DOCTYPE") != std::string::npos || text.find("<!ENTITY") != std::string::npos)
    throw Error(ErrorCode::kFormat, "a DOCTYPE or entity declaration is not allowed");
}

std::string LowerEnding(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

}  // namespace

ImportedMesh ReadWithAssimp(const fs::path& path, const MeshImportLimits& limits) {
  const std::string ending = LowerEnding(path);
  if (ending == ".dae") RefuseDoctype(path, limits);
  Assimp::Importer importer;
  importer.SetIOHandler(new FolderIo(fs::absolute(path).parent_path()));  // the importer owns it
  // keep the frame of the file: assimp would turn a Z_UP file to y up
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(path.string(), 0);
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw Error(ErrorCode::kFormat,
                std::string("assimp cannot read it: ") + importer.GetErrorString());
  return MeshOf(*scene, ending, limits);
}

}  // namespace doorforge
