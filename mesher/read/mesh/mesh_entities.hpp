// SPDX-License-Identifier: AGPL-3.0-or-later
// A volume mesh as its file lists it, before anything is checked but its syntax.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::mesher {

/// The corners of the edges whose mid-nodes are nodes 4 to 9 of a quadratic tetrahedron, in the
/// order of VTK, Abaqus and FEBio.
inline constexpr std::array<std::array<std::size_t, 2>, 6> kTetrahedronEdges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

struct ListedTetrahedron {
  std::array<std::int32_t, 10> nodes{};  ///< indices into MeshEntities::nodes; four when linear
  bool quadratic = false;
  std::int32_t region = 0;  ///< index into MeshEntities::region_names
  std::int64_t number = 0;  ///< by which the file knows it
};

struct MeshEntities {
  std::vector<Vec3> nodes;                 ///< in units of the file
  std::vector<std::int64_t> node_numbers;  ///< by which the file knows them
  std::vector<ListedTetrahedron> tetrahedra;
  std::vector<std::string> region_names;
  std::map<std::string, std::vector<std::int32_t>> node_sets;  ///< a node may be there repeatedly
  /// Sets of tetrahedra beside the regions, by index: the case may make regions of them.
  std::map<std::string, std::vector<std::int32_t>> groups;
  std::map<std::string, std::size_t> other_solids;  ///< number of volume elements of other shapes

  /// Index of the region of this name, which is added if there is none.
  std::int32_t region(const std::string& name) {
    const auto [found, is_new] =
        region_of_.try_emplace(name, static_cast<std::int32_t>(region_names.size()));
    if (is_new) region_names.push_back(name);
    return found->second;
  }
  void add_to_set(const std::string& name, const std::vector<std::int32_t>& more) {
    auto& set = node_sets[name];
    set.insert(set.end(), more.begin(), more.end());
  }

 private:
  std::map<std::string, std::int32_t> region_of_;
};

/// The region of elements that their file assigns to none.
inline constexpr const char* kUnnamedRegion = "matrix";

/// Indices of nodes or elements by the numbers of a file, which may have gaps and any order.
class NumberIndex {
 public:
  /// The next index for the number; false when the number has one.
  bool add(std::int64_t number) {
    return index_.emplace(number, static_cast<std::int32_t>(index_.size())).second;
  }
  std::optional<std::int32_t> find(std::int64_t number) const {
    const auto found = index_.find(number);
    if (found == index_.end()) return std::nullopt;
    return found->second;
  }
  void reserve(std::size_t count) { index_.reserve(count); }

 private:
  std::unordered_map<std::int64_t, std::int32_t> index_;
};

}  // namespace palpate::mesher
