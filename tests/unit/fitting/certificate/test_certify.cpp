// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "fitting/certificate/certify.hpp"
#include "format/error.hpp"
#include "format/guarantee.hpp"
#include "tests/support/surfaces.hpp"

namespace palpate::fitting {
namespace {

CertifySettings with_friction(double mu) {
  CertifySettings settings;
  settings.friction = mu;
  return settings;
}

/// A device of which everything is known.
DeviceProfile viscous() {
  return {.name = "viscous",
          .damping = 0.081,
          .coulomb_friction = 0.01,
          .peak_force = 10,
          .source = "",
          .delay = 0,
          .position_resolution = 0,
          .force_resolution = 0};
}

TEST(Certificate, FlatPlateOfEqualSpringsHasTheClosedForm) {
  // Nothing changes along the surface and nothing turns: L_stick = k, and at limiting friction the
  // force grows along n + mu t, whose length is sqrt(1 + mu^2).
  for (const double mu : {0.0, 0.3, 1.0}) {
    Library library = flat_triangle();
    set_equal_responses(library, node_response(linear_curve(200), linear_curve(200)));
    certify(library, with_friction(mu));
    const TriangleCertificate& bound = library.certificate.triangles.at(0);
    EXPECT_DOUBLE_EQ(bound.stick, 200);
    EXPECT_NEAR(bound.slip, 200 * std::sqrt(1 + mu * mu), 1e-9);
    EXPECT_NEAR(bound.kappa, 0, 1e-12);
    EXPECT_NEAR(bound.cos_theta, 1, 1e-12);
    EXPECT_NE(library.certificate.limited_by.find("stiffest response"), std::string::npos);
    if (mu == 0) continue;
    EXPECT_TRUE(bound.sliding_passive);
    EXPECT_NE(library.certificate.limited_by.find("while sliding"), std::string::npos);
  }
}

TEST(Certificate, StickIsTheSteepestStoredSlopeOfTheTriangle) {
  Library library = sphere(0.04, 1);
  set_equal_responses(library, node_response(linear_curve(100), linear_curve(80)));
  library.responses[5].normal = {{0.0f, 0.004f, 0.008f}, {0.0f, 300.0f, 50.0f}};
  certify(library, with_friction(0.2));
  for (std::size_t m = 0; m < library.triangles.size(); ++m) {
    const Triangle& t = library.triangles[m];
    const bool touches = t[0] == 5 || t[1] == 5 || t[2] == 5;
    EXPECT_DOUBLE_EQ(library.certificate.triangles[m].stick, touches ? 300 : 100);
  }
  EXPECT_DOUBLE_EQ(library.certificate.stick, 300);
  const Triangle& worst =
      library.triangles[static_cast<std::size_t>(library.certificate.worst_triangle)];
  EXPECT_TRUE(worst[0] == 5 || worst[1] == 5 || worst[2] == 5);
}

TEST(Certificate, RateOfADeviceFollowsTheWorstBound) {
  Library library = flat_triangle();
  set_equal_responses(library, node_response(linear_curve(162), linear_curve(162)));
  CertifySettings settings = with_friction(0);
  settings.devices.push_back(viscous());
  certify(library, settings);
  ASSERT_EQ(library.certificate.devices.size(), 1u);
  const DeviceCertificate& device = library.certificate.devices[0];
  EXPECT_NEAR(device.lowest_rate, 1.5 * 162 / 0.081, 1e-9);   // 3 kHz
  EXPECT_NEAR(device.published_rate, 2 * 162 / 0.081, 1e-9);  // 4 kHz
  EXPECT_NEAR(device.largest_position_step, 2 * 0.01 / (std::sqrt(3.0) * 162), 1e-15);
  EXPECT_NEAR(device.linear_limit, 54, 1e-9);
  EXPECT_NEAR(device.no_delay_limit, 162, 1e-9);
  EXPECT_EQ(
      verdict(library.certificate, device),
      "certified passive from 3000 Hz on, by the curves themselves (Mahvash & Hayward 2005, eq. 5: "
      "4000 Hz)");
  for (const double refused : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    settings.devices[0].damping = refused;
    EXPECT_THROW(certify(library, settings), Error);
  }
}

TEST(Certificate, ADeviceOfUnknownDampingIsNotCertified) {
  Library library = flat_triangle();
  set_equal_responses(library, node_response(linear_curve(162), linear_curve(162)));
  CertifySettings settings = with_friction(0);
  settings.devices.emplace_back();  // of which nothing is known
  settings.devices.back().name = "unknown";
  certify(library, settings);
  ASSERT_EQ(library.certificate.devices.size(), 1u);
  const DeviceCertificate& device = library.certificate.devices[0];
  EXPECT_EQ(device.device, "unknown");
  for (const double value :
       {device.damping, device.lowest_rate, device.linear_limit, device.no_delay_limit}) {
    EXPECT_TRUE(std::isnan(value)) << value;
  }
  EXPECT_EQ(
      verdict(library.certificate, device),
      "no guarantee: its damping, delay, dry friction, position resolution and force resolution "
      "are unknown");
}

TEST(Certificate, NamesTheConstantThatIsMissing) {
  Library library = flat_triangle();
  set_equal_responses(library, node_response(linear_curve(162), linear_curve(162)));
  CertifySettings settings = with_friction(0);
  settings.devices.push_back(viscous());
  settings.devices[0].coulomb_friction = kUnknown;
  certify(library, settings);
  EXPECT_EQ(verdict(library.certificate, library.certificate.devices[0]),
            "no guarantee: its dry friction is unknown; its damping suffices from 3000 Hz on");
  settings.devices[0] = viscous();
  settings.devices[0].delay = kUnknown;
  certify(library, settings);
  EXPECT_EQ(verdict(library.certificate, library.certificate.devices[0]),
            "no guarantee: its delay is unknown");
}

TEST(Certificate, AHoleIsABorder) {
  Library library = sphere(0.04, 1);
  set_equal_responses(library, node_response(linear_curve(100, 0.001), linear_curve(80)));
  library.responses[7] = NodeResponse{};
  library.responses[9].status = ResponseStatus::Interpolated;
  certify(library, with_friction(0.3));
  EXPECT_EQ(library.certificate.holes, 1);
  EXPECT_EQ(library.certificate.interpolated, 1);
  for (std::size_t m = 0; m < library.triangles.size(); ++m) {
    const Triangle& t = library.triangles[m];
    const bool touches = t[0] == 7 || t[1] == 7 || t[2] == 7;
    EXPECT_EQ(library.certificate.triangles[m].stick == 0, touches);
  }
}

TEST(Certificate, DepthBeyondTheRadiusOfCurvatureHasNoBoundAndAReason) {
  // A slide moves farther than the tool where D kappa reaches cos theta: R = 5 mm, D = 10 mm.
  Library library = sphere(0.005, 2);
  set_equal_responses(library, node_response(linear_curve(100), linear_curve(80)));
  CertifySettings settings = with_friction(0.3);
  settings.devices.push_back(viscous());
  certify(library, settings);
  // The runtime rate-limits such slides: to 4 L_stick by default, to |M_0| on request.
  EXPECT_NEAR(library.certificate.min_lipschitz_bound, 100 * std::hypot(1, 0.3), 1e-9);
  EXPECT_DOUBLE_EQ(library.certificate.lipschitz_bound, 400);
  EXPECT_NEAR(library.certificate.devices.at(0).lowest_rate, 1.5 * 400 / 0.081, 1e-9);
  EXPECT_EQ(verdict(library.certificate, library.certificate.devices.at(0)),
            "certified passive from 7408 Hz on, with slides rate-limited; from 1934 Hz on with "
            "lipschitz_bound = 104.5 N/m (Mahvash & Hayward 2005, eq. 5: 9877 Hz)");
  EXPECT_TRUE(std::isinf(library.certificate.slip));
  const std::string& line = library.certificate.limited_by;
  EXPECT_NE(line.find("no bound of the slide: pressed 10.0 mm deep"), std::string::npos) << line;
  EXPECT_NE(line.find("(try a smaller patch spacing, a rounder edge"), std::string::npos) << line;
  EXPECT_EQ(line.find("inf"), std::string::npos) << line;
  EXPECT_NE(line.find("320 of 320 triangles have no bound; down to "), std::string::npos) << line;
  EXPECT_NE(line.find(" mm every slide has a bound"), std::string::npos) << line;
  settings.slide_remedy = "other directions";
  certify(library, settings);
  EXPECT_NE(line.find("(try other directions, a smaller patch"), std::string::npos) << line;
}

/// Why the only triangle of a plate has no smaller bound.
std::string limit_of_plate(double lean, const std::array<double, 3>& stiffness) {
  Library library = flat_triangle();
  library.inward.assign(3, {std::sin(lean), 0, -std::cos(lean)});
  set_equal_responses(library, node_response(linear_curve(200), linear_curve(200)));
  for (std::size_t v = 0; v < 3; ++v)
    library.responses[v] = node_response(linear_curve(stiffness[v]), linear_curve(200));
  certify(library, with_friction(0.3));
  return library.certificate.limited_by;
}

TEST(Certificate, NamesTheLargestCauseOfABound) {
  // On a plate of equal springs only the slant of the press directions adds to the stiffness; on a
  // level plate of different springs only their change; on a ball of equal springs the curvature.
  const std::array<double, 3> equal{600, 600, 600};
  EXPECT_NE(limit_of_plate(0.01, equal).find("stiffest response"), std::string::npos);
  EXPECT_NE(limit_of_plate(0.7, equal).find("oblique to the facet"), std::string::npos);
  EXPECT_NE(limit_of_plate(0, {50, 100, 200}).find("change of the responses"), std::string::npos);
  Library ball = sphere(0.03, 1);
  set_equal_responses(ball, node_response(linear_curve(100, 0.02), linear_curve(100, 0.02)));
  certify(ball, with_friction(0.3));
  EXPECT_NE(ball.certificate.limited_by.find("the curvature of the normals"), std::string::npos)
      << ball.certificate.limited_by;
}

TEST(Certificate, ACoupledResponseThatDoesNotChangeWithDepthStiffensNothing) {
  // E = G(z) + H(rho), so that the steepest force at a fixed contact point is the stiffer spring.
  for (const double lateral : {120.0, 260.0}) {
    Library library = flat_triangle();
    library.kind = ResponseKind::Coupled;
    set_equal_responses(library, node_response(linear_curve(200), linear_curve(lateral)));
    for (NodeResponse& node : library.responses)
      node.coupling = {1.0F, {{0.0F, 0.005F, 0.01F}, {0, 0, 0}}};
    certify(library, with_friction(0.3));
    EXPECT_NEAR(library.certificate.stick, std::max(200.0, lateral), 1e-6);
  }
}

TEST(Certificate, RelaxationRateIsThatOfTheFastestNodeTimesTheCouplingByFriction) {
  // Friction carries the change of the normal force over to the lateral one, which has one of its
  // own, (C10): the factor m is the larger root of m^2 - (2 + mu^2) m + 1 = 0.
  for (const bool coupled : {false, true}) {
    for (const double mu : {0.0, 0.3, 1.5}) {
      Library library = flat_triangle();
      library.relaxation_times = {0.1, 2.0};
      set_equal_responses(library, node_response(linear_curve(100), linear_curve(100)));
      for (NodeResponse& node : library.responses) node.relaxation = {0.2f, 0.1f};
      library.responses[1].relaxation = {0.25f, 0.5f};
      if (coupled) {
        library.kind = ResponseKind::Coupled;
        for (NodeResponse& node : library.responses)
          node.coupling = {1.0F, {{0.0F, 0.005F, 0.01F}, {0, 0, 0}}};
      }
      certify(library, with_friction(mu));
      const double m = library.certificate.relaxation_rate / (0.25 / 0.1 + 0.5 / 2.0);
      EXPECT_NEAR(m * m - (2 + mu * mu) * m + 1, 0, 1e-6);
      EXPECT_GE(m, 1 - 1e-9);
    }
  }
}

TEST(Certificate, AFlatLateralResponseIsUnboundedWhereTheSurfaceVaries) {
  // Where the lateral force does not grow, the contact point jumps: harmless where all points are
  // alike, without bound where they are not.
  Library library = flat_triangle();
  const ResponseCurve plateau{{0.0f, 0.001f, 0.002f, 0.003f, 0.004f}, {90, 0, 0, 90, 90}};
  set_equal_responses(library, node_response(linear_curve(100), plateau));
  certify(library, with_friction(0.3));
  EXPECT_NEAR(library.certificate.slip, 100 * std::hypot(1, 0.3), 1e-9);
  library.responses[1].normal = linear_curve(101);
  certify(library, with_friction(0.3));
  EXPECT_TRUE(std::isinf(library.certificate.slip));
  EXPECT_NE(library.certificate.limited_by.find("too flat"), std::string::npos);
}

TEST(Certificate, OnlyALateralStiffnessThatGrowsWithDepthWithoutLimitHasNoEnforceableBound) {
  // On the plateau the slip limit jumps by 2 mm: the force does not.
  const ResponseCurve plateau{{0.0f, 0.001f, 0.002f, 0.003f, 0.004f}, {90, 0, 0, 90, 90}};
  const ResponseCurve rising{{0.0f, 0.001f, 0.002f, 0.003f, 0.004f}, {90, 20, 20, 90, 90}};
  CertifySettings settings = with_friction(0.3);
  settings.devices.push_back(viscous());
  for (const ResponseCurve& lateral : {rising, plateau}) {
    Library library = flat_triangle();
    library.kind = ResponseKind::Coupled;
    set_equal_responses(library, node_response(linear_curve(100), lateral));
    for (NodeResponse& node : library.responses)
      node.coupling = {0.5F, {{0.0F, 0.005F, 0.01F}, {0, 60, 0}}};
    certify(library, settings);
    EXPECT_TRUE(std::isfinite(library.certificate.min_lipschitz_bound));
    EXPECT_LE(library.certificate.stick, library.certificate.min_lipschitz_bound);
    EXPECT_LE(library.certificate.lipschitz_bound, 4 * library.certificate.min_lipschitz_bound);
    EXPECT_TRUE(std::isfinite(library.certificate.devices.at(0).lowest_rate));
    for (NodeResponse& node : library.responses) node.coupling.curve.slope.back() = 20;
    certify(library, settings);
    EXPECT_TRUE(std::isinf(library.certificate.min_lipschitz_bound));
  }
}

TEST(Certificate, AppliesToTheEnforcedBoundThatIsSet) {
  Library library = sphere(0.005, 2);
  set_equal_responses(library, node_response(linear_curve(100), linear_curve(80)));
  CertifySettings settings = with_friction(0.3);
  settings.devices.push_back(viscous());
  settings.enforced_bound = 110;  // above L_min
  certify(library, settings);
  EXPECT_NEAR(library.certificate.devices.at(0).lowest_rate, 1.5 * 110 / 0.081, 1e-9);
  settings.enforced_bound = 101;  // below L_min: the runtime cannot enforce it
  certify(library, settings);
  EXPECT_TRUE(std::isinf(library.certificate.devices.at(0).lowest_rate));
}

TEST(Certificate, RefusesNormalsThatCannotBeInterpolated) {
  Library library = flat_triangle();
  set_equal_responses(library, node_response(linear_curve(100), linear_curve(80)));
  library.inward[1] = unit({1, 0, 0.05});  // out of the body
  try {
    certify(library, {});
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_NE(error.where().find("triangle 0"), std::string::npos);
    EXPECT_NE(error.problem().find("vertex 1"), std::string::npos);
    EXPECT_FALSE(error.remedy().empty());
  }
  // All point in, yet their mean is shorter than a half.
  library.inward = {unit({1, 0, -0.1}), unit({-0.5, 0.866, -0.1}), unit({-0.5, -0.866, -0.1})};
  EXPECT_THROW(certify(library, {}), Error);
  EXPECT_TRUE(library.certificate.triangles.empty());  // nothing was written
  library = flat_triangle();
  set_equal_responses(library, node_response(linear_curve(100), linear_curve(80)));
  library.positions[2] = {0.02, 0, 0};
  EXPECT_THROW(certify(library, {}), Error);
}

}  // namespace
}  // namespace palpate::fitting
