// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/safetensors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kTensorTypes = {TensorType::kF64, TensorType::kF32, TensorType::kF16,
                                     TensorType::kI64, TensorType::kU8};
constexpr std::uint64_t kLengthBytes = 8;
constexpr std::uint64_t kMostHeaderBytes = 100'000'000;  // the format's own limit
constexpr std::size_t kTensorAlignment = 64;
constexpr const char* kMetadata = "__metadata__";

[[noreturn]] void Refuse(const std::string& path, const std::string& problem) {
  throw Error(ErrorCode::kFormat, path + ": not a valid safetensors file: " + problem);
}

// Product of the lengths; nothing if it does not fit.
std::optional<std::uint64_t> Product(const std::vector<std::uint64_t>& shape) {
  std::uint64_t product = 1;
  for (const std::uint64_t length : shape) {
    if (__builtin_mul_overflow(product, length, &product)) return std::nullopt;
  }
  return product;
}

std::uint64_t ReadLength(std::string_view bytes, const std::string& path) {
  if (bytes.size() < kLengthBytes) Refuse(path, "shorter than 8 bytes");
  std::uint64_t length = 0;
  for (std::size_t i = kLengthBytes; i-- > 0;)
    length = length << 8U | static_cast<unsigned char>(bytes[i]);
  if (length > kMostHeaderBytes || length > bytes.size() - kLengthBytes)
    Refuse(path, "header of " + std::to_string(length) + " bytes in a file of " +
                     std::to_string(bytes.size()));
  return length;
}

// Refuses what the JSON library would let pass: a name given twice, deep nesting, all that follows
// a zero byte.
Json ParseHeader(std::string_view text, const std::string& path) {
  if (text.find('\0') != std::string_view::npos) Refuse(path, "the header has a zero byte");
  if (text.empty() || text.front() != '{') Refuse(path, "the header does not begin with {");
  std::vector<std::set<std::string>> names;
  std::string problem;
  const auto check = [&](int depth, Json::parse_event_t event, Json& value) {
    if (depth > 4) problem = "the header nests too deeply";
    if (event == Json::parse_event_t::object_start) names.emplace_back();
    if (event == Json::parse_event_t::object_end) names.pop_back();
    if (event == Json::parse_event_t::key &&
        !names.back().insert(value.get_ref<const std::string&>()).second)
      problem = "\"" + value.get_ref<const std::string&>() + "\" occurs twice";
    return problem.empty();
  };
  Json header;
  try {
    header = Json::parse(text.begin(), text.end(), check);
  } catch (const nlohmann::json::exception&) {
    Refuse(path, "the header is not JSON");
  }
  if (!problem.empty()) Refuse(path, problem);
  if (!header.is_object()) Refuse(path, "the header is not an object");
  return header;
}

std::vector<std::uint64_t> Unsigned(const Json& json, const std::string& what,
                                    const std::string& path) {
  if (!json.is_array()) Refuse(path, what + " is not an array");
  std::vector<std::uint64_t> numbers;
  for (const Json& number : json) {
    if (!number.is_number_unsigned()) Refuse(path, what + " holds something else than counts");
    numbers.push_back(number.get<std::uint64_t>());
  }
  return numbers;
}

TensorType TypeNamed(const Json& json, const std::string& what, const std::string& path) {
  for (const TensorType type : kTensorTypes) {
    if (json == NameOf(type)) return type;
  }
  Refuse(path, what + " has an element type other than F64, F32, F16, I64 and U8");
}

struct ByteRange {
  std::uint64_t begin;
  std::uint64_t end;
};

struct TensorEntry {
  std::string name;
  Tensor tensor;
  ByteRange range;
};

