// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "torch_archive/torch_numbers.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <span>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/schemas/npy.h"

#include "torch_archive/tensor_pickle.h"
#include "torch_archive/zip_members.h"

namespace doorforge::internal {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::uint64_t kMaxBytes = 1 << 20;
constexpr std::string_view kPickle = "/data.pkl";

[[noreturn]] void Fail(const std::string& name, const std::string& problem) {
  throw Error(ErrorCode::kFormat, name + ": " + problem);
}

// every multi-index of `size` in row-major order, as an offset by `stride`
std::vector<std::int64_t> Offsets(const PickledTensor& tensor, std::size_t max_count,
                                  const std::string& name) {
  std::vector<std::int64_t> offsets = {tensor.offset};
  for (std::size_t axis = 0; axis < tensor.size.size(); ++axis) {
    std::vector<std::int64_t> longer;
    if (tensor.size[axis] < 0 || static_cast<std::uint64_t>(tensor.size[axis]) > max_count ||
        offsets.size() * static_cast<std::size_t>(tensor.size[axis]) > max_count)
      Fail(name, "holds more than " + std::to_string(max_count) + " numbers");
    for (const std::int64_t offset : offsets) {
      for (std::int64_t i = 0; i < tensor.size[axis]; ++i)
        longer.push_back(offset + i * tensor.stride[axis]);
    }
    offsets = std::move(longer);
  }
  return offsets;
}

template <class T>
double ElementAt(std::string_view elements, std::int64_t offset, const std::string& name) {
  const auto count = static_cast<std::int64_t>(elements.size() / sizeof(T));
  if (offset < 0 || offset >= count) Fail(name, "its tensor reaches beyond its numbers");
  T element;
  std::memcpy(&element, elements.data() + static_cast<std::size_t>(offset) * sizeof(T), sizeof(T));
  return static_cast<double>(element);
}

double ElementOf(const PickledTensor& tensor, std::string_view elements, std::int64_t offset,
                 const std::string& name) {
  if (tensor.element == "FloatStorage") return ElementAt<float>(elements, offset, name);
  if (tensor.element == "DoubleStorage") return ElementAt<double>(elements, offset, name);
  if (tensor.element == "IntStorage") return ElementAt<std::int32_t>(elements, offset, name);
  if (tensor.element == "LongStorage") return ElementAt<std::int64_t>(elements, offset, name);
  Fail(name, "elements of " + tensor.element + "; allowed are float, double, int and long");
}

std::vector<double> FromArchive(std::string_view bytes, const std::string& name,
                                std::size_t max_count) {
  const auto members = ZipMembers(bytes, name);
  for (const auto& [member, pickle] : members) {
    if (!member.ends_with(kPickle)) continue;
    const PickledTensor tensor = ParseTensorPickle(pickle, name);
    const std::string folder = member.substr(0, member.size() - kPickle.size());
    const auto elements = members.find(folder + "/data/" + tensor.key);
    if (elements == members.end()) Fail(name, "the tensor's numbers are missing");
    std::vector<double> numbers;
    for (const std::int64_t offset : Offsets(tensor, max_count, name))
      numbers.push_back(ElementOf(tensor, elements->second, offset, name));
    return numbers;
  }
  Fail(name, "an archive without data.pkl; expected a file that torch.save wrote");
}

template <class T>
std::vector<double> FromNpyOf(std::string_view elements) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < elements.size() / sizeof(T); ++i)
    numbers.push_back(ElementAt<T>(elements, static_cast<std::int64_t>(i), ""));
  return numbers;
}

std::vector<double> FromNpy(std::string_view bytes, const std::string& name,
                            std::size_t max_count) {
  const NpyHeader header = ParseNpyHeader(std::as_bytes(std::span(bytes)), name);
  const std::string_view elements = bytes.substr(header.data_offset);
  if (elements.size() > max_count * sizeof(double))
    Fail(name, "holds more than " + std::to_string(max_count) + " numbers");
  if (header.type == "<f4") return FromNpyOf<float>(elements);
  if (header.type == "<f8") return FromNpyOf<double>(elements);
  Fail(name, "elements of type " + header.type + "; allowed are <f4 and <f8");
}

}  // namespace

std::vector<double> ParseTorchNumbers(std::string_view bytes, const std::string& name,
                                      std::size_t max_count) {
  std::vector<double> numbers = bytes.starts_with("\x93NUMPY")
                                    ? FromNpy(bytes, name, max_count)
                                    : FromArchive(bytes, name, max_count);
  for (const double number : numbers) {
    if (!std::isfinite(number)) Fail(name, "holds a number that is not finite");
  }
  return numbers;
}

std::vector<double> ReadTorchNumbers(const std::filesystem::path& path, std::size_t max_count) {
  return ParseTorchNumbers(ReadFile(path, kMaxBytes), path.string(), max_count);
}

}  // namespace doorforge::internal
