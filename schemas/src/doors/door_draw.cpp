// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/door_draw.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "doorforge/core/hash.h"

namespace doorforge {
namespace {

using Places = std::map<std::string, std::size_t>;  // part id -> its turn

// The digits of `index` in base 2, mirrored at the point: the van der Corput sequence, of which any
// beginning is spread over [0, 1).
double Mirrored(std::size_t index) {
  double value = 0;
  for (double digit = 0.5; index > 0; index /= 2, digit /= 2) {
    if (index % 2 == 1) value += digit;
  }
  return value;
}

// Names that follow each other in the list are far apart in the turns.
Places SpreadTurns(const std::vector<std::string>& sorted) {
  std::set<std::size_t> left;
  for (std::size_t i = 0; i < sorted.size(); ++i) left.insert(left.end(), i);
  Places turns;
  for (std::size_t k = 0; !left.empty(); ++k) {
    const auto wanted = static_cast<std::size_t>(Mirrored(k) * static_cast<double>(sorted.size()));
    const auto found = left.find(wanted);  // else a later one falls upon it
    if (found == left.end()) continue;
    turns.emplace(sorted[*found], turns.size());
    left.erase(found);
  }
  return turns;
}

Places TurnsOfHandles(std::span<const DoorIdentity> doors,
                      const std::vector<std::size_t>& members) {
  std::set<std::pair<Mechanism, std::string>> handles;
  for (const std::size_t door : members)
    handles.emplace(doors[door].mechanism, doors[door].handle.id);
  std::vector<std::string> names;
  for (const auto& [mechanism, name] : handles) names.push_back(name);
  return SpreadTurns(names);
}

// Sorts by a hash of the names: bodies of one family are not neighbours, and what is dealt together
// with the handles is no pattern of both lists.
Places TurnsOfBodies(std::span<const DoorIdentity> doors, const std::vector<std::size_t>& members) {
  std::map<std::string, std::string> by_hash;
  for (const std::size_t door : members)
    by_hash.emplace(Sha256Hex(doors[door].body.id), doors[door].body.id);
  Places turns;
  for (const auto& [hash, name] : by_hash) turns.emplace(name, turns.size());
  return turns;
}

// The place of a pair in the Latin design: draw k of round s deals body k mod `bodies` and handle
// (k + s) mod `handles`; a round lasts until both turns end together, and in the round after it the
// handles are one further.
std::size_t PlaceInDesign(std::size_t body, std::size_t handle, std::size_t bodies,
                          std::size_t handles) {
  const std::size_t common = std::gcd(bodies, handles);
  const std::size_t round = (handle % common + common - body % common) % common;
  std::size_t draw = body;
  while ((draw + round) % handles != handle) draw += bodies;
  return round * std::lcm(bodies, handles) + draw;
}

struct Candidate {
  std::size_t door = 0;
  std::size_t body = 0;  // turns
  std::size_t handle = 0;
  std::size_t place = 0;  // in the design
};

std::vector<Candidate> CandidatesOf(std::span<const DoorIdentity> doors,
                                    const std::vector<std::size_t>& members) {
  const Places bodies = TurnsOfBodies(doors, members);
  const Places handles = TurnsOfHandles(doors, members);
  std::vector<Candidate> candidates;
  for (const std::size_t door : members) {
    const std::size_t body = bodies.at(doors[door].body.id);
    const std::size_t handle = handles.at(doors[door].handle.id);
    candidates.push_back(
        {door, body, handle, PlaceInDesign(body, handle, bodies.size(), handles.size())});
  }
  std::ranges::stable_sort(candidates, {}, &Candidate::place);
  return candidates;
}

// The least drawn handle with the least drawn body; where several are alike, by the design.
std::vector<std::size_t> DrawSome(std::vector<Candidate> candidates, std::size_t count) {
  std::vector<std::size_t> of_body(candidates.size());
  std::vector<std::size_t> of_handle(candidates.size());
  std::vector<std::size_t> drawn;
  while (drawn.size() < count && !candidates.empty()) {
    const auto next = std::ranges::min_element(candidates, {}, [&](const Candidate& candidate) {
      return std::tuple(of_handle[candidate.handle], of_body[candidate.body], candidate.place);
    });
    ++of_handle[next->handle];
    ++of_body[next->body];
    drawn.push_back(next->door);
    candidates.erase(next);
  }
  return drawn;
}

}  // namespace

std::vector<std::size_t> DrawDoors(std::span<const DoorIdentity> doors, std::size_t per_category) {
  std::vector<std::size_t> by_id(doors.size());
  std::iota(by_id.begin(), by_id.end(), std::size_t{0});
  std::ranges::stable_sort(by_id, {}, [&](std::size_t door) { return doors[door].id; });
  std::map<Category, std::vector<std::size_t>> categories;
  for (const std::size_t door : by_id) categories[doors[door].category].push_back(door);
  std::vector<std::size_t> drawn;
  for (const auto& [category, members] : categories) {
    const std::vector<std::size_t> some =
        members.size() <= per_category ? members
                                       : DrawSome(CandidatesOf(doors, members), per_category);
    drawn.insert(drawn.end(), some.begin(), some.end());
  }
  std::ranges::sort(drawn);
  return drawn;
}

}  // namespace doorforge
