// SPDX-License-Identifier: AGPL-3.0-or-later
// The certificate against forces of the runtime.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "fitting/certificate/certify.hpp"
#include "runtime/local_model.hpp"
#include "runtime/sliding.hpp"
#include "runtime/surface.hpp"
#include "tests/support/surfaces.hpp"
#include "tests/unit/fitting/certificate/plain_model.hpp"

namespace palpate::fitting {
namespace {

constexpr double kFriction = 0.4;

Library certified_sphere(std::mt19937& engine, double spread) {
  Library library = sphere(0.04, 2);
  for (std::size_t v = 0; v < library.positions.size(); ++v) {
    library.responses.push_back(random_response(engine, spread));
  }
  CertifySettings settings;
  settings.friction = kFriction;
  certify(library, settings);
  return library;
}

/// Slide until rho = rho_s, over any number of triangles; false when it does not settle.
bool settle(const runtime::Surface& surface, runtime::SurfacePoint& point, const Vec3& x) {
  for (int i = 0; i < 400; ++i) {
    const runtime::LocalModel model(surface, point, 0);
    const runtime::Deflection d = model.deflection(x);
    const double excess = d.lateral - model.slip_limit(d, kFriction);
    if (excess < 1e-15) return true;
    point = runtime::walk(surface, point, d.tangent, excess).point;
  }
  return false;
}

TEST(CertifyOnRuntime, APathOverASphereNeverExceedsTheBound) {
  std::mt19937 engine(53);
  const Library library = certified_sphere(engine, 0.15);
  ASSERT_TRUE(std::isfinite(library.certificate.slip));
  const runtime::Surface surface(library);
  const double bound = std::max(library.certificate.stick, library.certificate.slip);
  std::normal_distribution<double> normal;
  double closest = 0;
  int crossings = 0;
  for (int path = 0; path < 40; ++path) {
    runtime::SurfacePoint point{path * 7, {0.3, 0.3, 0.4}};
    Vec3 x = surface.position(point) + 0.003 * surface.normal(point);
    Vec3 force{};
    bool settled = false;
    Vec3 heading = unit({normal(engine), normal(engine), normal(engine)});
    for (int step = 0; step < 1500; ++step) {
      const Vec3 move = 1e-5 * unit(heading + 0.3 * Vec3{normal(engine), normal(engine), 0});
      // On a shell between 1 mm and 7 mm deep: the heading follows the sphere.
      Vec3 next = x + move;
      next = std::clamp(norm(next), 0.033, 0.039) * unit(next);
      heading = unit(heading - dot(heading, unit(next)) * unit(next));
      runtime::SurfacePoint moved = point;
      ASSERT_TRUE(settle(surface, moved, next));
      const runtime::LocalModel model(surface, moved, 0);
      const Vec3 now = model.respond(model.deflection(next)).force;
      const double length = norm(next - x);
      if (settled && length > 1e-9) {
        EXPECT_LE(norm(now - force), bound * length * (1 + 1e-3)) << "path " << path;
        closest = std::max(closest, norm(now - force) / (bound * length));
      }
      crossings += moved.element != point.element ? 1 : 0;
      x = next;
      point = moved;
      force = now;
      settled = true;
    }
  }
  EXPECT_GT(crossings, 20);
  EXPECT_GT(closest, 0.15);
}

TEST(CertifyOnRuntime, EnergyFallsAlongEverySlideOfACertifiedTriangle) {
  std::mt19937 engine(59);
  std::uniform_real_distribution<double> u(0, 1);
  int certified = 0;
  int checked = 0;
  for (const double spread : {0.02, 0.1}) {
    const Library library = certified_sphere(engine, spread);
    const runtime::Surface surface(library);
    for (std::int32_t m = 0; m < surface.element_count(); ++m) {
      if (!library.certificate.triangles[static_cast<std::size_t>(m)].sliding_passive) continue;
      ++certified;
      for (int i = 0; i < 40; ++i) {
        double a = u(engine);
        double b = u(engine);
        if (a + b > 1) a = 1 - a, b = 1 - b;
        const runtime::SurfacePoint point{m, {a, b, 1 - a - b}};
        const double z = 0.008 * (0.01 + 0.99 * u(engine));
        const double d0 = u(engine) * (library.certificate.depth - z);
        runtime::LocalModel model(surface, point, d0);
        const Vec3 n = model.normal();
        const Vec3 any = unit({u(engine) - 0.5, u(engine) - 0.5, u(engine) - 0.5});
        const Vec3 t = unit(any - dot(any, n) * n);
        runtime::Deflection d;
        d.depth = z;
        const double limit = model.slip_limit(d, kFriction);
        const Vec3 x = model.contact_point() + (z + d0) * n + limit * t;
        const Vec3 N = surface.element(m).facet_normal;
        const Vec3 along = unit(t - dot(t, N) * N);
        EXPECT_LE(model.energy_slope(model.deflection(x), along), 1e-12);
        ++checked;
      }
    }
  }
  EXPECT_GT(certified, 100);
  EXPECT_EQ(checked, 40 * certified);
}

/// Norm of the Jacobian of a local model by central differences.
double force_gradient(const runtime::LocalModel& model, const Vec3& x) {
  constexpr double kStep = 1e-7;
  std::array<Vec3, 3> column{};
  for (std::size_t j = 0; j < 3; ++j) {
    Vec3 e{};
    e[j] = kStep;
    const auto force = [&](const Vec3& at) { return model.respond(model.deflection(at)).force; };
    column[j] = (0.5 / kStep) * (force(x + e) - force(x - e));
  }
  // The largest eigenvalue of the symmetric matrix, by powers.
  Vec3 v{0.5, 0.6, 0.7};
  double norm_of = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec3 next = v[0] * column[0] + v[1] * column[1] + v[2] * column[2];
    norm_of = norm(next);
    if (!(norm_of > 0)) return 0;
    v = (1 / norm_of) * next;
  }
  return norm_of;
}

TEST(CertifyOnRuntime, NoMemoryOfTheTissueMakesTheForceSteeper) {
  std::mt19937 engine(59);
  std::uniform_real_distribution<double> any(0, 1);
  for (const bool coupled : {false, true}) {
    double closest = 0;
    for (int trial = 0; trial < 8; ++trial) {
      Library library = random_triangle(engine, 0.2, 0.3);
      if (coupled) couple(library, engine, 0.3);
      library.tool_radius = 0.004;
      library.relaxation_times = {0.1};
      for (NodeResponse& node : library.responses) node.relaxation = {0.7F};
      CertifySettings settings;
      settings.friction = kFriction;
      certify(library, settings);
      const double bound = library.certificate.stick;
      const runtime::Surface surface(library);
      for (int i = 0; i < 100; ++i) {
        const double a = any(engine), b = any(engine) * (1 - a);
        runtime::LocalModel model(surface, {0, {a, b, 1 - a - b}}, 0);
        const double z = library.certificate.depth * any(engine);
        const Vec3 n = model.normal();
        const Vec3 t = unit(cross(n, {0.3, 0.5, 0.1}));
        const Vec3 pressed = model.contact_point() + z * n;
        const double g = model.respond(model.deflection(pressed)).friction_normal_force;
        const double y = std::sqrt(2 * model.respond(model.deflection(pressed)).energy);
        // The memory of a deeper or a shallower press; friction holds what the normal force allows.
        runtime::TissueMemory memory;
        memory.normal.relaxed_and_carried = runtime::Pair{any(engine) * y, 1};
        model.set_memory(memory);
        const double psi = model.respond(model.deflection(pressed)).friction_normal_force / g;
        const double rho =
            any(engine) * model.slip_limit(model.deflection(pressed), kFriction * psi);
        const double gradient = force_gradient(model, pressed + rho * t);
        EXPECT_LE(gradient, bound * (1 + 1e-4)) << coupled;
        closest = std::max(closest, gradient / bound);
      }
    }
    EXPECT_GT(closest, coupled ? 0.5 : 0.8);
  }
}

}  // namespace
}  // namespace palpate::fitting
