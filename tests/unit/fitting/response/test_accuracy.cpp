// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/accuracy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace palpate::fitting {
namespace {

using testing::HasSubstr;
using testing::Not;

/// 2 N at 4 mm along the normal, 1 N at 2 mm laterally; an error of 1 % of the fit.
NodeResponse response() {
  NodeResponse node{
      ResponseStatus::Fitted, {{0, 0.004F}, {0, 1000}}, {{0, 0.002F}, {500, 500}}, 0.02, 0.01, {}};
  node.normal_mesh_error = 0.04;
  node.lateral_mesh_error = 0.03;
  return node;
}

Library library() {
  Library made;
  made.responses.assign(20, response());
  made.responses.emplace_back();  // a hole counts for nothing
  return made;
}

TEST(Accuracy, IsRelativeToTheLargestForceOfTheResponse) {
  const Accuracy normal = normal_accuracy(library()), lateral = lateral_accuracy(library());
  EXPECT_NEAR(normal.mesh, 0.02, 1e-6);
  EXPECT_NEAR(normal.fit, 0.01, 1e-6);
  EXPECT_NEAR(lateral.mesh, 0.03, 1e-6);
  EXPECT_NEAR(lateral.fit, 0.01, 1e-6);
}

TEST(Accuracy, OfCoupledResponsesIsRelativeToTheLateralForceAtTheLargestDepth) {
  Library coupled = library();
  coupled.kind = ResponseKind::Coupled;
  for (NodeResponse& node : coupled.responses) node.coupling = {1, {{0, 0.004F}, {500, 500}}};
  EXPECT_NEAR(lateral_accuracy(coupled).mesh, 0.03 / (1.0 * (1 + 500 * 0.004)), 1e-6);
}

/// One vertex of twenty may be worse.
TEST(Accuracy, HoldsAtNineteenOfTwentyVertices) {
  Library one = library(), two = library();
  one.responses[3].normal_mesh_error = two.responses[3].normal_mesh_error = 1;
  two.responses[7].normal_mesh_error = 1;
  EXPECT_NEAR(normal_accuracy(one).mesh, 0.02, 1e-6);
  EXPECT_NEAR(normal_accuracy(two).mesh, 0.5, 1e-6);
}

TEST(Accuracy, IsOneSentence) {
  EXPECT_EQ(accuracy_text(library()),
            "at 95 % of the vertices the normal force is within 2.0 % (mesh) + 1.0 % (fit) of the "
            "converged force, the lateral force within 3.0 % (mesh) + 1.0 % (fit), relative to the "
            "largest there");
}

TEST(Accuracy, OfCurvesOfUnknownErrorIsThatOfTheFitAlone) {
  Library unknown = library();
  for (NodeResponse& node : unknown.responses)
    node.normal_mesh_error = node.lateral_mesh_error = kUnknown;
  EXPECT_TRUE(std::isnan(normal_accuracy(unknown).mesh));
  const std::string text = accuracy_text(unknown);
  EXPECT_THAT(text, HasSubstr("within 1.0 % (fit) of its curve"));
  EXPECT_THAT(text, HasSubstr("the error of the curves themselves is unknown"));
  EXPECT_THAT(text, Not(HasSubstr("converged")));
  EXPECT_EQ(accuracy_text({}), "");
}

}  // namespace
}  // namespace palpate::fitting
