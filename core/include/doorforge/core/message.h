// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

// Values that one process sends another through a pipe. Both are of one build on one machine, so
// numbers go as they lie in memory. A struct says what it is made of once, for both ends:
//
//     template <class Message>
//     void Exchange(Message& message, UrdfBox& box) { message(box.size_m); }
//
// It is declared in the struct's namespace.

namespace doorforge {

/// Numbers, and vectors and matrices of a fixed size, whose bytes are their value.
template <class T>
inline constexpr bool kIsPlain = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;
template <class S, int R, int C, int O, int R2, int C2>
inline constexpr bool kIsPlain<Eigen::Matrix<S, R, C, O, R2, C2>> = R > 0 && C > 0 && kIsPlain<S>;

/// Appends values to a message.
class MessageWriter {
 public:
  template <class... Values>
  void operator()(Values&... values) {
    (One(values), ...);
  }
  /// An enum whose values are 0 to `last`.
  template <class Enum>
  void Choice(Enum& value, Enum /*last*/) {
    auto number = static_cast<std::uint8_t>(value);
    One(number);
  }
  std::string Take() && { return std::move(bytes_); }

 private:
  void Put(const void* data, std::size_t count) {
    bytes_.append(static_cast<const char*>(data), count);
  }
  void Count(std::size_t count) {
    const std::uint64_t number = count;
    Put(&number, sizeof number);
  }

  template <class T>
  void One(T& value) {
    if constexpr (kIsPlain<T>)
      Put(&value, sizeof value);
    else
      Exchange(*this, value);
  }
  void One(bool& value) {
    auto number = static_cast<std::uint8_t>(value);
    One(number);
  }
  void One(std::string& text) {
    Count(text.size());
    Put(text.data(), text.size());
  }
  void One(std::filesystem::path& path) {
    std::string text = path.string();
    One(text);
  }
  void One(Eigen::Isometry3d& transform) { One(transform.matrix()); }
  template <class T>
  void One(std::vector<T>& values) {
    Count(values.size());
    if constexpr (kIsPlain<T>) {
      Put(values.data(), values.size() * sizeof(T));
    } else {
      for (T& value : values) One(value);
    }
  }
  template <class T>
  void One(std::set<T>& values) {
    Count(values.size());
    for (T value : values) One(value);
  }
  template <class K, class V, class Less>
  void One(std::map<K, V, Less>& values) {
    Count(values.size());
    for (auto& [key, value] : values) {
      K name = key;
      One(name);
      One(value);
    }
  }
  template <class T>
  void One(std::optional<T>& value) {
    bool has = value.has_value();
    One(has);
    if (has) One(*value);
  }
  void One(std::monostate&) {}
  template <class... T>
  void One(std::variant<T...>& value) {
    auto index = static_cast<std::uint8_t>(value.index());
    One(index);
    std::visit([&](auto& one) { One(one); }, value);
  }

  std::string bytes_;
};

/// Takes values off a message that is not trusted: ok() turns false where it is too short, or holds
/// what the type has no value for, and all that follows stays as it is. A list never takes more
/// memory than a few times the bytes of the message.
class MessageReader {
 public:
  explicit MessageReader(std::string_view message) : rest_(message) {}

  template <class... Values>
  void operator()(Values&... values) {
    (One(values), ...);
  }
  template <class Enum>
  void Choice(Enum& value, Enum last) {
    std::uint8_t number = 0;
    One(number);
    if (number > static_cast<std::uint8_t>(last)) ok_ = false;
    if (ok_) value = static_cast<Enum>(number);
  }
  bool ok() const { return ok_; }
  bool AtEnd() const { return ok_ && rest_.empty(); }

 private:
  void Get(void* data, std::size_t count) {
    ok_ = ok_ && count <= rest_.size();
    if (!ok_ || count == 0) return;
    std::memcpy(data, rest_.data(), count);
    rest_.remove_prefix(count);
  }
  // Reads how many elements follow, and refuses more than the rest can hold at `bytes` for each.
  std::size_t Count(std::size_t bytes) {
    std::uint64_t count = 0;
    Get(&count, sizeof count);
    if (count > rest_.size() / bytes) ok_ = false;
    return ok_ ? count : 0;
  }

  template <class T>
  void One(T& value) {
    if constexpr (kIsPlain<T>)
      Get(&value, sizeof value);
    else if (ok_)
      Exchange(*this, value);
  }
  void One(bool& value) {
    std::uint8_t number = 0;
    One(number);
    if (number > 1) ok_ = false;
    value = ok_ && number == 1;
  }
  void One(std::string& text) {
    text.resize(Count(1));
    Get(text.data(), text.size());
  }
  void One(std::filesystem::path& path) {
    std::string text;
    One(text);
    path = text;
  }
  void One(Eigen::Isometry3d& transform) { One(transform.matrix()); }
  template <class T>
  void One(std::vector<T>& values) {
    if constexpr (kIsPlain<T>) {
      values.resize(Count(sizeof(T)));
      Get(values.data(), values.size() * sizeof(T));
    } else {
      const std::size_t count = Count(1);
      values.clear();
      for (std::size_t i = 0; i < count && ok_; ++i) One(values.emplace_back());
    }
  }
  template <class T>
  void One(std::set<T>& values) {
    const std::size_t count = Count(1);
    for (std::size_t i = 0; i < count && ok_; ++i) {
      T value{};
      One(value);
      values.insert(std::move(value));
    }
  }
  template <class K, class V, class Less>
  void One(std::map<K, V, Less>& values) {
    const std::size_t count = Count(1);
    for (std::size_t i = 0; i < count && ok_; ++i) {
      K key{};
      One(key);
      One(values[std::move(key)]);
    }
  }
  template <class T>
  void One(std::optional<T>& value) {
    bool has = false;
    One(has);
    if (has) One(value.emplace());
  }
  void One(std::monostate&) {}
  template <class... T>
  void One(std::variant<T...>& value) {
    std::uint8_t index = 0;
    One(index);
    if (index >= sizeof...(T)) ok_ = false;
    std::uint8_t at = 0;
    ((ok_ && at++ == index ? One(value.template emplace<T>()) : void()), ...);
  }

  std::string_view rest_;
  bool ok_ = true;
};

/// A copy of the value as bytes.
template <class T>
std::string MessageOf(T value) {
  MessageWriter message;
  message(value);
  return std::move(message).Take();
}

}  // namespace doorforge
