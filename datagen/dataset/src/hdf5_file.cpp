// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "hdf5_file.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include <hdf5.h>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

std::int64_t TypeNamed(std::string_view name) {
  if (name == "<f4") return H5T_IEEE_F32LE;
  if (name == "<f8") return H5T_IEEE_F64LE;
  if (name == "<i8") return H5T_STD_I64LE;
  if (name == "<u2") return H5T_STD_U16LE;
  if (name == "|i1") return H5T_STD_I8LE;
  if (name == "|u1") return H5T_STD_U8LE;
  throw Error(ErrorCode::kInvalidArgument, "no HDF5 type for " + std::string(name));
}

std::int64_t LinkSettings() {
  const hid_t id = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(id, 1);
  return id;
}

std::int64_t StorageSettings() {
  const hid_t id = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(id, 0);
  return id;
}

Hdf5Handle TextType(std::size_t length) {
  const hid_t id = H5Tcopy(H5T_C_S1);
  H5Tset_size(id, std::max<std::size_t>(length, 1));
  H5Tset_strpad(id, H5T_STR_NULLPAD);
  H5Tset_cset(id, H5T_CSET_UTF8);
  return {id, H5Tclose};
}

// Whether a function of HDF5 has failed in this thread since a writer began, and the system's
// reason. What was written is often handed to the system when a handle is closed, of whose failure
// nobody else would hear.
struct Failure {
  bool is_there = false;
  int error = 0;  // 0: none was given
};
thread_local Failure first_failure;

// The library tells the system's reason in the words of its description alone.
herr_t KeepReason(unsigned, const H5E_error2_t* entry, void*) {
  constexpr std::string_view kBefore = "errno = ";
  const std::string_view told = entry->desc == nullptr ? "" : entry->desc;
  const std::size_t at = told.find(kBefore);
  if (at != std::string_view::npos && first_failure.error == 0)
    first_failure.error = std::atoi(told.data() + at + kBefore.size());
  return 0;
}

herr_t NoteFailure(hid_t stack, void*) {
  first_failure.is_there = true;
  H5Ewalk2(stack, H5E_WALK_UPWARD, KeepReason, nullptr);
  return 0;
}

// Instead of the library's own stack of errors on standard error. Everything is closed by its
// handle: what the library does when the program ends may end it by a signal after a failure.
void NoteFailures() {
  H5dont_atexit();
  first_failure = {};
  H5Eset_auto2(H5E_DEFAULT, NoteFailure, nullptr);
}

}  // namespace

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path)
    : name_(path.string()),
      links_((NoteFailures(), LinkSettings()), H5Pclose),
      storage_(StorageSettings(), H5Pclose),
      file_(H5Fcreate(name_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose) {
  Checked(file_.id(), "cannot be created");
}

std::int64_t Hdf5Writer::Checked(std::int64_t id, const std::string& what) const {
  if (id >= 0 && !first_failure.is_there) return id;
  const int error = first_failure.error;
  const std::string reason = error == 0 ? "" : ": " + std::generic_category().message(error);
  throw Error(ErrorCode::kIo,
              name_ + ": " + what + reason + "; is the disk full or the folder read-only?");
}

void Hdf5Writer::Write(const std::string& path, std::int64_t type,
                       const std::vector<std::size_t>& shape, const void* bytes) {
  std::vector<hsize_t> lengths(shape.begin(), shape.end());
  const Hdf5Handle space(
      shape.empty() ? H5Screate(H5S_SCALAR)
                    : H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr),
      H5Sclose);
  Checked(space.id(), "no space for " + path);
  const Hdf5Handle array(H5Dcreate2(file_.id(), path.c_str(), type, space.id(), links_.id(),
                                    storage_.id(), H5P_DEFAULT),
                         H5Dclose);
  Checked(array.id(), path + " cannot be created");
  Checked(H5Dwrite(array.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes),
          path + " cannot be written");
}

void Hdf5Writer::WriteArray(const std::string& path, std::string_view type,
                            const std::vector<std::size_t>& shape,
                            std::span<const std::byte> bytes) {
  Write(path, TypeNamed(type), shape, bytes.data());
}

void Hdf5Writer::WriteText(const std::string& path, std::string_view text) {
  const Hdf5Handle type = TextType(text.size());
  const std::string padded = text.empty() ? std::string(1, '\0') : std::string(text);
  Write(path, type.id(), {}, padded.data());
}

void Hdf5Writer::WriteTexts(const std::string& path, const std::vector<std::string>& texts) {
  std::size_t longest = 1;
  for (const std::string& text : texts) longest = std::max(longest, text.size());
  std::string padded(longest * texts.size(), '\0');
  for (std::size_t i = 0; i < texts.size(); ++i)
    std::copy(texts[i].begin(), texts[i].end(),
              padded.begin() + static_cast<std::ptrdiff_t>(i * longest));
  const Hdf5Handle type = TextType(longest);
  Write(path, type.id(), {texts.size()}, padded.data());
}

void Hdf5Writer::MakeGroup(const std::string& path) {
  const Hdf5Handle group(
      H5Gcreate2(file_.id(), path.c_str(), links_.id(), H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  Checked(group.id(), path + " cannot be created");
}

void Hdf5Writer::Attach(const std::string& object, const std::string& name, AttributeType type,
                        const void* bytes) {
  const Hdf5Handle attribute(
      H5Acreate_by_name(file_.id(), object.c_str(), name.c_str(), type.element, type.space,
                        H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  Checked(attribute.id(), "attribute " + name + " of " + object + " cannot be created");
  Checked(H5Awrite(attribute.id(), type.element, bytes),
          "attribute " + name + " of " + object + " cannot be written");
}

void Hdf5Writer::SetAttribute(const std::string& object, const std::string& name,
                              std::int64_t value) {
  const Hdf5Handle one(H5Screate(H5S_SCALAR), H5Sclose);
  Attach(object, name, {H5T_STD_I64LE, one.id()}, &value);
}

void Hdf5Writer::SetAttribute(const std::string& object, const std::string& name,
                              std::span<const double> values) {
  const hsize_t length = values.size();
  const Hdf5Handle many(H5Screate_simple(1, &length, nullptr), H5Sclose);
  Attach(object, name, {H5T_IEEE_F64LE, many.id()}, values.data());
}

// Its length is variable: h5py gives such text as str, and robomimic expects that.
void Hdf5Writer::SetAttribute(const std::string& object, const std::string& name,
                              std::string_view text) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  const std::string terminated(text);
  const char* pointer = terminated.c_str();
  const Hdf5Handle one(H5Screate(H5S_SCALAR), H5Sclose);
  Attach(object, name, {type.id(), one.id()}, &pointer);
}

void Hdf5Writer::Close() {
  Checked(H5Fflush(file_.id(), H5F_SCOPE_GLOBAL), "cannot be written out");
  { const Hdf5Handle closing = std::move(file_); }
  Checked(0, "cannot be closed");
}

}  // namespace doorforge::internal
