// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fitting/certificate/certify.hpp"
#include "fitting/certificate/soften.hpp"
#include "fitting/certificate/triangle_frame.hpp"
#include "format/error.hpp"
#include "tests/support/surfaces.hpp"

namespace palpate::fitting {
namespace {

CertifySettings with_friction(double mu) {
  CertifySettings settings;
  settings.friction = mu;
  return settings;
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

TEST(Certificate, SphereTurnsByOneOverItsRadius) {
  constexpr double kRadius = 0.04;
  double last_excess = 1;
  for (const int level : {1, 2, 3}) {
    const Library library = sphere(kRadius, level);
    double largest = 0;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t m = 0; m < library.triangles.size(); ++m) {
      const TriangleFrame frame = triangle_frame(library, m);
      largest = std::max(largest, frame.kappa);
      smallest = std::min(smallest, frame.kappa);
      // u is radial, so n turns by 1/|U| over R, and |U| is the cosine of the opening at least.
      EXPECT_NEAR(frame.kappa, 1 / (kRadius * frame.least_length), 1e-6 / kRadius);
      EXPECT_NEAR(frame.least_length, frame.cos_theta, 1e-9);
      EXPECT_LT(frame.twist, 0.5 * frame.kappa);  // a sphere turns along the slide only
    }
    EXPECT_GE(smallest, 1 / kRadius * (1 - 1e-12));
    const double excess = largest * kRadius - 1;
    EXPECT_LT(excess, 0.4 * last_excess);  // second order in the edge length
    last_excess = excess;
  }
  EXPECT_LT(last_excess, 0.02);
}

TEST(Certificate, GradientsReproduceALinearField) {
  const Library library = sphere(0.04, 1);
  const Vec3 slope{3, -2, 5};
  for (std::size_t m = 0; m < library.triangles.size(); ++m) {
    const TriangleFrame frame = triangle_frame(library, m);
    Vec3 gradient{};
    for (std::size_t l = 0; l < 3; ++l) {
      const Vec3& x = library.positions[static_cast<std::size_t>(library.triangles[m][l])];
      gradient = gradient + dot(slope, x) * frame.gradient[l];
    }
    for (const std::int32_t v : library.triangles[m]) {
      const Vec3 edge = library.positions[static_cast<std::size_t>(v)] -
                        library.positions[static_cast<std::size_t>(library.triangles[m][0])];
      EXPECT_NEAR(dot(gradient, edge), dot(slope, edge), 1e-12);
    }
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
  settings.devices.push_back({"viscous", 0.081, 0.01, 10, ""});
  certify(library, settings);
  ASSERT_EQ(library.certificate.devices.size(), 1u);
  const DeviceCertificate& device = library.certificate.devices[0];
  EXPECT_NEAR(device.lowest_rate, 2 * 162 / 0.081, 1e-9);  // 4 kHz
  EXPECT_NEAR(device.linear_limit, 54, 1e-9);
  EXPECT_NEAR(device.no_delay_limit, 162, 1e-9);
  EXPECT_EQ(verdict(library.certificate, device), "certified passive from 4000 Hz");
  for (const double refused : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    settings.devices[0].damping = refused;
    EXPECT_THROW(certify(library, settings), Error);
  }
}

TEST(Certificate, ADeviceOfUnknownDampingIsNotCertifiedAndSaid) {
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
  EXPECT_EQ(verdict(library.certificate, device), "damping unknown: not certified for this device");
}

TEST(Certificate, AHoleIsABorder) {
  Library library = sphere(0.04, 1);
  set_equal_responses(library, node_response(linear_curve(100, 0.001), linear_curve(80)));
  library.responses[7] = NodeResponse{};
  library.responses[9].status = ResponseStatus::Filled;
  certify(library, with_friction(0.3));
  EXPECT_EQ(library.certificate.holes, 1);
  EXPECT_EQ(library.certificate.filled, 1);
  for (std::size_t m = 0; m < library.triangles.size(); ++m) {
    const Triangle& t = library.triangles[m];
    const bool touches = t[0] == 7 || t[1] == 7 || t[2] == 7;
    EXPECT_EQ(library.certificate.triangles[m].stick == 0, touches);
  }
}

TEST(Certificate, DepthBeyondTheRadiusOfCurvatureHasNoBoundAndAReason) {
  // Slides outrun the tool where D kappa reaches cos theta: R = 5 mm pressed by 10 mm.
  Library library = sphere(0.005, 2);
  set_equal_responses(library, node_response(linear_curve(100), linear_curve(80)));
  CertifySettings settings = with_friction(0.3);
  settings.devices.push_back({"viscous", 0.081, 0.01, 10, ""});
  certify(library, settings);
  // The runtime holds such slides back: to 4 L_stick of its own accord, to |M_0| when told.
  EXPECT_NEAR(library.certificate.hold, 100 * std::hypot(1, 0.3), 1e-9);
  EXPECT_DOUBLE_EQ(library.certificate.limit, 400);
  EXPECT_DOUBLE_EQ(library.certificate.devices.at(0).lowest_rate, 2 * 400 / 0.081);
  EXPECT_EQ(verdict(library.certificate, library.certificate.devices.at(0)),
            "certified passive from 9877 Hz; from 2578 Hz when slides are held back to 104.5 N/m "
            "(lipschitz_bound)");
  EXPECT_TRUE(std::isinf(library.certificate.slip));
  const std::string& line = library.certificate.limited_by;
  EXPECT_NE(line.find("no bound of the slide: pressed 10 mm deep"), std::string::npos) << line;
  EXPECT_NE(line.find("(try a smaller patch spacing, a rounder edge"), std::string::npos) << line;
  EXPECT_EQ(line.find("inf"), std::string::npos) << line;
  EXPECT_NE(line.find("320 of 320 triangles have no bound"), std::string::npos) << line;
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

TEST(Certificate, ACoupledResponseThatIsFlatWhereSlipBeginsCannotBeHeld) {
  // On the plateau the slip limit jumps by 2 mm, and with it H(rho_s) in the normal force.
  const ResponseCurve plateau{{0.0f, 0.001f, 0.002f, 0.003f, 0.004f}, {90, 0, 0, 90, 90}};
  const ResponseCurve rising{{0.0f, 0.001f, 0.002f, 0.003f, 0.004f}, {90, 20, 20, 90, 90}};
  CertifySettings settings = with_friction(0.3);
  settings.devices.push_back({"viscous", 0.081, 0.01, 10, ""});
  for (const bool flat : {false, true}) {
    Library library = flat_triangle();
    library.kind = ResponseKind::Coupled;
    set_equal_responses(library, node_response(linear_curve(100), flat ? plateau : rising));
    for (NodeResponse& node : library.responses)
      node.coupling = {0.5F, {{0.0F, 0.005F, 0.01F}, {0, 60, 0}}};
    certify(library, settings);
    EXPECT_EQ(std::isinf(library.certificate.hold), flat);
    if (!flat) {
      // A w that goes on growing lets the lateral stiffness grow with it: held at no depth.
      Library growing = library;
      for (NodeResponse& node : growing.responses) node.coupling.curve.slope.back() = 20;
      certify(growing, settings);
      EXPECT_TRUE(std::isinf(growing.certificate.hold));
    }
    EXPECT_LE(library.certificate.stick, library.certificate.hold);
    EXPECT_LE(library.certificate.limit, 4 * library.certificate.hold);
    EXPECT_EQ(std::isinf(library.certificate.devices.at(0).lowest_rate), flat);
    if (flat) {
      EXPECT_EQ(verdict(library.certificate, library.certificate.devices.at(0)),
                "not certified: the slide has no bound");
    }
  }
}

TEST(Certificate, IsOfTheLimitThatWasChosen) {
  Library library = sphere(0.005, 2);
  set_equal_responses(library, node_response(linear_curve(100), linear_curve(80)));
  CertifySettings settings = with_friction(0.3);
  settings.devices.push_back({"viscous", 0.081, 0.01, 10, ""});
  settings.enforced_bound = 110;  // above L_hold
  certify(library, settings);
  EXPECT_DOUBLE_EQ(library.certificate.devices.at(0).lowest_rate, 2 * 110 / 0.081);
  settings.enforced_bound = 101;  // below: the runtime could not keep it
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
  EXPECT_TRUE(library.certificate.triangles.empty());  // nothing half-done
  library = flat_triangle();
  set_equal_responses(library, node_response(linear_curve(100), linear_curve(80)));
  library.positions[2] = {0.02, 0, 0};
  EXPECT_THROW(certify(library, {}), Error);
}

TEST(Certificate, LeastLengthIsTheDistanceToTheTriangleOfDirections) {
  // Against a search over a fine grid of natural coordinates.
  std::mt19937 engine(23);
  std::normal_distribution<double> lean(0, 0.5);
  for (int trial = 0; trial < 30; ++trial) {
    Library library = flat_triangle();
    for (Vec3& u : library.inward) u = unit({lean(engine), lean(engine), -1});
    double least = 1;
    for (int i = 0; i <= 200; ++i) {
      for (int j = 0; j <= 200 - i; ++j) {
        const double a = i / 200.0;
        const double b = j / 200.0;
        least = std::min(least, norm(a * library.inward[0] + b * library.inward[1] +
                                     (1 - a - b) * library.inward[2]));
      }
    }
    if (least < 0.51) continue;
    const double exact = triangle_frame(library, 0).least_length;
    EXPECT_LE(exact, least + 1e-12);
    EXPECT_NEAR(exact, least, 1e-4);
  }
}

TEST(Soften, ScalesWithTheForces) {
  // Bounds are homogeneous: half the forces, half the bounds.
  std::mt19937 engine(7);
  Library library = sphere(0.04, 1);
  for (std::size_t v = 0; v < library.positions.size(); ++v)
    library.responses.push_back(random_response(engine, 0.1));
  Library half = library;
  for (NodeResponse& node : half.responses)
    for (ResponseCurve* curve : {&node.normal, &node.lateral})
      for (float& slope : curve->slope) slope *= 0.5F;
  certify(library, {});
  certify(half, {});
  ASSERT_TRUE(std::isfinite(library.certificate.slip));
  EXPECT_NEAR(half.certificate.stick, 0.5 * library.certificate.stick, 1e-6);
  EXPECT_NEAR(half.certificate.slip, 0.5 * library.certificate.slip,
              0.03 * library.certificate.slip);  // cells are halved to 2 %
  EXPECT_DOUBLE_EQ(certifiable_stiffness(0.081, 2000),
                   81);  // b/(2T), [Mahvash & Hayward 2005, eq. 5]
}

TEST(Soften, MeetsTheBoundAndTakesOnlyWhatIsStiff) {
  Library library = flat_triangle();
  const ResponseCurve soft{{0.0F, 0.008F}, {0.0F, 60.0F}};
  const ResponseCurve stiff{{0.0F, 0.004F, 0.008F}, {0.0F, 60.0F, 400.0F}};
  library.responses = {node_response(soft, linear_curve(50)), node_response(soft, linear_curve(50)),
                       node_response(stiff, linear_curve(50))};
  CertifySettings settings;
  settings.friction = 0;
  Library same = library;
  EXPECT_EQ(soften(same, settings, 1e5).curves, 0u);
  EXPECT_EQ(same.responses[2].normal.slope, stiff.slope);

  const Softening cost = soften(library, settings, 150);
  EXPECT_LE(library.certificate.hold, 150);
  EXPECT_GE(library.certificate.hold, 145);  // no more than needed
  EXPECT_DOUBLE_EQ(library.certificate.limit, 150);
  EXPECT_EQ(cost.curves, 1u);
  EXPECT_EQ(library.responses[0].normal.slope, soft.slope);
  EXPECT_EQ(library.responses[2].normal.slope[1], 60.0F);
  EXPECT_EQ(library.responses[2].normal.slope[2], static_cast<float>(cost.max_slope));
  // f(8 mm) = 0.12 + 0.004 (60 + s)/2 N
  EXPECT_NEAR(cost.worst, 1 - (0.12 + 0.002 * (60 + cost.max_slope)) / (0.12 + 0.002 * 460), 1e-6);
}

TEST(Soften, HoldsSlidesBackBeforeItSoftens) {
  // Directions that turn within less than the depth: no bound of the slide, however soft.
  Library library = sphere(0.005, 1);
  set_equal_responses(library, node_response(linear_curve(100), linear_curve(80)));
  const Library before = library;
  EXPECT_EQ(soften(library, with_friction(0.3), 120).curves, 0u);
  EXPECT_TRUE(std::isinf(library.certificate.slip));
  EXPECT_DOUBLE_EQ(library.certificate.limit, 120);
  for (std::size_t v = 0; v < before.responses.size(); ++v)
    EXPECT_EQ(library.responses[v].normal.slope, before.responses[v].normal.slope);
  EXPECT_GT(soften(library, with_friction(0.3), 80).curves, 0u);
  EXPECT_LE(library.certificate.hold, 80);
  EXPECT_DOUBLE_EQ(library.certificate.limit, 80);
}

TEST(Soften, SaysWhenNothingHelps) {
  // A bound below a hundredth of the slopes.
  Library library = sphere(0.005, 1);
  set_equal_responses(library, node_response(linear_curve(100), linear_curve(80)));
  EXPECT_ANY_THROW(soften(library, {}, 0.5));
  EXPECT_EQ(library.responses[0].normal.slope[0], 100.0F);
}

}  // namespace
}  // namespace palpate::fitting
