// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "mutators.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* bytes, std::size_t size, std::size_t most);

namespace doorforge::fuzz {
namespace {

using Json = nlohmann::ordered_json;
using Random = std::minstd_rand;

std::size_t Below(Random& random, std::size_t count) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

std::string MutatedBytes(std::string bytes, std::size_t most) {
  const std::size_t size = bytes.size();
  bytes.resize(std::max(most, size));
  bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, bytes.size()));
  return bytes;
}

// ---- JSON ---------------------------------------------------------------------------------------

void Collect(Json& json, std::vector<Json*>& values) {
  values.push_back(&json);
  if (!json.is_structured()) return;
  for (Json& value : json) Collect(value, values);
}

Json Odd(Random& random) {
  static const std::vector<Json> odd = {nullptr,
                                        true,
                                        false,
                                        0,
                                        -1,
                                        1,
                                        2,
                                        1e-320,
                                        -0.0,
                                        0.5,
                                        1e6,
                                        1e300,
                                        1.7976931348623157e308,
                                        2147483647,
                                        2147483648LL,
                                        -2147483649LL,
                                        4294967296LL,
                                        9007199254740993LL,
                                        9223372036854775807LL,
                                        18446744073709551615ULL,
                                        "",
                                        ".",
                                        "..",
                                        "../x",
                                        "/",
                                        "a/b",
                                        "\u0000",
                                        std::string(300, 'x'),
                                        Json::array(),
                                        Json::object(),
                                        Json::array({0, 0, 0}),
                                        Json::array({Json::array()}),
                                        Json{{"a", 1}}};
  return odd[Below(random, odd.size())];
}

void ChangeNumber(Random& random, Json& value) {
  const double number = value.get<double>();
  if (value.is_number_float()) {
    const std::array<double, 6> others{
        -number,       number * 1e3, number / 1e3, number + 1, std::nextafter(number, 1e308),
        number * 1e150};
    value = others[Below(random, others.size())];
  } else {
    const auto integer = value.get<std::int64_t>();
    const std::int64_t by = std::int64_t{1} << Below(random, 62);
    value = static_cast<std::int64_t>(static_cast<std::uint64_t>(integer) +
                                      static_cast<std::uint64_t>(Below(random, 2) == 0 ? by : -by));
  }
}

void ChangeObject(Random& random, Json& object, const Json& other) {
  const auto at =
      std::next(object.begin(), static_cast<std::ptrdiff_t>(Below(random, object.size())));
  const std::string key = at.key();
  const Json value = at.value();
  switch (Below(random, 4)) {
    case 0:
      object.erase(key);
      break;
    case 1:
      object[key] = other;
      break;
    case 2:
      object.erase(key);
      object[MutatedBytes(key, key.size() + 4)] = value;
      break;
    default:
      object[key + "_"] = value;
  }
}

void ChangeArray(Random& random, Json& array, const Json& other) {
  const std::size_t at = Below(random, array.size());
  const std::size_t to = Below(random, array.size());
  const Json value = array[at];
  switch (Below(random, 5)) {
    case 0:
      array.erase(at);
      break;
    case 1:
      array.insert(array.begin() + static_cast<std::ptrdiff_t>(to), value);
      break;
    case 2:
      array[to] = other;
      break;
    case 3:
      std::swap(array[at], array[to]);
      break;
    default:
      array.push_back(other);
  }
}

void ChangeJson(Random& random, Json& whole) {
  std::vector<Json*> values;
  Collect(whole, values);
  Json& value = *values[Below(random, values.size())];
  const Json other = *values[Below(random, values.size())];
  if (Below(random, 4) == 0)
    value = Below(random, 2) == 0 ? Odd(random) : other;
  else if (value.is_number())
    ChangeNumber(random, value);
  else if (value.is_string())
    value = MutatedBytes(value.get<std::string>(), value.get<std::string>().size() + 8);
  else if (value.is_object() && !value.empty())
    ChangeObject(random, value, other);
  else if (value.is_array() && !value.empty())
    ChangeArray(random, value, other);
  else
    value = Odd(random);
}

std::string MutatedJson(const std::string& text, std::size_t most, Random& random) {
  if (Below(random, 20) != 0) {
    try {
      Json json = ParseJson(text, "input");
      for (std::size_t changes = 1 + Below(random, 3); changes > 0; --changes)
        ChangeJson(random, json);
      std::string changed = JsonText(json);
      if (changed.size() <= most) return changed;
    } catch (const Error&) {
      // changed as bytes
    }
  }
  return MutatedBytes(text, most);
}

// ---- formats with lengths and checksums ---------------------------------------------------------