TensorEntry ParseEntry(const std::string& name, const Json& json, std::uint64_t data_size,
                       const std::string& path) {
  const std::string what = "tensor \"" + name + "\"";
  if (!json.is_object() || json.size() != 3 || !json.contains("dtype") || !json.contains("shape") ||
      !json.contains("data_offsets"))
    Refuse(path, what + " does not have exactly dtype, shape and data_offsets");
  TensorEntry entry{name, {}, {}};
  entry.tensor.type = TypeNamed(json["dtype"], what, path);
  entry.tensor.shape = Unsigned(json["shape"], what + ".shape", path);
  const auto offsets = Unsigned(json["data_offsets"], what + ".data_offsets", path);
  if (offsets.size() != 2 || offsets[0] > offsets[1] || offsets[1] > data_size)
    Refuse(path, what + " lies outside the data");
  entry.range = {offsets[0], offsets[1]};
  const auto count = Product(entry.tensor.shape);
  const std::uint64_t size = ElementSize(entry.tensor.type);
  if (!count || *count > data_size / size || *count * size != offsets[1] - offsets[0])
    Refuse(path, what + " has a shape that does not fit its data");
  return entry;
}

std::map<std::string, std::string> ParseMetadata(const Json& json, const std::string& path) {
  if (!json.is_object()) Refuse(path, "__metadata__ is not an object");
  std::map<std::string, std::string> metadata;
  for (const auto& [key, value] : json.items()) {
    if (!value.is_string()) Refuse(path, "__metadata__ holds something else than text");
    metadata[key] = value.get<std::string>();
  }
  return metadata;
}

}  // namespace

std::string_view NameOf(TensorType type) {
  constexpr std::array<std::string_view, 5> kNames = {"F64", "F32", "F16", "I64", "U8"};
  return kNames.at(static_cast<std::size_t>(type));
}

std::size_t ElementSize(TensorType type) {
  constexpr std::array<std::size_t, 5> kSizes = {8, 4, 2, 8, 1};
  return kSizes.at(static_cast<std::size_t>(type));
}

std::string EncodeTensors(const TensorFile& file) {
  std::vector<const std::pair<const std::string, Tensor>*> order;
  for (const auto& entry : file.tensors) order.push_back(&entry);
  std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) {
    return ElementSize(a->second.type) > ElementSize(b->second.type);
  });

  Json header = Json::object();
  if (!file.metadata.empty()) header[kMetadata] = file.metadata;
  std::uint64_t offset = 0;
  for (const auto* entry : order) {
    const Tensor& tensor = entry->second;
    Require(entry->first != kMetadata, ErrorCode::kInvalidArgument,
            "a tensor may not be called __metadata__");
    Json& json = header[entry->first];
    json["dtype"] = NameOf(tensor.type);
    json["shape"] = tensor.shape;
    json["data_offsets"] = {offset, offset + tensor.bytes.size()};
    offset += tensor.bytes.size();
  }
  std::string text = JsonText(header);
  text.resize(
      (kLengthBytes + text.size() + kTensorAlignment - 1) / kTensorAlignment * kTensorAlignment -
          kLengthBytes,
      ' ');

  std::string bytes;
  bytes.reserve(kLengthBytes + text.size() + offset);
  for (std::size_t i = 0; i < kLengthBytes; ++i)
    bytes.push_back(static_cast<char>(text.size() >> (8 * i) & 0xFFU));
  bytes += text;
  for (const auto* entry : order) bytes += entry->second.bytes;
  return bytes;
}

