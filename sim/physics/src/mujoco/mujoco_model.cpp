// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "mujoco/mujoco_model.h"

#include <algorithm>
#include <array>
#include <mutex>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

/// A text as a file that MuJoCo opens by name.
class FileInMemory {
 public:
  static constexpr const char* kName = "scene.xml";

  explicit FileInMemory(const std::string& text) : files_(std::make_unique<mjVFS>()) {
    Mujoco().default_vfs(files_.get());
    Require(Mujoco().make_empty_file_vfs(files_.get(), kName, static_cast<int>(text.size())) == 0,
            ErrorCode::kInvalidArgument, "MuJoCo takes no file of this size");
    std::ranges::copy(
        text, static_cast<char*>(files_->filedata[Mujoco().find_file_vfs(files_.get(), kName)]));
  }
  ~FileInMemory() { Mujoco().delete_vfs(files_.get()); }
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;

  const mjVFS* files() const { return files_.get(); }

 private:
  std::unique_ptr<mjVFS> files_;
};

}  // namespace

MujocoModel::MujocoModel(const std::string& xml) {
  static std::mutex one_at_a_time;  // its compiler has tables of its own
  std::array<char, 1000> words{};
  const FileInMemory file(xml);
  {
    const std::scoped_lock lock(one_at_a_time);
    model.reset(Mujoco().load_xml(FileInMemory::kName, file.files(), words.data(),
                                  static_cast<int>(words.size())));
  }
  Require(model != nullptr, ErrorCode::kInvalidArgument,
          std::string("MuJoCo does not take the scene: ") + words.data());
  data.reset(Mujoco().make_data(model.get()));
  Require(data != nullptr, ErrorCode::kInvalidArgument, "MuJoCo has no memory for the scene");
}

MujocoData MujocoModel::CopyOfData() const {
  return MujocoData(Mujoco().copy_data(nullptr, model.get(), data.get()));
}

int MujocoModel::JointNamed(const std::string& name) const {
  const int id = Mujoco().name_to_id(model.get(), mjOBJ_JOINT, name.c_str());
  return id < 0 ? -1 : model->jnt_dofadr[id];
}

int MujocoModel::GeomNamed(const std::string& name) const {
  return Mujoco().name_to_id(model.get(), mjOBJ_GEOM, name.c_str());
}

}  // namespace doorforge::internal
