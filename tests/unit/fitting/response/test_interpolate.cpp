// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/interpolate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fitting/response/fit.hpp"
#include "fitting/sampling/site_choice.hpp"
#include "tests/unit/fitting/plate_body.hpp"

namespace palpate::fitting {
namespace {

TEST(Interpolate, LinearStiffnessIsInterpolatedAndNeedsNoMoreSites) {
  const Body body = plate(12);
  const Field linear = [](const Vec3& x) { return 1 + 10 * x[0] + 5 * x[1]; };
  const auto sites = spread_sites(body, 0.012);
  const Library library = fit(body, press_all(body, sites, linear), interpolating());
  for (std::size_t v = 0; v < body.nodes.size(); ++v) {
    const bool computed =
        std::binary_search(sites.begin(), sites.end(), static_cast<std::int32_t>(v));
    const auto status = library.responses[v].status;
    EXPECT_EQ(status, computed ? ResponseStatus::Fitted : ResponseStatus::Interpolated);
    const Vec3& x = body.nodes[v];
    const double border = std::min({x[0], x[1], 0.06 - x[0], 0.06 - x[1]});
    if (border < 0.01) continue;  // near the border donors are on one side only
    EXPECT_NEAR(deepest_force(library, v), law(linear(x)), 0.01 * law(linear(x))) << v;
  }
  for (const std::int32_t v : next_sites(body, sites, library, 0.02, 1000)) {
    const Vec3& x = position(body, v);
    EXPECT_LT(std::min({x[0], x[1], 0.06 - x[0], 0.06 - x[1]}), 0.01) << "inside";
  }
}

TEST(Interpolate, LeaveOneOutErrorIsThatOfAFitWithoutTheSite) {
  const Body body = plate(9);
  const Field bump = [](const Vec3& x) {
    const Vec3 r = x - Vec3{0.02, 0.02, 0};
    return 1 + 2 * std::exp(-dot(r, r) / (2 * 0.006 * 0.006));
  };
  const auto sites = spread_sites(body, 0.012);
  const Library library = fit(body, press_all(body, sites, bump), interpolating());
  const auto errors = leave_one_out(library);
  ASSERT_EQ(errors.size(), sites.size());
  // Independently: without its curves the site is interpolated by the fit.
  for (std::size_t i = 0; i < errors.size(); i += 5) {
    const LeaveOneOutError& error = errors[i];
    auto others = sites;
    others.erase(std::find(others.begin(), others.end(), error.vertex));
    const Library without = fit(body, press_all(body, others, bump), interpolating());
    const auto v = static_cast<std::size_t>(error.vertex);
    const double direct = law(bump(body.nodes[v]));
    EXPECT_NEAR(error.normal, std::abs(deepest_force(without, v) - direct), 0.01 * direct) << v;
  }
}

}  // namespace
}  // namespace palpate::fitting
