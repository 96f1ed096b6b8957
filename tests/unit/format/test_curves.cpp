// SPDX-License-Identifier: AGPL-3.0-or-later
// What a reader of curves must refuse.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/format/breakage.hpp"

namespace palpate::samples {
namespace {

std::vector<Case> curves_cases() {
  const auto kind = Kind::Curves;
  return {
      {"CurvesVertexNegative", kind, poke("/site/vertex", 0, -1), "/site/vertex[0]",
       "finite and not negative"},
      {"CurvesVerticesUnordered", kind, poke("/site/vertex", 2, 3), "/site/vertex[2]",
       "is not above the row before it"},
      {"CurvesStatusUnknown", kind, poke("/site/status", 1, 3), "/site/status[1]",
       "is not a status"},
      {"CurvesKindUnknown", kind, poke("/path/kind", 1, 2), "/path/kind[1]",
       "is not a kind of path"},
      {"CurvesPathOffsetDecreasing", kind, poke("/site/first_path", 2, 1), "/site/first_path[2]",
       "is not the sum of the counts before it"},
      {"CurvesSampleOffsetDecreasing", kind, poke("/path/first_sample", 1, 0),
       "/path/first_sample[1]", "is not the sum of the counts before it"},
      {"CurvesCountHuge", kind, poke("/path/sample_count", 0, 1e18), "/path/sample_count[0]",
       "leads beyond"},
      {"CurvesCountNegative", kind, poke("/site/path_count", 0, -1), "/site/path_count[0]",
       "finite and not negative"},
      {"CurvesForceNaN", kind, poke("/sample/force", 3, kNaN), "/sample/force[1]",
       "nan is not finite"},
      {"CurvesDirectionNotUnit", kind, poke("/path/direction", 3, 2), "/path/direction[1]",
       "1 expected"},
      {"CurvesStartNotAtTouch", kind, poke("/sample/displacement", 0, 1e-9),
       "/sample/displacement[0]", "does not begin at 0"},
      {"CurvesSamplesTooFew", kind, replace("/sample/penetration", {3}, H5T_IEEE_F64LE),
       "/sample/penetration", "has shape (3)"},
      {"CurvesReasonMissing", kind, remove("/site/reason"), "/site/reason", "is missing"},
      {"CurvesReasonOfAFailureEmpty", kind, poke("/site/status", 0, 2), "/site/reason[0]",
       "is empty, yet the site is not complete"},
      {"CurvesReasonWithoutAFailure", kind, poke("/site/status", 3, 0), "/site/reason[3]",
       "gives a reason, yet the site is complete"},
      {"CurvesSampleGroupMissing", kind, remove("/sample"), "/sample/displacement", "is missing"},
      {"CurvesDepthNaN", kind, real("/", "depth", kNaN), "/@depth", "is not finite"},
      {"CurvesRadiusNegative", kind, real("/", "tool_radius", -1), "/@tool_radius", "negative"},
      {"CurvesDigestShort", kind,
       edit([](Hdf5Editor& e) { e.set_text("/", "body_sha256", "abc"); }), "/@body_sha256",
       "is not a SHA-256"},
  };
}

INSTANTIATE_TEST_SUITE_P(CurvesFiles, Rejection, testing::ValuesIn(curves_cases()), name_of);

}  // namespace
}  // namespace palpate::samples
