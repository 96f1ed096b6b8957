// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/contact_element.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/surfaces.hpp"

namespace palpate::fitting {
namespace {

Library random_library() {
  std::mt19937 engine(81);
  Library library = flat_triangle();
  for (int l = 0; l < 3; ++l) library.responses.push_back(random_response(engine, 0.2));
  return library;
}

TEST(ContactElement, HasTheCurvesOfItsVertices) {
  Library library = random_library();
  const ContactElement element = contact_element(library, 0, 0.008, 0.3);
  EXPECT_EQ(element.friction, 0.3);
  EXPECT_EQ(element.depth, 0.008);
  EXPECT_FALSE(element.coupling);
  for (std::size_t l = 0; l < 3; ++l) {
    const NodeResponse& node = library.responses[static_cast<std::size_t>(library.triangles[0][l])];
    EXPECT_EQ(element.normal.curves()[l].force(0.004),
              runtime::CompiledCurve(node.normal).force(0.004));
    EXPECT_EQ(element.lateral.curves()[l].force(0.002),
              runtime::CompiledCurve(node.lateral).force(0.002));
  }
}

TEST(ContactElement, ATriangleAtAHoleHasNoResponses) {
  Library library = random_library();
  EXPECT_TRUE(has_responses(library, library.triangles[0]));
  library.responses[1] = NodeResponse{};
  EXPECT_FALSE(has_responses(library, library.triangles[0]));
}

TEST(ContactElement, DepthCellsHaveNoKnotOfNormalResponsesOrCouplingInside) {
  Library library = random_library();
  library.kind = ResponseKind::Coupled;
  for (NodeResponse& node : library.responses)
    node.coupling = {0.5F, {{0.0F, 0.0033F, 0.007F}, {0, 60, 0}}};
  const ContactElement element = contact_element(library, 0, 0.008, 0.3);
  const std::vector<double> ends = element.depth_cells();
  EXPECT_EQ(ends.front(), 0);
  EXPECT_EQ(ends.back(), 0.008);
  for (const float knot : {0.002F, 0.0033F, 0.005F, 0.007F})
    EXPECT_EQ(std::count(ends.begin(), ends.end(), static_cast<double>(knot)), 1) << knot;
  EXPECT_EQ(element.depth_cells(0.003).back(), 0.003);
}

}  // namespace
}  // namespace palpate::fitting