TensorFile DecodeTensors(std::string_view bytes, const std::string& path) {
  const std::uint64_t header_size = ReadLength(bytes, path);
  const Json header = ParseHeader(bytes.substr(kLengthBytes, header_size), path);
  const std::string_view data = bytes.substr(kLengthBytes + header_size);
  TensorFile file;
  std::vector<TensorEntry> entries;
  for (const auto& [name, json] : header.items()) {
    if (name == kMetadata)
      file.metadata = ParseMetadata(json, path);
    else
      entries.push_back(ParseEntry(name, json, data.size(), path));
  }
  std::stable_sort(entries.begin(), entries.end(), [](const TensorEntry& a, const TensorEntry& b) {
    return std::pair(a.range.begin, a.range.end) < std::pair(b.range.begin, b.range.end);
  });
  std::uint64_t covered = 0;
  for (TensorEntry& entry : entries) {
    if (entry.range.begin != covered)
      Refuse(path, "the data have a gap or an overlap before tensor \"" + entry.name + "\"");
    covered = entry.range.end;
    entry.tensor.bytes = data.substr(entry.range.begin, entry.range.end - entry.range.begin);
    file.tensors.emplace(entry.name, std::move(entry.tensor));
  }
  if (covered != data.size())
    Refuse(path, std::to_string(data.size() - covered) + " bytes at the end belong to no tensor");
  return file;
}

TensorFile ReadTensors(const std::filesystem::path& path) {
  return DecodeTensors(ReadFile(path), path.string());
}

const Tensor& TensorNamed(const TensorFile& file, const std::string& name,
                          const std::string& path) {
  const auto found = file.tensors.find(name);
  if (found == file.tensors.end())
    throw Error(ErrorCode::kFormat, path + ": holds no tensor \"" + name + "\"");
  return found->second;
}

Tensor MakeHalfTensor(std::span<const float> values, std::vector<std::uint64_t> shape) {
  std::vector<Eigen::half> halves(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    halves[i] = Eigen::half(values[i]);
    Require(std::isfinite(static_cast<float>(halves[i])) || !std::isfinite(values[i]),
            ErrorCode::kInvalidArgument, "a number is too large for half precision");
  }
  return internal::MakeTensor(TensorType::kF16, std::as_bytes(std::span(halves)), std::move(shape));
}

std::vector<float> FloatsOf(const Tensor& tensor, const std::vector<std::uint64_t>& shape,
                            const std::string& path) {
  if (tensor.type != TensorType::kF16) return ValuesOf<float>(tensor, shape, path);
  internal::CheckTensor(tensor, TensorType::kF16, shape, path);
  std::vector<Eigen::half> halves(tensor.bytes.size() / sizeof(Eigen::half));
  internal::CopyBytes(tensor.bytes, halves.data());
  return {halves.begin(), halves.end()};
}

namespace internal {

std::uint64_t ElementCount(const std::vector<std::uint64_t>& shape) {
  const auto count = Product(shape);
  Require(count.has_value(), ErrorCode::kInvalidArgument, "a tensor's shape is too large");
  return *count;
}

Tensor MakeTensor(TensorType type, std::span<const std::byte> bytes,
                  std::vector<std::uint64_t> shape) {
  const std::uint64_t count = ElementCount(shape);
  Require(count * ElementSize(type) == bytes.size(), ErrorCode::kInvalidArgument,
          "a tensor's shape must fit its values");
  Tensor tensor{type, std::move(shape), std::string(bytes.size(), '\0')};
  if (!bytes.empty()) std::memcpy(tensor.bytes.data(), bytes.data(), bytes.size());
  return tensor;
}

void CheckTensor(const Tensor& tensor, TensorType type, const std::vector<std::uint64_t>& shape,
                 const std::string& path) {
  const auto describe = [](TensorType t, const std::vector<std::uint64_t>& lengths) {
    std::string text(NameOf(t));
    for (std::size_t i = 0; i < lengths.size(); ++i)
      text += (i == 0 ? " " : " x ") + std::to_string(lengths[i]);
    return text;
  };
  if (tensor.type != type || tensor.shape != shape)
    throw Error(ErrorCode::kFormat, path + ": found a tensor " +
                                        describe(tensor.type, tensor.shape) + ", expected " +
                                        describe(type, shape));
}

void CopyBytes(std::string_view from, void* to) {
  if (!from.empty()) std::memcpy(to, from.data(), from.size());
}

}  // namespace internal
}  // namespace doorforge
