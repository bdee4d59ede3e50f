// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/event_log.h"

#include <bit>
#include <string_view>

#include "doorforge/core/hash.h"

namespace doorforge {
namespace {

// https://protobuf.dev/programming-guides/encoding
enum WireType { kVarint = 0, kFixed64 = 1, kLength = 2, kFixed32 = 5 };

template <class Unsigned>
std::string LittleEndian(Unsigned value) {
  std::string bytes;
  for (std::size_t i = 0; i < sizeof value; ++i)
    bytes += static_cast<char>(static_cast<unsigned char>(value >> (8 * i)));
  return bytes;
}

std::string Varint(std::uint64_t value) {
  std::string bytes;
  for (; value >= 0x80; value >>= 7U) bytes += static_cast<char>(value | 0x80U);
  return bytes + static_cast<char>(value);
}

std::string Key(unsigned field, WireType type) { return Varint(field << 3U | type); }

std::string Text(unsigned field, std::string_view bytes) {
  return Key(field, kLength) + Varint(bytes.size()) + std::string(bytes);
}

// tensorflow/core/util/event.proto: wall_time = 1, step = 2, file_version = 3, summary = 5
std::string Event(std::uint64_t step, const std::string& content) {
  if (step == 0) return content;  // proto3 leaves zeros out
  const auto time = std::bit_cast<std::uint64_t>(static_cast<double>(step));
  return Key(1, kFixed64) + LittleEndian(time) + Key(2, kVarint) + Varint(step) + content;
}

// summary.proto: Summary.value = 1; Value.tag = 1, simple_value = 2
std::string Scalar(const ScalarEvent& event) {
  const auto value = std::bit_cast<std::uint32_t>(static_cast<float>(event.value));
  return Text(5, Text(1, Text(1, event.tag) + Key(2, kFixed32) + LittleEndian(value)));
}

std::string MaskedCrc(const std::string& bytes) {
  const std::uint32_t crc = Crc32c(std::as_bytes(std::span(bytes)));
  return LittleEndian((crc >> 15U | crc << 17U) + 0xa282ead8U);
}

// tensorflow/core/lib/io/record_writer.h: length, its CRC, data, their CRC
std::string Frame(const std::string& data) {
  const std::string length = LittleEndian(std::uint64_t{data.size()});
  return length + MaskedCrc(length) + data + MaskedCrc(data);
}

}  // namespace

std::string TensorboardEvents(std::span<const ScalarEvent> events) {
  std::string file = Frame(Event(0, Text(3, "brain.Event:2")));
  for (const ScalarEvent& event : events) file += Frame(Event(event.step, Scalar(event)));
  return file;
}

}  // namespace doorforge
