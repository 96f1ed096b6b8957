// SPDX-License-Identifier: AGPL-3.0-or-later
// What curved facets are worth: a sphere pressed onto nodes of a round body whose facets are flat,
// as they are in the solver, and curved (the mid-edge nodes of the contact surface on the true
// sphere, the elements below as they were), both against the force on meshes refined around one
// node, extrapolated.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "fem/at.hpp"
#include "fem/newton.hpp"
#include "tests/support/prism_body.hpp"

namespace {

using namespace palpate;

constexpr double kBody = 0.030, kThickness = 0.015, kTool = 0.005, kYoung = 10e3, kPoisson = 0.45;
constexpr double kHalfAngle = 0.9;
constexpr double kDepths[] = {0.0005, 0.001, 0.002};

/// The cap of a ball, pole up, its inside held: rings at ascending angles, layers at descending
/// depths below the skin from the thickness to 0.
Body cap(const std::vector<double>& angles, int sectors, const std::vector<double>& depths) {
  const int layers = static_cast<int>(depths.size()) - 1;
  Body body =
      test::make_prisms(test::rings(angles, sectors), layers, [&](const Vec3& x, int layer) {
        const double angle = norm(x), r = kBody - depths[fem::at(layer)];
        const double across = angle > 0 ? r * std::sin(angle) / angle : 0;
        return Vec3{across * x[0], across * x[1], r * std::cos(angle)};
      });
  const auto on_one_layer = static_cast<std::int32_t>(body.nodes.size()) / (layers + 1);
  for (std::int32_t i = 0; i < on_one_layer; ++i) body.fixed_nodes.push_back(i);
  return body;
}

/// Elements of size h everywhere.
Body even_cap(double h) {
  std::vector<double> angles, depths;
  const int count = static_cast<int>(std::ceil(kBody * kHalfAngle / h));
  for (int i = 1; i <= count; ++i) angles.push_back(kHalfAngle * i / count);
  const int layers = static_cast<int>(std::ceil(kThickness / h));
  for (int i = layers; i >= 0; --i) depths.push_back(kThickness * i / layers);
  return cap(angles, count, depths);
}

/// Steps of h up to `core`, then ever larger ones to the end.
std::vector<double> graded(double h, double core, double growth, double end) {
  std::vector<double> at{0};
  for (double step = h; at.back() < end - 1e-12;) {
    if (at.back() > core - 1e-12) step *= growth;
    at.push_back(end - at.back() < 1.5 * step ? end : at.back() + step);
  }
  return at;
}

/// Elements of size h around the pole.
Body refined_cap(double h) {
  std::vector<double> angles = graded(h, 0.0035, 1.4, kBody * kHalfAngle);
  angles.erase(angles.begin());
  for (double& angle : angles) angle /= kBody;
  std::vector<double> depths = graded(h, h, 1.5, kThickness);
  std::reverse(depths.begin(), depths.end());
  return cap(angles, static_cast<int>(std::lround(0.0035 / h)), depths);
}

fem::QuadraticMesh curved(fem::QuadraticMesh mesh) {
  for (const fem::Facet& facet : mesh.facets) {
    bool outside = true;
    for (std::size_t c = 0; c < 3; ++c)
      outside = outside && mesh.X.col(facet[c]).norm() > kBody * (1 - 1e-9);
    for (std::size_t m = 3; outside && m < 6; ++m) {
      mesh.X.col(facet[m]) = kBody * mesh.X.col(facet[m]).normalized();
    }
  }
  return mesh;
}

/// The force at each depth, N, on the pole.
std::vector<double> press(const fem::SolidModel& model, const fem::QuadraticMesh& surface) {
  const Eigen::Vector3d pole(0, 0, kBody);
  fem::ToolContact contact(surface, pole, 3 * kTool, {5000 * kYoung / kTool, kYoung});
  fem::NewtonSolver newton(model);
  fem::Displacement u = fem::Displacement::Zero(3, model.mesh().nodes());
  std::vector<double> forces;
  double reached = 0;
  for (const double depth : kDepths) {
    for (; reached < depth - 1e-12;) {
      reached = std::min(depth, reached + 0.0005);
      fem::Tool tool;
      tool.geometry.radius = kTool;
      tool.tip = pole - Eigen::Vector3d(0, 0, reached);
      contact.move_to(tool);
      fem::NewtonOptions options;
      options.tolerance = 1e-5;
      const fem::NewtonResult result = newton.solve(contact, options, u);
      if (!result.converged) std::printf("at %.2f mm: %s\n", 1e3 * reached, result.reason.c_str());
    }
    forces.push_back(-contact.tool_force(u)[2]);
  }
  return forces;
}

fem::SolidModel model_of(const Body& body) {
  return {body, {fem::NeoHookean::from_young_poisson(kYoung, kPoisson, "the ball")}};
}

void print_row(double h, const char* facets, int nodes, const std::vector<double>& forces,
               const std::vector<double>& converged) {
  std::printf("| %.1f mm | %s | %d |", 1e3 * h, facets, nodes);
  for (std::size_t i = 0; i < forces.size(); ++i)
    std::printf(" %.2f mN, %+.1f %% |", 1e3 * forces[i], 100 * (forces[i] / converged[i] - 1));
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

/// Errors are those to the finest of the meshes refined at the pole; what the coarser one of these
/// differs from it says how far it is to be trusted.
int main() {
  std::printf("| elements | facets | nodes |");
  for (const double depth : kDepths) std::printf(" %.1f mm |", 1e3 * depth);
  std::printf("\n|---|---|---|---|---|---|\n");
  std::vector<double> converged;
  for (const double h : {0.0010, 0.0014}) {
    const fem::SolidModel model = model_of(refined_cap(h));
    const std::vector<double> forces = press(model, curved(model.mesh()));
    if (converged.empty()) converged = forces;
    print_row(h, "curved, refined", model.mesh().nodes(), forces, converged);
  }
  for (const double h : {0.006, 0.004}) {
    const fem::SolidModel model = model_of(even_cap(h));
    print_row(h, "flat", model.mesh().nodes(), press(model, model.mesh()), converged);
    print_row(h, "curved", model.mesh().nodes(), press(model, curved(model.mesh())), converged);
  }
}
