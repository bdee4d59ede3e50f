// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"

#include "files/file_frame.h"
#include "files/mesh_readers.h"
#include "files/picture_files.h"
#include "files/polygon_soup.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

/// A file's bytes as assimp reads them.
class FileInMemory {
 public:
  explicit FileInMemory(std::string bytes) : bytes_(std::move(bytes)) {}

 protected:
  std::string bytes_;
};

class FileStream : private FileInMemory, public Assimp::MemoryIOStream {
 public:
  explicit FileStream(std::string bytes)
      : FileInMemory(std::move(bytes)),
        MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size()) {}
};

// Opens files below one folder only: a mesh may not point at files elsewhere. Whether a file is
// there must be asked without opening it, which assimp's own system does: a pipe would keep it
// waiting. What has become a pipe since, or a device, is refused as it is read.
class FolderIo : public Assimp::DefaultIOSystem {
 public:
  FolderIo(const fs::path& mesh, const MeshImportLimits& limits)
      : files_(mesh, limits), limits_(limits) {}

  bool Exists(const char* file) const override {
    std::error_code error;
    return files_.IsBelow(file) && fs::is_regular_file(file, error);
  }

  Assimp::IOStream* Open(const char* file, const char*) override {
    if (!Exists(file)) return nullptr;
    try {
      return new FileStream(ReadFile(file, limits_.max_file_bytes));  // assimp owns it
    } catch (const Error&) {
      return nullptr;
    }
  }

 private:
  NamedFiles files_;
  MeshImportLimits limits_;
};

Eigen::Matrix4d MatrixOf(const aiMatrix4x4& m) {
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column)
      matrix(row, column) = m[static_cast<unsigned>(row)][column];
  }
  return matrix;
}

// glTF states linear light (its specification, 3.9.2); the others what a screen shows.
double Srgb(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

bool IsGltf(const std::string& ending) { return ending == ".gltf" || ending == ".glb"; }

Eigen::Vector4d ColorOf(const aiMaterial& material, const std::string& ending) {
  Eigen::Vector4d color = ImportedPiece{}.color_rgba;
  aiColor4D diffuse;
  if (material.Get(AI_MATKEY_BASE_COLOR, diffuse) != aiReturn_SUCCESS &&
      material.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) != aiReturn_SUCCESS)
    return color;
  color = {diffuse.r, diffuse.g, diffuse.b, diffuse.a};
  ai_real opacity = 1;
  // of glTF it repeats the colour's fourth number
  if (!IsGltf(ending) && material.Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS)
    color.w() *= opacity;
  if (!color.allFinite()) return ImportedPiece{}.color_rgba;
  color = color.cwiseMax(0.0).cwiseMin(1.0);
  if (IsGltf(ending)) color.head<3>() = color.head<3>().unaryExpr(&Srgb);
  if (color.w() == 0) color.w() = 1;
  return color;
}

/// The materials of a scene, each as often as the scene has it.
class SceneMaterials {
 public:
  SceneMaterials(const aiScene& scene, std::string ending, PictureFiles& pictures)
      : scene_(scene), ending_(std::move(ending)), pictures_(pictures) {}

  std::vector<ImportedMaterial> Read() {
    std::vector<ImportedMaterial> materials;
    for (unsigned i = 0; i < scene_.mNumMaterials; ++i)
      materials.push_back(Read(*scene_.mMaterials[i]));
    return materials;
  }

 private:
  ImportedMaterial Read(const aiMaterial& material) {
    ImportedMaterial read;
    aiString name;
    if (material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) read.name = name.C_Str();
    read.color_rgba = ColorOf(material, ending_);
    aiString picture;
    if (material.GetTexture(aiTextureType_BASE_COLOR, 0, &picture) != aiReturn_SUCCESS &&
        material.GetTexture(aiTextureType_DIFFUSE, 0, &picture) != aiReturn_SUCCESS)
      return read;
    read.picture = PictureFor(picture.C_Str());
    // in COLLADA a picture stands in place of the colour; others may state black beside it
    if (read.picture >= 0 && (ending_ == ".dae" || read.color_rgba.head<3>().isZero(0)))
      read.color_rgba.head<3>().setOnes();
    return read;
  }

  int PictureFor(const std::string& name) {
    const aiTexture* embedded = scene_.GetEmbeddedTexture(name.c_str());
    if (embedded == nullptr) return pictures_.Add(name);
    // a height stands for raw pixels, which no file of these formats has
    if (embedded->mHeight > 0) return pictures_.AddEmbedded(name, {});
    return pictures_.AddEmbedded(
        name, {reinterpret_cast<const char*>(embedded->pcData), embedded->mWidth});
  }

  const aiScene& scene_;
  std::string ending_;
  PictureFiles& pictures_;
};

/// What a scene's meshes are added to.
struct SceneSoup {
  PolygonSoup polygons;
  std::vector<ImportedMaterial> materials;
};

void AddMesh(const aiMesh& mesh, const Eigen::Matrix4d& file_from_node, SceneSoup& soup) {
  const std::string name = mesh.mName.C_Str();
  const bool stated = mesh.mMaterialIndex < soup.materials.size();
  soup.polygons.BeginPiece(
      name, stated ? soup.materials[mesh.mMaterialIndex].color_rgba : ImportedPiece{}.color_rgba,
      stated ? static_cast<int>(mesh.mMaterialIndex) : -1);
  const aiVector3D* texcoords = mesh.mTextureCoords[0];
  // a mirrored node turns its faces inside out
  const bool mirrored = file_from_node.topLeftCorner<3, 3>().determinant() < 0;
  std::vector<Eigen::Vector3d> corners;
  std::vector<Eigen::Vector2d> coordinates;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    corners.clear();
    coordinates.clear();
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      const unsigned index = face.mIndices[mirrored ? face.mNumIndices - 1 - k : k];
      if (index >= mesh.mNumVertices)
        throw Error(ErrorCode::kFormat, "a face of \"" + name + "\" names vertex " +
                                            std::to_string(index) + ", allowed 0.." +
                                            std::to_string(mesh.mNumVertices - 1));
      const aiVector3D& v = mesh.mVertices[index];
      corners.push_back((file_from_node * Eigen::Vector4d(v.x, v.y, v.z, 1)).head<3>());
      if (texcoords != nullptr) coordinates.emplace_back(texcoords[index].x, texcoords[index].y);
    }
    soup.polygons.AddPolygon(corners, coordinates);
  }
}

