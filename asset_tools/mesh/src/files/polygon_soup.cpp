// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "files/polygon_soup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include <Eigen/Geometry>

#include "doorforge/core/error.h"

#include "files/position_table.h"

namespace doorforge {
namespace {

using Point2 = Eigen::Vector2d;

double Cross(const Point2& a, const Point2& b, const Point2& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

// The polygon in the plane of its Newell normal, counter-clockwise.
std::vector<Point2> Flattened(std::span<const Eigen::Vector3d> corners) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d a = corners[i] - corners[0];
    const Eigen::Vector3d b = corners[(i + 1) % corners.size()] - corners[0];
    normal += a.cross(b);
  }
  int dropped = 0;
  normal.cwiseAbs().maxCoeff(&dropped);
  const int x = (dropped + 1) % 3;
  const int y = (dropped + 2) % 3;
  const double flip = normal[dropped] < 0 ? -1 : 1;
  std::vector<Point2> flat;
  for (const Eigen::Vector3d& corner : corners)
    flat.emplace_back(corner[x] - corners[0][x], flip * (corner[y] - corners[0][y]));
  return flat;
}

// `looked` counts the corners that were looked at.
bool IsEar(const std::vector<Point2>& flat, const std::vector<int>& ring, std::size_t i,
           std::size_t& looked) {
  const std::size_t n = ring.size();
  const auto at = [&](std::size_t k) -> const Point2& {
    return flat[static_cast<std::size_t>(ring[k % n])];
  };
  const Point2& a = at(i + n - 1);
  const Point2& b = at(i);
  const Point2& c = at(i + 1);
  if (Cross(a, b, c) <= 0) return false;
  for (std::size_t k = i + 2; k < i + n - 1; ++k) {
    const Point2& p = at(k);
    ++looked;
    if (p == a || p == b || p == c) continue;
    if (Cross(a, b, p) >= 0 && Cross(b, c, p) >= 0 && Cross(c, a, p) >= 0) return false;
  }
  return true;
}

// Some seconds: a face whose ears are that hard to find is no face that a program writes.
constexpr std::size_t kMaxLooks = 1'000'000'000;

[[noreturn]] void RefuseFace(std::size_t corners) {
  throw Error(ErrorCode::kFormat, "a face of " + std::to_string(corners) +
                                      " corners winds too much to be cut into triangles; export "
                                      "it in triangles");
}

bool ComesBefore(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

// The polygon from its first corner in that order on.
template <class Corner>
std::vector<Corner> Rotated(std::span<const Corner> corners, std::ptrdiff_t first) {
  std::vector<Corner> ring(corners.begin(), corners.end());
  std::rotate(ring.begin(), ring.begin() + first, ring.end());
  return ring;
}

std::array<int, 3> SortedCorners(const Eigen::Vector3i& t) {
  std::array<int, 3> corners{t[0], t[1], t[2]};
  std::sort(corners.begin(), corners.end());
  return corners;
}

// Tells the two ways round a triangle apart.
bool RunsUpwards(const Eigen::Vector3i& t) {
  return (t[0] < t[1]) == ((t[1] < t[2]) == (t[0] < t[2]));
}

void CheckCorner(const Eigen::Vector3d& corner) {
  const double largest = corner.cwiseAbs().maxCoeff();
  if (!corner.allFinite())
    throw Error(ErrorCode::kFormat, "a face uses a vertex that is not finite");
  if (largest > kLargestRawCoordinate)
    throw Error(ErrorCode::kFormat, "a face uses a vertex with a coordinate of " +
                                        std::to_string(std::llround(largest)) + ", allowed " +
                                        std::to_string(std::llround(kLargestRawCoordinate)) +
                                        "; the file is damaged, or its unit is far too small");
}

}  // namespace

std::vector<Eigen::Vector3i> Triangulated(std::span<const Eigen::Vector3d> corners) {
  std::vector<Eigen::Vector3i> triangles;
  std::vector<int> ring;
  for (std::size_t i = 0; i < corners.size(); ++i) ring.push_back(static_cast<int>(i));
  if (ring.size() < 3) return triangles;
  const std::vector<Point2> flat = Flattened(corners);
  std::size_t looked = 0;
  for (std::size_t n = ring.size(); n > 3; --n) {
    std::size_t ear = 1;  // the fan's choice, where no corner is an ear
    for (std::size_t i = 1; i <= n; ++i) {
      if (looked > kMaxLooks) RefuseFace(corners.size());
      if (!IsEar(flat, ring, i % n, looked)) continue;
      ear = i % n;
      break;
    }
    triangles.emplace_back(ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]);
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.emplace_back(ring[0], ring[1], ring[2]);
  return triangles;
}

void PolygonSoup::BeginPiece(std::string name, const Eigen::Vector4d& color_rgba, int material) {
  pieces_.push_back({std::move(name), color_rgba.cwiseMax(0.0).cwiseMin(1.0), material, {}, {}});
}

void PolygonSoup::AddPolygon(std::span<const Eigen::Vector3d> corners,
                             std::span<const Eigen::Vector2d> texcoords) {
  if (corners.size() < 3) return;
  if (corners.size() > kMaxFaceCorners)
    throw Error(ErrorCode::kFormat, "a face has " + std::to_string(corners.size()) +
                                        " corners, allowed " + std::to_string(kMaxFaceCorners) +
                                        "; export it in triangles");
  for (const Eigen::Vector3d& corner : corners) CheckCorner(corner);
  triangle_count_ += corners.size() - 2;
  if (triangle_count_ > max_triangles_)
    throw Error(ErrorCode::kFormat,
                "more than the " + std::to_string(max_triangles_) + " triangles allowed");
  if (pieces_.empty()) BeginPiece("", ImportedPiece{}.color_rgba);
  // from a corner that does not depend on where the file begins, so that a repeated face is split
  // along the same diagonal
  const std::ptrdiff_t first =
      std::min_element(corners.begin(), corners.end(), ComesBefore) - corners.begin();
  const std::vector<Eigen::Vector3d> ring = Rotated(corners, first);
  std::vector<Eigen::Vector2d> coordinates;
  if (!texcoords.empty()) coordinates = Rotated(texcoords, first);
  Piece& piece = pieces_.back();
  for (const Eigen::Vector3i& t : Triangulated(ring)) {
    Eigen::Matrix3d& triangle = piece.triangles.emplace_back();
    for (int k = 0; k < 3; ++k) triangle.col(k) = ring[static_cast<std::size_t>(t[k])];
    if (coordinates.empty()) continue;
    piece.texcoords.resize(piece.triangles.size(), Texcoords::Zero());
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d& at = coordinates[static_cast<std::size_t>(t[k])];
      if (at.allFinite()) piece.texcoords.back().col(k) = at;
    }
  }
}

