// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "message.h"

#include <bit>
#include <cstring>
#include <utility>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

constexpr int kMostLevels = 32;
constexpr int kMostValues = 100'000;

[[noreturn]] void Refuse(const std::string& problem) {
  throw Error(ErrorCode::kFormat, "not a message of MessagePack: " + problem);
}

// ---- writing ------------------------------------------------------------------------------------

class Writer {
 public:
  std::string text;

  void Write(const Value& value) {
    std::visit([this](const auto& content) { Put(content); }, value.content);
  }

 private:
  template <class T>
  void Big(char tag, T number) {
    text += tag;
    for (int shift = 8 * (static_cast<int>(sizeof(T)) - 1); shift >= 0; shift -= 8)
      text += static_cast<char>((number >> shift) & 0xff);
  }
  void Byte(unsigned value) { text += static_cast<char>(value); }
  template <class Size>
  void Head(unsigned char tag, Size size) {
    Big(static_cast<char>(tag), static_cast<std::uint32_t>(size));
  }

  void Put(std::monostate) { Byte(0xc0); }
  void Put(bool value) { Byte(value ? 0xc3 : 0xc2); }
  void Put(std::int64_t value) { Big(static_cast<char>(0xd3), static_cast<std::uint64_t>(value)); }
  void Put(double value) { Big(static_cast<char>(0xcb), std::bit_cast<std::uint64_t>(value)); }
  void Put(const std::string& value) {
    Head(0xdb, value.size());
    text += value;
  }
  void PutBytes(const std::string& value) {
    Head(0xc6, value.size());
    text += value;
  }
  void Put(const Value::Bytes& value) { PutBytes(value.content); }
  void Put(const Value::List& list) {
    Head(0xdd, list.size());
    for (const Value& value : list) Write(value);
  }
  void Put(const Value::Map& map) {
    Head(0xdf, map.size());
    for (const auto& [key, value] : map) {
      Put(key);
      Write(value);
    }
  }
  void Put(const NumpyArray& array) {
    Head(0xdf, 4U);
    PutBytes("__ndarray__");
    Put(true);
    PutBytes("data");
    PutBytes(array.bytes);
    PutBytes("dtype");
    Put(array.dtype);
    PutBytes("shape");
    Head(0xdd, array.shape.size());
    for (const std::int64_t length : array.shape) Put(length);
  }
};

// ---- reading ------------------------------------------------------------------------------------

class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  Value ReadAll() {
    Value value = Read(0);
    if (!rest_.empty()) Refuse(std::to_string(rest_.size()) + " bytes behind its end");
    return value;
  }

 private:
  std::string_view Take(std::uint64_t size) {
    if (size > rest_.size())
      Refuse("it ends " + std::to_string(size - rest_.size()) + " bytes too early");
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }
  std::uint64_t Number(std::size_t size) {
    std::uint64_t number = 0;
    for (const char byte : Take(size)) number = number << 8 | static_cast<unsigned char>(byte);
    return number;
  }
  std::string Text(std::uint64_t size) { return std::string(Take(size)); }

  Value Read(int level) {
    if (level > kMostLevels) Refuse("it nests too deep");
    // a value takes a hundred times the byte that says it
    if (++values_ > kMostValues) Refuse("more than " + std::to_string(kMostValues) + " values");
    const auto tag = static_cast<unsigned>(Number(1));
    if (tag <= 0x7f) return {std::int64_t{tag}};
    if (tag <= 0x8f) return ReadMap(tag & 0x0f, level);
    if (tag <= 0x9f) return ReadList(tag & 0x0f, level);
    if (tag <= 0xbf) return {Text(tag & 0x1f)};
    if (tag >= 0xe0) return {static_cast<std::int64_t>(static_cast<std::int8_t>(tag))};
    const auto power = [tag](unsigned first) { return std::size_t{1} << (tag - first); };
    switch (tag) {
      case 0xc0:
        return {};
      case 0xc2:
      case 0xc3:
        return {tag == 0xc3};
      case 0xc4:
      case 0xc5:
      case 0xc6:
        return {Value::Bytes{Text(Number(power(0xc4)))}};
      case 0xca:
        return {static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(Number(4))))};
      case 0xcb:
        return {std::bit_cast<double>(Number(8))};
      case 0xcc:
      case 0xcd:
      case 0xce:
      case 0xcf:
        return {static_cast<std::int64_t>(Number(power(0xcc)))};
      case 0xd0:
      case 0xd1:
      case 0xd2:
      case 0xd3:
        return {Signed(power(0xd0))};
      case 0xd9:
      case 0xda:
      case 0xdb:
        return {Text(Number(power(0xd9)))};
      case 0xdc:
      case 0xdd:
        return ReadList(Number(2 * power(0xdc)), level);
      case 0xde:
      case 0xdf:
        return ReadMap(Number(2 * power(0xde)), level);
      default:
        Refuse("a type that numbers, texts and arrays do not need (" + std::to_string(tag) + ")");
    }
  }

  std::int64_t Signed(std::size_t size) {
    const auto unused = static_cast<int>(64 - 8 * size);
    return static_cast<std::int64_t>(Number(size) << unused) >> unused;
  }

  void RequireRoom(std::uint64_t count, std::uint64_t least) const {
    if (count > rest_.size() / least) Refuse("it says more elements than it has bytes");
  }

  Value ReadList(std::uint64_t count, int level) {
    RequireRoom(count, 1);
    Value::List list;
    for (std::uint64_t i = 0; i < count; ++i) list.push_back(Read(level + 1));
    return {std::move(list)};
  }

  Value ReadMap(std::uint64_t count, int level) {
    RequireRoom(count, 2);
    Value::Map map;
    for (std::uint64_t i = 0; i < count; ++i) {
      Value key = Read(level + 1);
      std::string name;
      if (auto* text = std::get_if<std::string>(&key.content))
        name = std::move(*text);
      else if (auto* bytes = std::get_if<Value::Bytes>(&key.content))
        name = std::move(bytes->content);
      else
        Refuse("a map with a key that is no text");
      map[std::move(name)] = Read(level + 1);
    }
    return Array(std::move(map));
  }

  static std::string TextOf(const Value* value) {
    if (value == nullptr) return "";
    if (const auto* text = value->As<std::string>()) return *text;
    if (const auto* bytes = value->As<Value::Bytes>()) return bytes->content;
    return "";
  }

  // the array that a map stands for, or the map
  static Value Array(Value::Map map) {
    if (const auto scalar = map.find("__npgeneric__"); scalar != map.end())
      return std::move(map["data"]);
    if (!map.contains("__ndarray__")) return {std::move(map)};
    Value whole{std::move(map)};
    NumpyArray array;
    array.dtype = TextOf(whole.Find("dtype"));
    array.bytes = TextOf(whole.Find("data"));
    const Value* shape = whole.Find("shape");
    const auto* lengths = shape == nullptr ? nullptr : shape->As<Value::List>();
    if (lengths == nullptr) Refuse("an array without a shape");
    for (const Value& length : *lengths) {
      const auto* number = length.As<std::int64_t>();
      if (number == nullptr || *number < 0) Refuse("an array with a length that is none");
      array.shape.push_back(*number);
    }
    return {std::move(array)};
  }

  std::string_view rest_;
  int values_ = 0;
};

