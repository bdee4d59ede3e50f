// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace doorforge::internal {

/// Memory of its own for everything that Bullet allocates in one world, so that the world can be
/// copied away and put back byte by byte.
///
/// What a Bullet world does next depends on far more than positions and speeds: cached contacts and
/// their impulses, the order of pairs, the broadphase's trees and where it has come to in tidying
/// them up. Bullet writes none of that into its own files, and half of it is private. All of it
/// lies in memory that Bullet asks for through two functions, and pointers stay right when bytes go
/// back to where they came from.
class BulletMemory {
 public:
  /// While it lives, what Bullet allocates and frees on this thread belongs to the memory. One at a
  /// time on each thread. What was allocated within a scope has to be freed within one.
  class Scope {
   public:
    explicit Scope(BulletMemory& memory);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
  };

  /// The memory's content at one instant.
  struct Image {
    std::vector<std::vector<std::byte>> blocks;
    std::array<void*, 64> free_lists{};
    std::vector<std::vector<std::byte>> regions;
  };

  BulletMemory() = default;
  BulletMemory(const BulletMemory&) = delete;
  BulletMemory& operator=(const BulletMemory&) = delete;

  /// Takes the bytes of an object into all images that is part of the world and lies elsewhere. Its
  /// own pointers may lead into this memory, or to what never changes.
  void AddRegion(void* object, std::size_t size) {
    regions_.push_back({static_cast<std::byte*>(object), size});
  }

  Image Copy() const;
  /// `image` has to be of this memory; what it has allocated since is forgotten.
  void Restore(const Image& image);

  void* Allocate(std::size_t size);
  /// True if the pointer was this memory's, which has it back then.
  bool Free(void* pointer);

 private:
  struct Block {
    std::unique_ptr<std::byte[]> bytes;
    std::size_t size = 0;
    std::size_t used = 0;
  };
  struct Region {
    std::byte* bytes;
    std::size_t size;
  };

  void* TakeFromBlocks(std::size_t size);

  std::vector<Block> blocks_;  // never given back, so that every image finds its addresses again
  std::array<void*, 64> free_lists_{};  // by class of sizes; the lists are in the blocks
  std::vector<Region> regions_;
};

}  // namespace doorforge::internal
