// SPDX-License-Identifier: AGPL-3.0-or-later
// Errors of solids whose forces are known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fitting/certificate/certify.hpp"
#include "fitting/fidelity/fidelity.hpp"
#include "tests/support/surfaces.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::fidelity {
namespace {

constexpr double kNormal = 120, kLateral = 80;  // N/m
constexpr Vec3 kDown{0, 0, -1};
constexpr Vec3 kTangent{0.6, 0.8, 0};

/// Two triangles in the plane z = 0, the second with twice the area of the first.
Library plate(const std::vector<double>& stiffness) {
  Library library;
  library.name = "plate";
  library.positions = {{0, 0, 0}, {0.02, 0, 0}, {0, 0.02, 0}, {-0.04, 0, 0}};
  library.inward.assign(4, kDown);
  library.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (const double k : stiffness) {
    library.responses.push_back(
        fitting::node_response(fitting::linear_curve(k), fitting::linear_curve(kLateral)));
  }
  fitting::certify(library, {});
  return library;
}

Library even_plate() {
  return plate({kNormal, kNormal, kNormal, kNormal});
}

/// Direct solutions from a closed form: force at depth z, lateral displacement rho.
template <class Force>
Curves direct_of(const std::vector<HoldOutPoint>& points, const std::vector<double>& lateral_depths,
                 Force force) {
  Curves curves;
  for (std::size_t i = 0; i < points.size(); ++i) {
    SiteCurves site{static_cast<std::int32_t>(i), SiteStatus::Complete, "", 0, {}};
    const auto add = [&](PathKind kind, double depth, const Vec3& direction) {
      CurvePath path{kind, depth, direction, {}, 0, 0};
      for (int k = 0; k <= 4; ++k) {
        CurveSample sample;
        sample.displacement = 0.001 * k;
        const bool normal = kind == PathKind::Normal;
        sample.force = force(points[i], normal ? sample.displacement : depth,
                             normal ? 0 : sample.displacement);
        path.samples.push_back(sample);
      }
      site.paths.push_back(path);
    };
    add(PathKind::Normal, 0, kDown);
    for (const double depth : lateral_depths) add(PathKind::Lateral, depth, kTangent);
    curves.sites.push_back(site);
  }
  return curves;
}

Curves sampled_of(const std::vector<double>& stiffness, double lateral_depth) {
  Curves curves;
  for (std::size_t v = 0; v < stiffness.size(); ++v) {
    SiteCurves site{static_cast<std::int32_t>(v), SiteStatus::Complete, "", 0, {}};
    CurvePath normal{PathKind::Normal, 0, kDown, {}, 0, 0};
    for (int k = 0; k <= 4; ++k) {
      CurveSample sample;
      sample.displacement = 0.001 * k;
      sample.force = stiffness[v] * sample.displacement * kDown;
      normal.samples.push_back(sample);
    }
    site.paths = {normal, {PathKind::Lateral, lateral_depth, kTangent, {}, 0, 0}};
    curves.sites.push_back(site);
  }
  return curves;
}

Fidelity measure_on(const Library& library, const std::vector<HoldOutPoint>& points,
                    const Curves& direct, const Curves& sampled) {
  const samples::TemporaryFolder folder;
  const auto file = folder / "library.h5";
  write_library(file, library);
  return measure({library, RenderedBody(file), points, direct, sampled}, {1e-6, 0.3});
}

const ErrorRow& row(const Fidelity& fidelity, const std::string& what, const std::string& part) {
  const auto found =
      std::find_if(fidelity.rows.begin(), fidelity.rows.end(),
                   [&](const ErrorRow& r) { return r.what == what && r.part == part; });
  if (found == fidelity.rows.end()) throw std::runtime_error("no row " + what + ", " + part);
  return *found;
}

Vec3 linear(double normal, double lateral) {
  return normal * kDown + lateral * kTangent;
}

TEST(Fidelity, IsZeroWhereTheSolidIsTheModel) {
  const Library library = even_plate();
  const auto points = draw_points(library, 12, 3, 7);
  const auto direct =
      direct_of(points, {0.002, 0.004}, [](const HoldOutPoint&, double z, double rho) {
        return linear(kNormal * z, kLateral * rho);
      });
  const Fidelity fidelity =
      measure_on(library, points, direct, sampled_of({120, 120, 120, 120}, 0.002));
  EXPECT_TRUE(fidelity.left_out.empty());
  EXPECT_EQ(fidelity.states.size(), 15u * (4 + 2 * 4));
  for (const ErrorRow& r : fidelity.rows) EXPECT_LT(r.worst, 1e-6) << r.what << ", " << r.part;
}

TEST(Fidelity, AStiffnessErrorAppearsInTheNormalPart) {
  const Library library = even_plate();
  const auto points = draw_points(library, 5, 2, 7);
  const auto direct = direct_of(points, {0.004}, [](const HoldOutPoint&, double z, double rho) {
    return linear(1.25 * kNormal * z, kLateral * rho);
  });
  const Fidelity fidelity =
      measure_on(library, points, direct, sampled_of({120, 120, 120, 120}, 0.004));
  for (const char* what : {"normal press, off node", "normal press, at node"}) {
    EXPECT_NEAR(row(fidelity, what, "normal").median, 0.2, 1e-6);
    EXPECT_NEAR(row(fidelity, what, "normal").worst, 0.2, 1e-6);
    EXPECT_NEAR(row(fidelity, what, "direction").worst, 0, 1e-6);
  }
  // At a depth of 4 mm, 0.12 N are missing of sqrt(0.6^2 + (80 * 1 to 4 mm)^2) N.
  const ErrorRow& oblique = row(fidelity, "oblique press, off node", "normal");
  EXPECT_NEAR(oblique.worst, 0.12 / std::hypot(0.6, 0.08), 1e-6);
  EXPECT_NEAR(oblique.worst_newton, 0.12, 1e-6);
  EXPECT_NEAR(row(fidelity, "oblique press, off node", "lateral").worst, 0, 1e-6);
  EXPECT_NEAR(row(fidelity, "interpolation of the samples, off node", "normal").worst, 0.2, 1e-6);
}

TEST(Fidelity, AForceNormalToThePlaneOfTheModelAppearsInTheDirectionPart) {
  const Library library = even_plate();
  const auto points = draw_points(library, 4, 0, 7);
  const Vec3 across{-0.8, 0.6, 0};
  const auto direct = direct_of(points, {0.003}, [&](const HoldOutPoint&, double z, double rho) {
    return linear(kNormal * z, kLateral * rho) + 0.05 * across;
  });
  const Fidelity fidelity =
      measure_on(library, points, direct, sampled_of({120, 120, 120, 120}, 0.003));
  EXPECT_NEAR(row(fidelity, "oblique press, off node", "direction").worst_newton, 0.05, 1e-6);
  EXPECT_NEAR(row(fidelity, "normal press, off node", "direction").worst,
              0.05 / std::hypot(0.12, 0.05), 1e-6);
  EXPECT_NEAR(row(fidelity, "oblique press, off node", "lateral").worst, 0, 1e-6);
  EXPECT_NEAR(row(fidelity, "interpolation of the samples, off node", "direction").worst_newton,
              0.05, 1e-9);
}

TEST(Fidelity, InterpolatedTransverseForcesHaveARowOfTheirOwn) {
  // A transverse force proportional to the depth, half as large at the vertices as between them.
  const Library library = even_plate();
  const auto points = draw_points(library, 4, 0, 7);
  const Vec3 across{-0.8, 0.6, 0};
  const auto direct = direct_of(points, {}, [&](const HoldOutPoint&, double z, double) {
    return linear(kNormal * z, 0) + 20 * z * across;
  });
  Curves sampled = sampled_of({120, 120, 120, 120}, 0.003);
  for (SiteCurves& site : sampled.sites)
    for (CurveSample& sample : site.paths[0].samples)
      sample.force = sample.force + 10 * sample.displacement * across;
  const Fidelity fidelity = measure_on(library, points, direct, sampled);
  const ErrorRow& left = row(fidelity, "interpolation of the samples, off node", "direction");
  EXPECT_NEAR(left.worst_newton, 0.04, 1e-9);
  EXPECT_NEAR(left.median, 10 / std::hypot(120.0, 20.0), 1e-6);
  EXPECT_NEAR(row(fidelity, "normal press, off node", "direction").median,
              20 / std::hypot(120.0, 20.0), 1e-6);
}

TEST(Fidelity, TheDecouplingRowIsTheErrorOfOneLateralResponseForAllDepths) {
  // The stiffness of a bonded contact is proportional to the contact radius, hence to sqrt(depth).
  const double reference = 0.004;
  const Library library = even_plate();
  const auto points = draw_points(library, 3, 0, 7);
  const auto direct =
      direct_of(points, {0.001, reference}, [&](const HoldOutPoint&, double z, double rho) {
        return linear(kNormal * z, kLateral * rho * std::sqrt(z / reference));
      });
  const Fidelity fidelity =
      measure_on(library, points, direct, sampled_of({120, 120, 120, 120}, reference));
  const ErrorRow& lateral = row(fidelity, "decoupling of f^r from depth", "lateral");
  EXPECT_EQ(lateral.states, 3u * 2 * 4);
  EXPECT_NEAR(lateral.median, 0, 1e-9);  // half of the states are at the reference depth
  EXPECT_NEAR(lateral.worst_newton, 0.5 * kLateral * 0.004, 1e-6);
  EXPECT_NEAR(lateral.worst, 0.16 / std::hypot(kNormal * 0.001, 0.16), 1e-6);
  EXPECT_NEAR(row(fidelity, "decoupling of f^z from lateral", "normal").worst, 0, 1e-9);
  // The library has the response of the reference depth, so the rendered force has the same error.
  EXPECT_NEAR(row(fidelity, "oblique press, off node", "lateral").worst, lateral.worst, 1e-6);
  // Within friction is 1 mm at the reference depth alone.
  EXPECT_EQ(row(fidelity, "oblique within friction, off node", "lateral").states, 3u);
  EXPECT_NEAR(row(fidelity, "oblique within friction, off node", "lateral").worst, 0, 1e-6);
}

TEST(Fidelity, SeparatesInterpolationFromTheFit) {
  // Samples of 100 to 160 N/m; the library was fitted 10 % too stiff; the solid between the nodes
  // is 5 % stiffer than the interpolated samples.
  const std::vector<double> k{100, 120, 140, 160};
  const Library library = plate({110, 132, 154, 176});
  const auto points = draw_points(library, 6, 0, 3);
  const auto between = [&](const HoldOutPoint& p) {
    double sum = 0;
    for (std::size_t l = 0; l < 3; ++l) {
      const std::int32_t v = library.triangles[static_cast<std::size_t>(p.triangle)][l];
      sum += p.natural[l] * k[static_cast<std::size_t>(v)];
    }
    return sum;
  };
  const auto direct = direct_of(points, {}, [&](const HoldOutPoint& p, double z, double) {
    return linear(1.05 * between(p) * z, 0);
  });
  const Fidelity fidelity = measure_on(library, points, direct, sampled_of(k, 0.003));
  const ErrorRow& interpolation = row(fidelity, "interpolation of the samples, off node", "normal");
  EXPECT_NEAR(interpolation.median, 0.05 / 1.05, 1e-6);
  EXPECT_NEAR(interpolation.worst, 0.05 / 1.05, 1e-6);
  EXPECT_NEAR(row(fidelity, "normal press, off node", "normal").median, 0.05 / 1.05, 1e-6);
}

TEST(Fidelity, AFailedPressIsReportedAndLeftOut) {
  const Library library = even_plate();
  const auto points = draw_points(library, 2, 0, 7);
  auto direct = direct_of(
      points, {}, [](const HoldOutPoint&, double z, double) { return linear(kNormal * z, 0); });
  direct.sites[1].status = SiteStatus::Failed;
  direct.sites[1].reason = "did not converge";
  direct.sites[1].paths.clear();
  const Fidelity fidelity =
      measure_on(library, points, direct, sampled_of({120, 120, 120, 120}, 0.003));
  ASSERT_EQ(fidelity.left_out.size(), 1u);
  EXPECT_EQ(fidelity.left_out[0], "point 1: did not converge");
  EXPECT_EQ(fidelity.states.size(), 4u);
}

/// A body a thousand times softer has the same relative errors, its floor included.
TEST(RelativeFloor, FollowsTheForcesOfTheBody) {
  const std::vector<HoldOutPoint> points(5);
  const auto linear = [](double stiffness) {
    return [stiffness](const HoldOutPoint&, double depth, double) {
      return stiffness * depth * kDown;
    };
  };
  // The deepest sample is at 4 mm; lateral paths run at 9 mm and do not count.
  const Curves stiff = direct_of(points, {0.009}, linear(kNormal));
  const Curves soft = direct_of(points, {0.009}, linear(1e-3 * kNormal));
  EXPECT_NEAR(relative_floor(stiff, 0.01), 0.01 * kNormal * 0.004, 1e-12);
  EXPECT_NEAR(relative_floor(soft, 0.01), 1e-3 * relative_floor(stiff, 0.01), 1e-15);
}

TEST(RelativeFloor, IsNoneWithoutAPress) {
  EXPECT_EQ(relative_floor(Curves{}, 0.01), 0);
}

}  // namespace
}  // namespace palpate::fidelity