template <class T>
std::vector<double> NumbersOf(const std::string& bytes) {
  std::vector<double> numbers(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    T number;
    std::memcpy(&number, bytes.data() + i * sizeof(T), sizeof(T));
    numbers[i] = static_cast<double>(number);
  }
  return numbers;
}

struct Kind {
  const char* dtype;
  std::size_t size;
  std::vector<double> (*read)(const std::string&);
};

constexpr Kind kKinds[] = {
    {"<f4", 4, NumbersOf<float>},        {"<f8", 8, NumbersOf<double>},
    {"|i1", 1, NumbersOf<std::int8_t>},  {"|u1", 1, NumbersOf<std::uint8_t>},
    {"<i2", 2, NumbersOf<std::int16_t>}, {"<u2", 2, NumbersOf<std::uint16_t>},
    {"<i4", 4, NumbersOf<std::int32_t>}, {"<u4", 4, NumbersOf<std::uint32_t>},
    {"<i8", 8, NumbersOf<std::int64_t>}, {"<u8", 8, NumbersOf<std::uint64_t>},
};

}  // namespace

std::vector<double> NumpyArray::Numbers(const std::string& name) const {
  for (const Kind& kind : kKinds) {
    if (dtype != kind.dtype) continue;
    std::size_t count = 1;
    for (const std::int64_t length : shape) {
      if (length != 0 && count > bytes.size() / static_cast<std::size_t>(length))
        throw Error(ErrorCode::kFormat, name + ": its shape means more than its bytes hold");
      count *= static_cast<std::size_t>(length);
    }
    if (count * kind.size != bytes.size())
      throw Error(ErrorCode::kFormat, name + ": " + std::to_string(bytes.size()) +
                                          " bytes do not fit its shape and dtype " + dtype);
    return kind.read(bytes);
  }
  throw Error(ErrorCode::kFormat,
              name + ": dtype \"" + dtype + "\", expected float32 (\"<f4\") or float64 (\"<f8\")");
}

namespace {

template <class T>
NumpyArray CopyOf(const char* dtype, const T* values, std::vector<std::int64_t> shape) {
  std::size_t count = 1;
  for (const std::int64_t length : shape) count *= static_cast<std::size_t>(length);
  NumpyArray array{dtype, std::move(shape), std::string(count * sizeof(T), '\0')};
  if (count > 0) std::memcpy(array.bytes.data(), values, array.bytes.size());
  return array;
}

}  // namespace

NumpyArray ArrayOf(const float* values, std::vector<std::int64_t> shape) {
  return CopyOf("<f4", values, std::move(shape));
}

NumpyArray ArrayOf(const double* values, std::vector<std::int64_t> shape) {
  return CopyOf("<f8", values, std::move(shape));
}

const Value* Value::Find(const std::string& key) const {
  const auto* map = As<Map>();
  if (map == nullptr) return nullptr;
  const auto found = map->find(key);
  return found == map->end() ? nullptr : &found->second;
}

std::string Packed(const Value& value) {
  Writer writer;
  writer.Write(value);
  return std::move(writer.text);
}

Value Unpacked(std::string_view message) { return Reader(message).ReadAll(); }

}  // namespace doorforge::internal
