// SPDX-License-Identifier: AGPL-3.0-or-later
// The force step beside that of CHAI3D, on the same spheres, along the same trajectory of the tool
// and timed in the same way. The two compute different forces: CHAI3D that of a linear spring
// between the tool and a proxy, which its finger-proxy algorithm keeps on the rigid mesh with
// collisions found in a tree of boxes and Coulomb friction; palpate that of nonlinear responses
// interpolated over the triangle in contact, which slides with friction, with an energy account
// that bounds what the contact gives back.
//
//   bench_chai3d [--benchmark_filter=...] [--benchmark_format=json]
//
// CHAI3D is asked for what costs it least: a proxy without radius, on a static mesh (where a call
// tests one constraint and the next call the next one), flat normals, and the algorithm alone
// without cToolCursor around it. The counters are those of bench_runtime; `contact` is the part of
// the steps with a force, `depth` the mean force over the stiffness, m.
#include <benchmark/benchmark.h>
#include <collisions/CCollisionAABB.h>
#include <forces/CAlgorithmFingerProxy.h>
#include <world/CMesh.h>
#include <world/CWorld.h>

#include <cstdint>
#include <memory>

#include "bench/runtime/octasphere.hpp"
#include "bench/runtime/passes.hpp"
#include "bench/runtime/step_on_sphere.hpp"

namespace palpate::bench {
namespace {

constexpr double kStiffness = 225;  // N/m, amid those of octasphere.hpp
constexpr double kFriction = 0.3;

/// The world's unit, m. CHAI3D has absolute tolerances for scenes of about one unit: in metres it
/// does not see triangles of less than 0.16 mm^2.
constexpr double kUnit = 0.1;

chai3d::cVector3d to_chai3d(const Vec3& x) {
  return {x[0] / kUnit, x[1] / kUnit, x[2] / kUnit};
}

/// A world of one mesh, the octasphere of so many divisions, which the world owns.
std::unique_ptr<chai3d::cWorld> world_of(int n, double proxy_radius) {
  auto world = std::make_unique<chai3d::cWorld>();
  auto* mesh = new chai3d::cMesh();
  world->addChild(mesh);
  const Library body = octasphere(n);
  for (const Vec3& x : body.positions) mesh->newVertex(to_chai3d(x));
  for (const Triangle& t : body.triangles) {
    mesh->newTriangle(static_cast<unsigned>(t[0]), static_cast<unsigned>(t[1]),
                      static_cast<unsigned>(t[2]));
  }
  mesh->m_material->setStiffness(kStiffness * kUnit);
  mesh->m_material->setStaticFriction(kFriction);
  mesh->m_material->setDynamicFriction(kFriction);
  mesh->m_material->setUseHapticFriction(true);
  mesh->createAABBCollisionDetector(proxy_radius);
  world->computeGlobalPositions();
  return world;
}

void chai3d_on_sphere(benchmark::State& state) {
  const double radius = 1e-6 / kUnit * static_cast<double>(state.range(1));
  const auto world = world_of(static_cast<int>(state.range(0)), radius);
  std::unique_ptr<chai3d::cAlgorithmFingerProxy> proxy;
  const auto step = [&](const Vec3& x) {
    const chai3d::cVector3d force = proxy->computeForces(to_chai3d(x), {0, 0, 0});
    return Felt{{force(0), force(1), force(2)}, 0};
  };
  const Pass pass = time_passes(state, [&] {
    proxy = std::make_unique<chai3d::cAlgorithmFingerProxy>();
    proxy->setProxyRadius(radius);
    proxy->initialize(world.get(), to_chai3d(outside()));
    for (int i = 0; i < 4; ++i) step(trajectory().front());  // a contact takes several
    return step;
  });
  double contact = 0, force = 0;
  for (const Felt& felt : pass.felt) {
    contact += norm(felt.force) > 0 ? 1. / kSteps : 0;
    force += norm(felt.force) / kSteps;
  }
  state.counters["contact"] = contact;
  state.counters["depth"] = force / kStiffness;
  state.counters["triangles"] = static_cast<double>(8 * state.range(0) * state.range(0));
}

// n = 8, 25, 79, 250: 512, 5 000, 49 928 and 500 000 triangles; of CHAI3D with the radius of the
// proxy, micrometres.
BENCHMARK(step_on_sphere)
    ->ArgsProduct({{8, 25, 79, 250}, {0}, {static_cast<std::int64_t>(Motion::Both)}})
    ->Iterations(kPasses)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(chai3d_on_sphere)
    ->ArgsProduct({{8, 25, 79, 250}, {0, 1000}})
    ->Iterations(kPasses)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace palpate::bench

BENCHMARK_MAIN();
