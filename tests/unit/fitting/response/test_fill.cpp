// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/fill.hpp"

#include <gtest/gtest.h>

#include "runtime/response_curve.hpp"
#include "tests/support/surfaces.hpp"

namespace palpate::fitting {
namespace {

TEST(Fill, RingsAreFilledFromTheInsideOfTheKnownPart) {
  // Only vertex 0 of an icosahedron is known: its five neighbours are one ring away, then five
  // more, then the opposite vertex. All get its response.
  Library library = sphere(0.04, 0);
  const NodeResponse known = node_response({{0.0F, 0.005F, 0.01F}, {0, 80, 120}}, linear_curve(60));
  library.responses.assign(12, NodeResponse{});
  library.responses[0] = known;
  fill_holes(library, {});
  for (std::size_t v = 1; v < 12; ++v) {
    const NodeResponse& node = library.responses[v];
    EXPECT_EQ(node.status, ResponseStatus::Interpolated);
    for (const double d : {0.003, 0.006, 0.01}) {
      const double expected = runtime::CompiledCurve(known.normal).force(d);
      EXPECT_NEAR(runtime::CompiledCurve(node.normal).force(d), expected,
                  std::max(0.03 * expected, 0.015));
    }
  }
  EXPECT_EQ(library.responses[0].status, ResponseStatus::Fitted);
}

TEST(Fill, TheErrorIsTheLargestDifferenceFromANeighbour) {
  Library library = flat_triangle();
  library.responses = {NodeResponse{}, node_response(linear_curve(100), linear_curve(60)),
                       node_response(linear_curve(100), linear_curve(80))};
  fill_holes(library, {});
  EXPECT_EQ(library.responses[0].status, ResponseStatus::Interpolated);
  EXPECT_NEAR(library.responses[0].lateral_error, 10 * 0.01, 0.01);
}

TEST(Fill, AVertexThatNoTriangleConnectsRemainsAHole) {
  Library library = flat_triangle();
  library.positions.push_back({1, 0, 0});
  library.inward.push_back({0, 0, -1});
  library.responses.assign(4, node_response(linear_curve(100), linear_curve(60)));
  library.responses[3] = NodeResponse{};
  fill_holes(library, {});
  EXPECT_EQ(library.responses[3].status, ResponseStatus::Hole);
}

}  // namespace
}  // namespace palpate::fitting