class PolygonSoup::Side {
 public:
  explicit Side(const Piece& piece) : piece_(piece) {
    imported_.name = piece.name;
    imported_.color_rgba = piece.color_rgba;
    imported_.material = piece.material;
  }

  void Add(std::size_t triangle) {
    imported_.mesh.triangles.push_back(IndicesOf(piece_.triangles[triangle], positions_));
    if (piece_.texcoords.empty()) return;
    Eigen::Matrix3d at = Eigen::Matrix3d::Zero();
    if (triangle < piece_.texcoords.size()) at.topRows<2>() = piece_.texcoords[triangle];
    imported_.texcoord_triangles.push_back(IndicesOf(at, texcoords_));
  }

  void MoveTo(std::vector<ImportedPiece>& pieces) {
    if (imported_.mesh.triangles.empty()) return;
    imported_.mesh.vertices = std::move(positions_.positions());
    for (const Eigen::Vector3d& at : texcoords_.positions())
      imported_.texcoords.emplace_back(at.head<2>());
    pieces.push_back(std::move(imported_));
  }

 private:
  static Eigen::Vector3i IndicesOf(const Eigen::Matrix3d& corners, PositionTable& table) {
    Eigen::Vector3i t;
    for (int k = 0; k < 3; ++k) t[k] = table.IndexOf(corners.col(k));
    return t;
  }

  const Piece& piece_;
  ImportedPiece imported_;
  PositionTable positions_;
  PositionTable texcoords_;
};

ImportedMesh PolygonSoup::Finish() && {
  ImportedMesh mesh;
  PositionTable everywhere;
  std::map<std::array<int, 3>, std::array<bool, 2>> seen;  // either way round
  for (const Piece& piece : pieces_) {
    Side first(piece);
    Side other(piece);
    for (std::size_t i = 0; i < piece.triangles.size(); ++i) {
      Eigen::Vector3i t;
      for (int k = 0; k < 3; ++k) t[k] = everywhere.IndexOf(piece.triangles[i].col(k));
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      const auto [entry, is_new] = seen.try_emplace(SortedCorners(t));
      bool& known = entry->second.at(RunsUpwards(t) ? 1 : 0);
      if (!known) (is_new ? first : other).Add(i);
      known = true;
    }
    first.MoveTo(mesh.pieces);
    other.MoveTo(mesh.other_sides);
  }
  if (mesh.pieces.empty()) throw Error(ErrorCode::kFormat, "no triangle in the file");
  return mesh;
}

}  // namespace doorforge
