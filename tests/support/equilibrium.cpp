// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/equilibrium.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>

#include "fem/factor/cholesky.hpp"
#include "fem/solve/newton.hpp"

namespace palpate::test {

namespace {

using Eigen::Vector3d;

/// Gauss points and weights on [0, 1].
constexpr std::array<double, 4> kPoint{0.069431844202974, 0.330009478207572, 0.669990521792428,
                                       0.930568155797026};
constexpr std::array<double, 4> kWeight{0.173927422568727, 0.326072577431273, 0.326072577431273,
                                        0.173927422568727};

/// Shape functions and derivatives at volume coordinates L, with dL/dX.
VolumePoint point_at(const std::array<double, 4>& L, const std::array<Vector3d, 4>& dL,
                     bool linear) {
  VolumePoint p{};
  for (std::size_t n = 0; n < fem::kTetNodes; ++n) p.dN[n].setZero();
  if (linear) {
    std::copy(L.begin(), L.end(), p.N.begin());
    std::copy(dL.begin(), dL.end(), p.dN.begin());
    return p;
  }
  for (std::size_t c = 0; c < 4; ++c) {
    p.N[c] = L[c] * (2 * L[c] - 1);
    p.dN[c] = (4 * L[c] - 1) * dL[c];
  }
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] = fem::kTetEdges[e];
    p.N[4 + e] = 4 * L[i] * L[j];
    p.dN[4 + e] = 4 * (L[i] * dL[j] + L[j] * dL[i]);
  }
  return p;
}

}  // namespace

void for_each_volume_point(const fem::QuadraticMesh& mesh,
                           const std::function<void(const VolumePoint&)>& visit) {
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    const auto& node = mesh.tetrahedra[e];
    Eigen::Matrix3d edges;
    for (int c = 0; c < 3; ++c)
      edges.col(c) = mesh.X.col(node[to_index(c + 1)]) - mesh.X.col(node[0]);
    const Eigen::Matrix3d inverse = edges.inverse();
    std::array<Vector3d, 4> dL;
    dL[0] = -inverse.colwise().sum().transpose();
    for (int c = 0; c < 3; ++c) dL[to_index(c + 1)] = inverse.row(c).transpose();
    // The cube collapsed to a tetrahedron [Stroud 1971, sec. 2.4].
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t k = 0; k < 4; ++k) {
          const double a = kPoint[i], b = kPoint[j] * (1 - a), c = kPoint[k] * (1 - a - b);
          VolumePoint p = point_at({a, b, c, 1 - a - b - c}, dL, mesh.linear);
          p.element = e;
          p.X.setZero();
          for (std::size_t n = 0; n < 4; ++n)
            p.X += std::array{a, b, c, 1 - a - b - c}[n] * mesh.X.col(node[n]);
          p.volume =
              kWeight[i] * kWeight[j] * kWeight[k] * (1 - a) * (1 - a - b) * edges.determinant();
          visit(p);
        }
  }
}

Loads traction_loads(const fem::QuadraticMesh& mesh, const Vector3d& traction,
                     const std::function<bool(const Vector3d& X)>& on_surface) {
  Loads loads = Loads::Zero(3, mesh.nodes());
  for (const fem::Facet& facet : mesh.facets) {
    bool chosen = true;
    for (const auto node : facet) chosen = chosen && on_surface(mesh.X.col(node));
    if (!chosen) continue;
    const Vector3d a = mesh.X.col(facet[1]) - mesh.X.col(facet[0]);
    const Vector3d b = mesh.X.col(facet[2]) - mesh.X.col(facet[0]);
    // The integrals of the quadratic shape functions: none at corners, a third at mid-edges.
    for (std::size_t m = 3; m < 6; ++m)
      loads.col(facet[m]) += 0.5 * a.cross(b).norm() / 3 * traction;
  }
  return loads;
}

Loads body_loads(const fem::QuadraticMesh& mesh,
                 const std::function<Vector3d(const Vector3d& X)>& force) {
  Loads loads = Loads::Zero(3, mesh.nodes());
  for_each_volume_point(mesh, [&](const VolumePoint& p) {
    const Vector3d b = p.volume * force(p.X);
    for (std::size_t n = 0; n < fem::kTetNodes; ++n)
      loads.col(mesh.tetrahedra[p.element][n]) += p.N[n] * b;
  });
  return loads;
}

namespace {

/// The entry of the displacements of each unknown.
std::vector<double*> entries_of(const fem::SolidModel& model, fem::Displacement& u) {
  std::vector<double*> entry(to_index(model.pattern().n));
  for (int node = 0; node < model.mesh().nodes(); ++node)
    for (int i = 0; i < 3 && model.equation(node) >= 0; ++i)
      entry[to_index(model.equation(node) + i)] = &u(i, node);
  return entry;
}

}  // namespace

void equilibrate(const fem::SolidModel& model, const Loads& loads,
                 const std::vector<Prescribed>& prescribed, fem::Displacement& u) {
  const fem::SparsePattern& pattern = model.pattern();
  const std::vector<int> order = fem::nested_dissection(pattern);
  fem::Cholesky factor(pattern, &order);
  fem::SolveWorkspace workspace;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(pattern.n), f, d(pattern.n);
  for (int node = 0; node < model.mesh().nodes(); ++node)
    if (model.equation(node) >= 0) load.segment<3>(model.equation(node)) = loads.col(node);
  std::vector<double> K;
  double scale = load.norm();  // of the forces, with those far from equilibrium
  for (int iteration = 0; iteration < 60; ++iteration) {
    ASSERT_GT(model.forces(u, f).min_J, 0);
    scale = std::max(scale, f.norm());
    Eigen::VectorXd residual = load - f;
    model.stiffness(u, K);
    double missing = 0;
    const auto entry = entries_of(model, u);
    for (const auto& [i, value] : prescribed) {
      const double gap = value - *entry[to_index(i)];
      double& diagonal = K[to_index(pattern.start[to_index(i)])];
      missing = std::max(missing, std::abs(gap));
      diagonal *= 1e10;
      residual[i] = diagonal * gap;
    }
    Eigen::VectorXd free = residual;
    for (const auto& given : prescribed) free[given.unknown] = 0;
    const double left = free.norm();
    if (iteration > 0 && missing < 1e-9 && left <= 1e-9 * scale) return;
    bool definite = factor.factorize(K);
    for (const double shift : {0.05, 0.2, 1.0, 5.0}) {  // far from equilibrium: still a descent
      if (definite) break;
      std::vector<double> raised = K;
      for (std::size_t i = 0; i + 1 < pattern.start.size(); ++i)
        raised[to_index(pattern.start[i])] *= 1 + shift;
      definite = factor.factorize(raised);
    }
    ASSERT_TRUE(definite) << "the stiffness is not positive definite";
    factor.solve(residual.data(), d.data(), workspace);
    for (double step = 1; step > 1e-3; step /= 2) {  // until every element keeps its orientation
      fem::Displacement trial = u;
      fem::add_step(model, step, d, trial);
      if (!(model.energy(trial).min_J > 0)) continue;
      u = trial;
      break;
    }
  }
  FAIL() << "no equilibrium in 60 iterations";
}

}  // namespace palpate::test
