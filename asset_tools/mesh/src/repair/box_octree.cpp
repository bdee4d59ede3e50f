// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "repair/box_octree.h"

#include <algorithm>
#include <limits>

namespace doorforge {
namespace {

constexpr std::size_t kNoCell = std::numeric_limits<std::size_t>::max();
constexpr int kDepth = 12;

}  // namespace

BoxOctree::BoxOctree(const Eigen::AlignedBox3d& bounds, std::size_t count)
    : boxes_(count), cell_of_(count, kNoCell) {
  AddCell(bounds.center(), 0.5 * bounds.sizes().maxCoeff());
}

void BoxOctree::Put(std::size_t number, const Eigen::AlignedBox3d& box) {
  Remove(number);
  boxes_[number] = box;
  cell_of_[number] = CellFor(box);
  cells_[cell_of_[number]].numbers.push_back(number);
}

void BoxOctree::Remove(std::size_t number) {
  if (cell_of_[number] == kNoCell) return;
  std::vector<std::size_t>& numbers = cells_[cell_of_[number]].numbers;
  *std::find(numbers.begin(), numbers.end(), number) = numbers.back();
  numbers.pop_back();
  cell_of_[number] = kNoCell;
}

void BoxOctree::Find(const Eigen::AlignedBox3d& box, std::vector<std::size_t>& found) const {
  std::vector<std::size_t> pending = {0};
  while (!pending.empty()) {
    const Cell& cell = cells_[pending.back()];
    pending.pop_back();
    for (const std::size_t number : cell.numbers) {
      if (boxes_[number].intersects(box)) found.push_back(number);
    }
    for (const std::size_t child : cell.children) {
      if (child == 0) continue;
      const Eigen::Vector3d reach = Eigen::Vector3d::Constant(2 * cells_[child].half);
      const Eigen::Vector3d& middle = cells_[child].middle;
      if (box.intersects(Eigen::AlignedBox3d(middle - reach, middle + reach)))
        pending.push_back(child);
    }
  }
}

std::size_t BoxOctree::CellFor(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d middle = box.center();
  const double half = 0.5 * box.sizes().maxCoeff();
  std::size_t at = 0;
  if (!((middle - cells_[0].middle).cwiseAbs().maxCoeff() <= cells_[0].half)) return at;
  for (int depth = 0; depth < kDepth && 2 * half <= cells_[at].half; ++depth) {
    std::size_t corner = 0;
    Eigen::Vector3d child = cells_[at].middle;
    const double child_half = 0.5 * cells_[at].half;
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = middle[axis] > child[axis];
      corner |= static_cast<std::size_t>(upper) << axis;
      child[axis] += upper ? child_half : -child_half;
    }
    if (cells_[at].children[corner] == 0) {
      const std::size_t added = AddCell(child, child_half);
      cells_[at].children[corner] = added;
    }
    at = cells_[at].children[corner];
  }
  return at;
}

std::size_t BoxOctree::AddCell(const Eigen::Vector3d& middle, double half) {
  cells_.push_back({middle, half, {}, {}});
  return cells_.size() - 1;
}

}  // namespace doorforge
