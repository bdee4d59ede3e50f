// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace doorforge::internal {

/// A handle of the HDF5 library, closed when it goes out of scope.
class Hdf5Handle {
 public:
  using Closer = int (*)(std::int64_t);
  Hdf5Handle(std::int64_t id, Closer closer) : id_(id), closer_(closer) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(other.id_), closer_(other.closer_) {
    other.id_ = -1;
  }
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) closer_(id_);
  }
  std::int64_t id() const { return id_; }

 private:
  std::int64_t id_;
  Closer closer_;
};

/// Writes an HDF5 file without times, so that equal content gives equal bytes. Groups on the way to
/// a path are made when they are needed. All members throw Error(kIo), naming the file.
class Hdf5Writer {
 public:
  /// Replaces the file if it is there.
  explicit Hdf5Writer(const std::filesystem::path& path);

  /// An array in C order. `type` is NumPy's: one of NpyHeader.
  void WriteArray(const std::string& path, std::string_view type,
                  const std::vector<std::size_t>& shape, std::span<const std::byte> bytes);
  /// One text of fixed length.
  void WriteText(const std::string& path, std::string_view text);
  /// A list of texts, padded with zeros to the longest.
  void WriteTexts(const std::string& path, const std::vector<std::string>& texts);
  void MakeGroup(const std::string& path);
  void SetAttribute(const std::string& object, const std::string& name, std::int64_t value);
  void SetAttribute(const std::string& object, const std::string& name, std::string_view text);
  void SetAttribute(const std::string& object, const std::string& name,
                    std::span<const double> values);

  /// Writes everything out; the file is closed. Throws if anything since the beginning was not
  /// written, as what the library kept back until a handle was closed.
  void Close();

 private:
  std::int64_t Checked(std::int64_t id, const std::string& what) const;
  void Write(const std::string& path, std::int64_t type, const std::vector<std::size_t>& shape,
             const void* bytes);
  struct AttributeType {
    std::int64_t element;
    std::int64_t space;
  };
  void Attach(const std::string& object, const std::string& name, AttributeType type,
              const void* bytes);

  std::string name_;
  Hdf5Handle links_;
  Hdf5Handle storage_;
  Hdf5Handle file_;
};

}  // namespace doorforge::internal