std::string LowerEnding(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

FileFrame FrameOfFbx(const aiScene& scene) {
  double centimetres = 1;
  float centimetres_float = 1;
  if (scene.mMetaData == nullptr) return {};
  if (scene.mMetaData->Get("UnitScaleFactor", centimetres))
    return {.unit_m = centimetres / 100, .states_unit = true};
  if (scene.mMetaData->Get("UnitScaleFactor", centimetres_float))
    return {.unit_m = centimetres_float / 100, .states_unit = true};
  return {.unit_m = 0.01};
}

FileFrame FrameOf(const aiScene& scene, const fs::path& path, const MeshImportLimits& limits) {
  const std::string ending = LowerEnding(path);
  if (IsGltf(ending)) return FrameOfGltf();
  if (ending == ".dae") return FrameOfCollada(ReadFile(path, limits.max_file_bytes));
  if (ending == ".fbx") return FrameOfFbx(scene);
  return {};
}

// A mesh in such a frame would be of no size along some direction, or nowhere.
void RefuseFrame(const Eigen::Matrix4d& file_from_node, const std::string& name) {
  constexpr double kFlat = 1e-6;      // of the largest stretch
  constexpr double kRounding = 1e-4;  // exporters multiply in single precision
  const auto fail = [&](const std::string& problem) {
    throw Error(ErrorCode::kFormat, "node \"" + name + "\": " + problem +
                                        "; apply the node's transform to its mesh and export the "
                                        "file again");
  };
  if (!file_from_node.allFinite()) fail("its transform holds numbers that are not finite");
  const Eigen::RowVector4d last = file_from_node.row(3) - Eigen::RowVector4d(0, 0, 0, 1);
  if (last.cwiseAbs().maxCoeff() > kRounding) fail("the last row of its transform is not 0 0 0 1");
  const Eigen::Vector3d stretch = file_from_node.topLeftCorner<3, 3>().jacobiSvd().singularValues();
  if (!(stretch.z() > kFlat * stretch.x()))
    fail("its transform flattens the mesh, since a scale of it is zero");
}

ImportedMesh MeshOf(const aiScene& scene, const fs::path& path, const MeshImportLimits& limits) {
  const std::string ending = LowerEnding(path);
  struct Visit {
    const aiNode* node;
    Eigen::Matrix4d file_from_parent;
  };
  Eigen::Matrix4d scale = Eigen::Matrix4d::Identity();
  const FileFrame frame = FrameOf(scene, path, limits);
  // of the formats that state a unit, assimp applies that of DAE itself
  if (ending == ".fbx") scale.topLeftCorner<3, 3>() *= frame.unit_m;
  // assimp turns 3DS to y up in the root; the raw frame is wanted
  if (ending == ".3ds") scale = MatrixOf(scene.mRootNode->mTransformation).inverse();
  PictureFiles pictures(path, limits);
  SceneSoup soup{PolygonSoup(limits), SceneMaterials(scene, ending, pictures).Read()};
  std::vector<Visit> pending{{scene.mRootNode, scale}};
  while (!pending.empty()) {
    const Visit visit = pending.back();
    pending.pop_back();
    const Eigen::Matrix4d file_from_node =
        visit.file_from_parent * MatrixOf(visit.node->mTransformation);
    if (visit.node->mNumMeshes > 0) RefuseFrame(file_from_node, visit.node->mName.C_Str());
    for (unsigned i = 0; i < visit.node->mNumMeshes; ++i)
      AddMesh(*scene.mMeshes[visit.node->mMeshes[i]], file_from_node, soup);
    for (unsigned i = visit.node->mNumChildren; i-- > 0;)
      pending.push_back({visit.node->mChildren[i], file_from_node});
  }
  ImportedMesh mesh = std::move(soup.polygons).Finish();
  mesh.materials = std::move(soup.materials);
  mesh.frame = frame;
  pictures.MoveTo(mesh);
  return mesh;
}

void RefuseDoctype(const fs::path& path, const MeshImportLimits& limits) {
  const std::string text = ReadFile(path, limits.max_file_bytes);
  if (text.find("<!DOCTYPE") != std::string::npos || text.find("<!ENTITY") != std::string::npos)
    throw Error(ErrorCode::kFormat, "a DOCTYPE or entity declaration is not allowed");
}

}  // namespace

ImportedMesh ReadWithAssimp(const fs::path& path, const MeshImportLimits& limits) {
  const std::string ending = LowerEnding(path);
  if (ending == ".dae") RefuseDoctype(path, limits);
  if (IsGltf(ending)) RefuseGltfRotations(path, limits);
  Assimp::Importer importer;
  importer.SetIOHandler(new FolderIo(path, limits));  // the importer owns it
  // keep the frame of the file: assimp would turn a Z_UP file to y up
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(path.string(), 0);
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw Error(ErrorCode::kFormat,
                std::string("assimp cannot read it: ") + importer.GetErrorString());
  return MeshOf(*scene, path, limits);
}

}  // namespace doorforge
