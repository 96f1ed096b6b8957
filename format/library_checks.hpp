// SPDX-License-Identifier: Apache-2.0
// What every file of a response library is checked for, before it is written and after it is read.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "format/checks.hpp"
#include "format/library.hpp"

namespace palpate {

/// Curves of all nodes end to end; node l owns the knots offset[l] .. offset[l+1]-1.
struct FlatCurves {
  std::vector<std::int64_t> offset;
  std::vector<float> knot;
  std::vector<float> slope;
};

/// One of the curves of a node.
using CurveMember = ResponseCurve& (*)(NodeResponse&);
inline ResponseCurve& normal_of(NodeResponse& node) {
  return node.normal;
}
inline ResponseCurve& lateral_of(NodeResponse& node) {
  return node.lateral;
}
inline ResponseCurve& coupling_of(NodeResponse& node) {
  return node.coupling.curve;
}
FlatCurves flatten(const std::vector<NodeResponse>& responses, CurveMember which);
/// The curves of the nodes from those of all; they have passed check_curves().
void unflatten(const FlatCurves& flat, CurveMember which, std::vector<NodeResponse>& responses);

/// w(0) of each node.
std::vector<float> coupling_bases(const std::vector<NodeResponse>& responses);

/// What is wrong with a file of coupled responses that an earlier palpate has certified.
inline constexpr const char* kFormerCoupled =
    "has coupled responses that an earlier palpate has fitted and certified for another model";

/// What is wrong with coupled responses that lean as an earlier palpate has fitted them.
inline constexpr const char* kFormerLean =
    "has coupled responses with a lean that an earlier palpate has fitted for another model";

/// A vector of nodes with a response, of which an array of a file has a row for each.
struct NodeVector {
  const char* name;  ///< of the array
  std::array<float, 3> NodeResponse::*member;
};
inline constexpr NodeVector kLeans{"/response/lean", &NodeResponse::lean};
inline constexpr NodeVector kSoftAxes{"/response/soft_axis", &NodeResponse::soft_axis};

/// What is wrong with soft axes of responses that are not coupled.
inline constexpr const char* kSoftAndDecoupled =
    "is of decoupled responses, which have no soft axes";

std::vector<std::array<float, 3>> rows_of(const std::vector<NodeResponse>& responses,
                                          const NodeVector& vector);
/// Checks them, and gives them to the nodes. Coupled responses must have their w already.
void set_rows(const Checks& checks, const std::vector<std::array<float, 3>>& rows,
              const NodeVector& vector, Library& library);

/// g_i of every node, row by row: V times B numbers, zero at a hole.
std::vector<float> relaxation_fractions(const Library& library);
/// Gives the nodes those fractions, once check_relaxation() has passed.
void set_relaxation_fractions(const std::vector<float>& fractions, Library& library);
/// The relaxation times of a library, and its fractions row by row.
void check_relaxation(const Checks& checks, const Library& library,
                      const std::vector<float>& fractions);

/// Curves of all nodes; `stem`: "/response/normal_" and its like.
void check_curves(const Checks& checks, const std::string& stem, const FlatCurves& flat,
                  const std::vector<NodeResponse>& responses);
/// Surface, tool and certificate of a library that was read.
void check_library(const Checks& checks, const Library& library);
/// All of it, and the provenance.
void check_for_writing(const Checks& checks, const Library& library);

}  // namespace palpate
