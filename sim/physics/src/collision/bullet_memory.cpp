// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "collision/bullet_memory.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <mutex>

#include <LinearMath/btAlignedAllocator.h>

namespace doorforge::internal {
namespace {

constexpr std::size_t kHeader = 16;  // in front of each piece: its class; keeps the alignment
constexpr std::size_t kBlockSize = std::size_t{256} << 10U;

thread_local BulletMemory* current_memory = nullptr;

// Sizes are rounded up to powers of two, so that a list that grows finds the places of others.
std::size_t ClassOf(std::size_t size) {
  return static_cast<std::size_t>(std::bit_width(std::max<std::size_t>(size, 32) - 1));
}

void* AllocateForBullet(std::size_t size) {
  return current_memory != nullptr ? current_memory->Allocate(size) : std::malloc(size);
}

void FreeForBullet(void* pointer) {
  if (current_memory == nullptr || !current_memory->Free(pointer)) std::free(pointer);
}

void LetBulletAsk() {
  static std::once_flag once;
  std::call_once(once, [] { btAlignedAllocSetCustom(AllocateForBullet, FreeForBullet); });
}

}  // namespace

BulletMemory::Scope::Scope(BulletMemory& memory) {
  LetBulletAsk();
  current_memory = &memory;
}

BulletMemory::Scope::~Scope() { current_memory = nullptr; }

void* BulletMemory::TakeFromBlocks(std::size_t size) {
  const auto fits = [size](const Block& block) { return block.size - block.used >= size; };
  auto block = std::find_if(blocks_.begin(), blocks_.end(), fits);
  if (block == blocks_.end()) {
    const std::size_t whole = std::max(size, kBlockSize);
    blocks_.push_back({std::make_unique_for_overwrite<std::byte[]>(whole), whole, 0});
    block = blocks_.end() - 1;
  }
  void* place = block->bytes.get() + block->used;
  block->used += size;
  return place;
}

void* BulletMemory::Allocate(std::size_t size) {
  const std::size_t size_class = ClassOf(size + kHeader);
  void*& free = free_lists_.at(size_class);
  auto* piece = static_cast<std::byte*>(free);
  if (piece != nullptr) {
    std::memcpy(&free, piece + kHeader, sizeof free);
  } else {
    piece = static_cast<std::byte*>(TakeFromBlocks(std::size_t{1} << size_class));
    std::memcpy(piece, &size_class, sizeof size_class);
  }
  return piece + kHeader;
}

bool BulletMemory::Free(void* pointer) {
  auto* given = static_cast<std::byte*>(pointer);
  const std::less<> before;
  const bool own = std::any_of(blocks_.begin(), blocks_.end(), [&](const Block& block) {
    return !before(given, block.bytes.get()) && before(given, block.bytes.get() + block.used);
  });
  if (!own) return false;
  std::size_t size_class = 0;
  std::memcpy(&size_class, given - kHeader, sizeof size_class);
  void*& free = free_lists_.at(size_class);
  std::memcpy(given, &free, sizeof free);
  free = given - kHeader;
  return true;
}

BulletMemory::Image BulletMemory::Copy() const {
  Image image;
  for (const Block& block : blocks_)
    image.blocks.emplace_back(block.bytes.get(), block.bytes.get() + block.used);
  image.free_lists = free_lists_;
  for (const Region& region : regions_)
    image.regions.emplace_back(region.bytes, region.bytes + region.size);
  return image;
}

void BulletMemory::Restore(const Image& image) {
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    blocks_[i].used = i < image.blocks.size() ? image.blocks[i].size() : 0;
    if (blocks_[i].used > 0)
      std::memcpy(blocks_[i].bytes.get(), image.blocks[i].data(), blocks_[i].used);
  }
  free_lists_ = image.free_lists;
  for (std::size_t i = 0; i < regions_.size(); ++i)
    std::memcpy(regions_[i].bytes, image.regions.at(i).data(), regions_[i].size);
}

}  // namespace doorforge::internal
