// SPDX-License-Identifier: AGPL-3.0-or-later
// Rows for what follows the finite elements: fit, certificate, passivity, energy account and the
// rendering of a library between its vertices.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "app/experiment/energy_balance.hpp"
#include "app/experiment/slingshot.hpp"
#include "fitting/certificate/certify.hpp"
#include "fitting/response/curve_fit.hpp"
#include "runtime/contact_state.hpp"
#include "runtime/devices/device_simulated.hpp"
#include "runtime/handles.hpp"
#include "runtime/response_curve.hpp"
#include "tests/support/bodies.hpp"
#include "tests/verification/record.hpp"

namespace palpate::test {
namespace {

TEST(Verification, FitOfHertzsLaw) {
  const std::string problem = "Fit of Hertz's law, 12 samples to 6 mm, tolerance 1 %";
  constexpr double kDepth = 0.006, kFactor = 124.0;  // m, N/m^1.5
  const auto hertz = [](double d) { return kFactor * std::pow(d, 1.5); };
  std::vector<fitting::ForceSample> samples;
  for (int i = 1; i <= 12; ++i) samples.push_back({kDepth * i / 12, hertz(kDepth * i / 12)});
  const auto fit = fitting::fit_curve(samples, {0.01, 1e-5, 12, true}, "Hertz");
  const runtime::CompiledCurve curve(fit.curve);
  for (const double d : {0.00175, 0.00375, 0.00575})  // between samples
    verify({problem, "force at " + std::to_string(1e3 * d).substr(0, 4) + " mm", "N",
            curve.force(d), hertz(d), Reference::ClosedForm, "C d^1.5 [Hertz 1881]", 0.02});
  verify({problem, "energy at 6 mm", "J", curve.energy(kDepth), 0.4 * kDepth * hertz(kDepth),
          Reference::ClosedForm, "2/5 d f", 0.01});
  verify({problem, "largest slope, which the certificate uses", "N/m", curve.max_slope(),
          1.5 * hertz(kDepth) / kDepth, Reference::ClosedForm, "3/2 f/d at the end", 0.05});
}

/// Largest |df|/|dx| of a tip that moves at random in contact with the plate.
double steepest_rendered(const palpate_library& body, double friction) {
  runtime::ContactState contact(body.surface, body.tree, {friction, 5e-3});
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vec3 x{0.04, 0.04, 1e-4}, force{};
  double largest = 0;
  for (int i = 0; i < 200000; ++i) {
    const Vec3 step = 2e-5 * Vec3{uniform(random), uniform(random), uniform(random)};
    const Vec3 next = x + step;
    if (next[2] < -0.015 || next[2] > 2e-4) continue;
    if (std::abs(next[0] - 0.04) > 0.02 || std::abs(next[1] - 0.04) > 0.02) continue;
    contact.step(next);
    const Vec3 changed = contact.observation().force;
    largest = std::max(largest, norm(changed - force) / norm(step));
    force = changed;
    x = next;
  }
  return largest;
}

TEST(Verification, CertificateOfAPlateOfSprings) {
  const std::string problem = "Certificate: plate of springs, 170 N/m into it and 120 N/m along it";
  constexpr double kFriction = 0.3;
  Library plate = test::plate(8, 0.08, [](const Vec3&) { return wall_response(170, 120); });
  fitting::certify(plate, {kFriction, {}});
  verify({problem, "L_stick", "N/m", plate.certificate.stick, 170, Reference::ClosedForm,
          "largest slope of two independent springs", 1e-3});
  verify({problem, "L_slip, mu = 0.3", "N/m", plate.certificate.slip,
          170 * std::hypot(1, kFriction), Reference::ClosedForm,
          "friction follows the normal force: k sqrt(1 + mu^2)", 0.05});
  const palpate_library body(plate);
  verify({problem, "largest change of the rendered force over the path, 200 000 random steps",
          "N/m", steepest_rendered(body, kFriction), 170 * std::hypot(1, kFriction),
          Reference::ClosedForm, "k sqrt(1 + mu^2)", 0.05});
}

TEST(Verification, EnergyAccountOnAPlate) {
  const std::string problem = "Energy account of a press and a slide on a plate, mu = 0.3";
  constexpr double k = 170, kFriction = 0.3, kDepth = 0.01, kWay = 0.03;
  const palpate_library body(plate(8, 0.08, [](const Vec3&) { return wall_response(k, 120); }));
  runtime::ContactState contact(body.surface, body.tree, {kFriction, 5e-3});
  constexpr double kStep = 1e-6;
  contact.step({0.02, 0.04, kStep});
  for (double z = 0; z < kDepth; z += kStep) contact.step({0.02, 0.04, -z});
  contact.step({0.02, 0.04, -kDepth});
  const double pressed = contact.observation().absorbed;
  verify({problem, "absorbed by the press to 10 mm", "J", pressed,
          k * (kDepth * kDepth / 2 - 0.0025 * kDepth + 0.005 * 0.005 / 6), Reference::ClosedForm,
          "integral of (34)", 1e-3});
  for (double s = kStep; s <= kWay; s += kStep) contact.step({0.02 + s, 0.04, -kDepth});
  const double normal = k * (kDepth - 0.0025), friction = kFriction * normal;
  const double strained = friction / 120;  // of the lateral spring, before it slips
  const double stored = friction * strained / 2;
  verify({problem, "absorbed by the slide of 30 mm", "J", contact.observation().absorbed - pressed,
          stored + friction * (kWay - strained), Reference::ClosedForm,
          "lateral spring to mu g, then mu g along the path", 2e-3});
}

/// Where the free oscillation of a mass on a sampled wall begins to grow, N/m.
double critical_stiffness(double damping, double period) {
  const auto grows = [&](double stiffness) {
    runtime::SimulatedDevice device(
        {.mass = 400 * stiffness * period * period, .damping = damping});
    device.place({0.01, 0, 0}, {});
    double first = 0, last = 0;
    constexpr int kMany = 60000, kOscillation = 200;
    for (int i = 0; i < kMany; ++i) {
      device.step(period, {-stiffness * device.position()[0], 0, 0});
      const double x = std::abs(device.position()[0]);
      if (i < kOscillation) first = std::max(first, x);
      if (i >= kMany - kOscillation) last = std::max(last, x);
    }
    return last > first;
  };
  double low = 10, high = 400;
  while (high - low > 0.05) {
    const double middle = (low + high) / 2;
    (grows(middle) ? high : low) = middle;
  }
  return (low + high) / 2;
}

TEST(Verification, PassivityOfSampledWalls) {
  const std::string problem = "Passivity: stiffness at which oscillations begin to last";
  verify({problem, "linear wall, b = 0.1 N s/m, 1 kHz, one sample of delay", "N/m",
          critical_stiffness(0.1, 1e-3), 0.1 / 1.5e-3, Reference::ClosedForm,
          "(C1): b/(1.5 T), attained by slow oscillations", 0.02});
  for (const double rate : {1000.0, 4000.0}) {
    app::SlingshotSetup setup;
    setup.rate = rate;
    verify({problem, "wall (34) with a band, " + std::to_string(int(rate) / 1000) + " kHz", "N/m",
            app::passivity_margin(setup, 20, 800, 0.2),
            app::bonded_margin_by_energy_balance({}, rate, 0), Reference::ClosedForm,
            "energy balance of a swing", 0.01});
  }
  verify({problem, "wall (34) with a band, 2 kHz", "N/m", app::passivity_margin({}, 100, 300, 0.2),
          170, Reference::Calibration, "Mahvash & Hayward 2005, VI-B; the damping is fitted to it",
          0.01});
  verify({problem, "cylinder of 504 patches, two rates, on the axis, 2 kHz", "N/m",
          app::passivity_margin({app::VirtualBody::Cylinder, 0, 0.3, 2000, 100}, 100, 300, 0.2),
          170, Reference::Published, "Mahvash & Hayward 2005, VI-B: as the wall", 0.01});
}

TEST(Verification, RenderingBetweenVertices) {
  const std::string problem = "Rendering between vertices: plate whose stiffness rises linearly";
  const auto stiffness = [](double x) { return 100 + 2000 * x; };  // N/m
  const palpate_library body(
      plate(8, 0.08, [&](const Vec3& x) { return wall_response(stiffness(x[0]), 120); }));
  for (const double x : {0.0137, 0.0452, 0.0713}) {
    runtime::ContactState contact(body.surface, body.tree, {0.3, 5e-3});
    constexpr double kDepth = 0.008;
    contact.step({x, 0.033, 1e-7});
    for (double z = 0; z <= kDepth; z += 1e-6) contact.step({x, 0.033, -z});
    contact.step({x, 0.033, -kDepth});
    verify({problem, "force at x = " + std::to_string(1e3 * x).substr(0, 4) + " mm, 8 mm deep", "N",
            norm(contact.observation().force), stiffness(x) * (kDepth - 0.0025),
            Reference::ClosedForm, "linear interpolation is exact for it", 1e-3});
  }
}

}  // namespace
}  // namespace palpate::test
