// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/bonded_patch.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "fem/campaign/region_laws.hpp"
#include "fem/factor/cholesky.hpp"
#include "fem/solve/newton.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

[[noreturn]] void refuse_body(const Body& body, const std::string& problem,
                              const std::string& remedy) {
  throw Error(ErrorKind::Configuration, body.name, problem, remedy);
}

/// The body with the corner nodes of the patch fixed, too.
Body with_fixed_patch(const Body& body, std::int32_t vertex, double radius) {
  const auto count = static_cast<std::int32_t>(body.response.node.size());
  if (vertex < 0 || vertex >= count || body.response.is_site[to_index(vertex)] == 0)
    refuse_body(body, "response vertex " + std::to_string(vertex) + " is not a site",
                "choose a vertex outside the supports, from 0 to " + std::to_string(count - 1));
  if (!(std::isfinite(radius) && radius > 0))
    refuse_body(body, "the radius of the patch is " + std::to_string(radius) + " m",
                "give a finite radius > 0");
  const Vec3& site = body.nodes[to_index(body.response.node[to_index(vertex)])];
  std::vector<bool> in_patch(body.nodes.size(), false);
  for (const Triangle& facet : body.boundary)
    for (const std::int32_t node : facet)
      in_patch[to_index(node)] = norm(body.nodes[to_index(node)] - site) <= radius * (1 + 1e-9);
  for (const std::int32_t node : body.fixed_nodes)
    if (in_patch[to_index(node)])
      refuse_body(body, "the patch reaches a support", "give a smaller radius or another site");
  Body fixed = body;
  for (std::size_t node = 0; node < in_patch.size(); ++node)
    if (in_patch[node]) fixed.fixed_nodes.push_back(static_cast<std::int32_t>(node));
  return fixed;
}

/// Nodes fixed in `mesh` that are free in `free`.
std::vector<std::int32_t> newly_fixed(const QuadraticMesh& mesh, const QuadraticMesh& free) {
  std::vector<std::int32_t> nodes;
  for (int node = 0; node < mesh.nodes(); ++node)
    if (free.is_free(node) && !mesh.is_free(node)) nodes.push_back(node);
  return nodes;
}

/// Equilibria of the body as the patch goes down.
class PatchPress {
 public:
  PatchPress(const Body& body, const CampaignSettings& settings, std::int32_t vertex, double radius)
      : fixed_(with_fixed_patch(body, vertex, radius), laws_of_regions(body, settings.materials),
               settings.dilatation),
        free_(body, laws_of_regions(body, settings.materials), settings.dilatation),
        patch_(newly_fixed(fixed_.mesh(), free_.mesh())),
        inward_(body.response.inward[to_index(vertex)].data()),
        no_contact_(fixed_.mesh(), Eigen::Vector3d::Constant(1e6), 1e-6, {1, 1}),
        newton_(fixed_),
        u_(Displacement::Zero(3, fixed_.mesh().nodes())),
        before_(u_) {
    double young = 0;
    for (const RegionMaterial& m : settings.materials)
      young = std::max(young, rest_moduli(m.law).young);
    options_.tolerance = 1e-7;
    options_.least_force = young * radius * settings.indentation.depth;  // there is no contact
  }

  /// False, with the reason, where no equilibrium is found.
  bool press_to(double depth, PatchForce& sample, std::string& reason) {
    if (!advance(depth, 0, reason)) return false;
    Eigen::VectorXd f;
    sample = {depth, {}, free_.forces(u_, f).energy};
    for (const std::int32_t node : patch_)
      for (std::size_t i = 0; i < 3; ++i)
        sample.force[i] += f[free_.equation(node) + static_cast<int>(i)];
    return true;
  }

 private:
  void set_patch(double depth, Displacement& u) const {
    for (const std::int32_t node : patch_) u.col(node) = depth * inward_;
    straighten(fixed_.mesh(), u);
  }

  bool advance(double depth, int halvings, std::string& reason) {
    constexpr int kMaxHalvings = 8;
    Displacement trial = u_;
    if (depth_ > before_depth_)
      trial += (depth - depth_) / (depth_ - before_depth_) * (u_ - before_);
    set_patch(depth, trial);
    if (!(fixed_.energy(trial).min_J > 0)) {
      trial = u_;
      set_patch(depth, trial);
    }
    const NewtonResult result = newton_.solve(no_contact_, options_, trial);
    if (!result.converged) {
      reason = result.reason;
      return halvings < kMaxHalvings && advance(0.5 * (depth_ + depth), halvings + 1, reason) &&
             advance(depth, halvings + 1, reason);
    }
    if (const auto loss = fixed_.ellipticity_loss(trial)) {
      reason = "at " + length_text(depth) + ": " + loss->reason();
      return false;
    }
    before_.swap(u_);
    before_depth_ = depth_;
    u_.swap(trial);
    depth_ = depth;
    return true;
  }

  SolidModel fixed_, free_;
  std::vector<std::int32_t> patch_;
  Eigen::Vector3d inward_;
  ToolContact no_contact_;
  NewtonSolver newton_;
  NewtonOptions options_;
  Displacement u_, before_;
  double depth_ = 0, before_depth_ = 0;
};

}  // namespace

BondedPatch bonded_patch(const Body& body, std::int32_t vertex, double radius) {
  BondedPatch patch;
  patch.mesh = make_quadratic_mesh(body);
  patch.nodes =
      newly_fixed(make_quadratic_mesh(with_fixed_patch(body, vertex, radius)), patch.mesh);
  return patch;
}

PatchCurve press_patch(const Body& body, const CampaignSettings& settings, std::int32_t vertex,
                       double radius) {
  check_indentation(settings.indentation);
  use_one_thread_per_site();
  PatchPress press(body, settings, vertex, radius);
  PatchCurve curve{{{}}, {}};
  for (int i = 1; i <= settings.indentation.increments; ++i) {
    PatchForce sample;
    const double depth = settings.indentation.depth * i / settings.indentation.increments;
    if (!press.press_to(depth, sample, curve.reason)) return curve;
    curve.samples.push_back(sample);
  }
  curve.reason.clear();  // of a step that succeeded after a cut-back
  return curve;
}

}  // namespace palpate::fem