template <class T>
T NumberAt(std::string_view bytes, std::size_t at) {
  T number = 0;
  if (at + sizeof number <= bytes.size()) std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

template <class T>
std::string BytesOf(T number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

void MendTar(std::string& tar) {
  constexpr std::size_t kBlock = 512;
  for (std::size_t at = 0; at + kBlock <= tar.size();) {
    const std::string_view header = std::string_view(tar).substr(at, kBlock);
    if (header.find_first_not_of('\0') == std::string_view::npos) return;
    unsigned sum = 8 * ' ';
    for (std::size_t i = 0; i < kBlock; ++i)
      if (i < 148 || i >= 156) sum += static_cast<unsigned char>(header[i]);
    std::array<char, 9> digits{};
    std::snprintf(digits.data(), digits.size(), "%06o", sum);
    std::size_t size = 0;
    std::from_chars(header.data() + 124, header.data() + 136, size, 8);
    std::memcpy(tar.data() + at + 148, digits.data(), 7);
    tar[at + 155] = ' ';
    if (size > tar.size()) return;
    at += kBlock + (size + kBlock - 1) / kBlock * kBlock;
  }
}

std::uint32_t PngCrc(std::string_view bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xedb88320 : 0);
  }
  return ~crc;
}

void MendPng(std::string& png) {
  for (std::size_t at = 8; at + 12 <= png.size();) {
    const std::size_t size = __builtin_bswap32(NumberAt<std::uint32_t>(png, at));
    if (size > png.size() - at - 12) return;
    const std::string crc =
        BytesOf(__builtin_bswap32(PngCrc(std::string_view(png).substr(at + 4, size + 4))));
    png.replace(at + 8 + size, 4, crc);
    at += size + 12;
  }
}

/// A text of JSON and what lies behind it.
struct JsonAndData {
  std::string json;
  std::string data;

  void Change(std::size_t most, Random& random) {
    if (Below(random, 3) == 0) {
      data = MutatedBytes(data, most > json.size() ? most - json.size() : 0);
    } else {
      json = MutatedJson(json, most > data.size() ? most - data.size() : 1, random);
    }
  }
};

std::string MutatedTensors(std::string_view bytes, std::size_t most, Random& random) {
  const std::size_t length =
      std::min<std::size_t>(NumberAt<std::uint64_t>(bytes, 0), bytes.size() - 8);
  JsonAndData parts{std::string(bytes.substr(8, length)), std::string(bytes.substr(8 + length))};
  parts.Change(most - 8, random);
  return BytesOf(std::uint64_t{parts.json.size()}) + parts.json + parts.data;
}

std::string MutatedGlb(std::string_view bytes, std::size_t most, Random& random) {
  constexpr std::size_t kHead = 20;
  constexpr std::uint32_t kJsonChunk = 0x4e4f534a;
  constexpr std::uint32_t kDataChunk = 0x004e4942;
  const std::size_t length =
      std::min<std::size_t>(NumberAt<std::uint32_t>(bytes, 12), bytes.size() - kHead);
  JsonAndData parts{std::string(bytes.substr(kHead, length)), ""};
  if (bytes.size() >= kHead + length + 8) parts.data = bytes.substr(kHead + length + 8);
  parts.Change(most - kHead - 16, random);
  parts.json.resize((parts.json.size() + 3) / 4 * 4, ' ');
  parts.data.resize((parts.data.size() + 3) / 4 * 4, '\0');
  const auto size = [](std::size_t number) { return BytesOf(static_cast<std::uint32_t>(number)); };
  std::string chunks = size(parts.json.size()) + BytesOf(kJsonChunk) + parts.json;
  if (!parts.data.empty()) chunks += size(parts.data.size()) + BytesOf(kDataChunk) + parts.data;
  return "glTF" + BytesOf(std::uint32_t{2}) + size(12 + chunks.size()) + chunks;
}

std::string Mutated(Shape shape, const std::string& bytes, std::size_t most, Random& random) {
  if (shape == Shape::kJson) return MutatedJson(bytes, most, random);
  const bool blind = Below(random, 20) == 0;
  if (shape == Shape::kTensors && !blind && bytes.size() >= 8 && most > 16)
    return MutatedTensors(bytes, most, random);
  if (shape == Shape::kGlb && !blind && bytes.size() >= 20 && most > 64)
    return MutatedGlb(bytes, most, random);
  std::string changed = MutatedBytes(bytes, most);
  if (shape == Shape::kTar && !blind) MendTar(changed);
  if (shape == Shape::kPng && !blind) MendPng(changed);
  return changed;
}

}  // namespace

std::size_t Mutate(Shape shape, std::span<std::uint8_t> buffer, std::size_t size, unsigned seed) {
  if (shape == Shape::kBytes) return LLVMFuzzerMutate(buffer.data(), size, buffer.size());
  Random random(seed);
  const std::string changed =
      Mutated(shape, std::string(reinterpret_cast<const char*>(buffer.data()), size), buffer.size(),
              random);
  const std::size_t kept = std::min(changed.size(), buffer.size());
  std::copy_n(changed.begin(), kept, buffer.begin());
  return kept;
}

}  // namespace doorforge::fuzz
