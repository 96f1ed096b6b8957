// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/campaign_context.hpp"

#include <algorithm>
#include <utility>

#include "fem/campaign/campaign_cache.hpp"
#include "fem/campaign/parallel_sites.hpp"
#include "fem/campaign/region_laws.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "fem/solve/preload.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// Penalty over E/R: the penetration is micrometres for a tool of millimetres, which changes the
/// force by about 0.1 %.
constexpr double kContactStiffness = 5000;

/// Residual that counts as none over the weight, and over the residual at rest.
constexpr double kOfWeight = 1e-8, kOfRest = 10;

double rounding_of_rest(const SolidModel& model, const Displacement& rest) {
  Eigen::VectorXd residual;
  model.forces(rest, residual);
  return std::max(kOfWeight * model.weight_norm(), kOfRest * residual.norm());
}

}  // namespace

ContactStiffness contact_stiffness(const Body& body, const CampaignSettings& settings,
                                   const SolidModel& model) {
  double stiffest = 0;
  for (const auto region : model.mesh().facet_region)
    for (const auto& material : settings.materials)
      if (material.region == body.region_names[to_index(region)])
        stiffest = std::max(stiffest, rest_moduli(material.law).young);
  return {kContactStiffness * stiffest / settings.indentation.tool.radius, stiffest};
}

namespace {

void check_refinement(const Body& body, const CampaignSettings& settings, Engine engine) {
  if (!settings.indentation.refines()) return;
  std::string with = obstacle_to_refinement(settings);
  if (with.empty() && engine == Engine::Direct) with = "when every step factorizes the body";
  if (with.empty()) return;
  throw Error(ErrorKind::Configuration, body.name,
              "elements cannot be refined under the tool " + with,
              "remove solver.refine_under_tool and choose a smaller mesh.element_size");
}

}  // namespace

std::string obstacle_to_refinement(const CampaignSettings& settings) {
  return is_linear(settings.dilatation) ? "with linear displacements (tet4)" : "";
}

/// The model and its equilibrium before the touch.
struct CampaignContext::Preloaded {
  SolidModel model;
  std::vector<int> permutation;
  Preload preload;
};

namespace {

Preload computed_preload(const Body& body, const CampaignSettings& settings, const Gravity& gravity,
                         const std::vector<Law>& laws, const SolidModel& model,
                         const std::vector<int>& permutation) {
  const PreloadOptions options{{settings.memory, settings.threads}, settings.preloading};
  if (gravity.acts() && gravity.shape == GivenShape::Loaded) {
    auto found = std::make_shared<const UnloadedBody>(
        find_unloaded_body(body, laws, settings.dilatation, gravity, permutation, options));
    return {found, found->u};
  }
  return {nullptr, equilibrium_under_weight(model, permutation, body.name, options)};
}

}  // namespace

CampaignContext::Preloaded CampaignContext::preloaded(const Body& body,
                                                      const CampaignSettings& settings,
                                                      Engine engine, CampaignCache* cache) {
  check_refinement(body, settings, engine);
  const std::vector<Law> laws = laws_of_regions(body, settings.materials);
  const Gravity gravity = gravity_on(body, settings);
  SolidModel model(body, laws, settings.dilatation, gravity);
  std::vector<int> permutation = cache != nullptr ? cache->factors.permutation(model.pattern())
                                                  : nested_dissection(model.pattern());
  const Preload* known = cache != nullptr ? cache->preloads.find(settings) : nullptr;
  Preload preload = known != nullptr
                        ? *known
                        : computed_preload(body, settings, gravity, laws, model, permutation);
  if (cache != nullptr && known == nullptr) cache->preloads.keep(settings, preload);
  if (const auto unloaded = preload.unloaded)
    return {unloaded->model, std::move(permutation), std::move(preload)};
  return {std::move(model), std::move(permutation), std::move(preload)};
}

CampaignContext::CampaignContext(const Body& b, const CampaignSettings& settings, Engine e,
                                 CampaignCache* cache)
    : CampaignContext(b, settings, e, cache, preloaded(b, settings, e, cache)) {}

CampaignContext::CampaignContext(const Body& b, const CampaignSettings& settings, Engine e,
                                 CampaignCache* cache, Preloaded&& start)
    : body(b),
      unloaded(std::move(start.preload.unloaded)),
      points(settings.points),
      indentation(settings.indentation),
      relaxation(relaxation_of_regions(b, settings.materials)),
      engine(e),
      model(std::move(start.model)),
      permutation(std::move(start.permutation)),
      rest(std::move(start.preload.rest)),
      at_rest(model.energy(rest)),
      round_off(settings.gravity.acts() ? rounding_of_rest(model, rest) : 0) {
  use_one_thread_per_site();
  contact_stiffness = fem::contact_stiffness(b, settings, model);
  if (engine == Engine::Direct) return;
  std::vector<double> K;
  // The solvers of the sites see the augmented laws.
  DilatationMultipliers multipliers = model.multipliers();
  model.take_pressures(rest, multipliers);
  model.stiffness(rest, K, &multipliers);
  const FactorResources resources{settings.memory, settings.threads};
  rest_factor =
      cache != nullptr
          ? cache->factors.factor_of(model.pattern(), K, body.name, resources)
          : std::make_shared<RestFactor>(model.pattern(), permutation, K, body.name, resources);
  own_factors.release(places_for_own_factors(*rest_factor, settings.threads, settings.memory));
}

Eigen::Vector3d CampaignContext::rest_position(const Vec3& point) const {
  const Eigen::Vector3d x = to_eigen(point);
  return unloaded ? x : x + displacement_at(model.mesh(), rest, x);
}

Eigen::Vector3d CampaignContext::reference_position(const Vec3& point) const {
  Eigen::Vector3d x = to_eigen(point);
  if (!unloaded) return x;
  const QuadraticMesh& mesh = model.mesh();
  return nearest_boundary_point(mesh, mesh.X + rest, x).value(mesh.X);
}

PressPoint CampaignContext::press_point(std::int32_t vertex) const {
  if (!points.empty()) return points[to_index(vertex)];
  return {body.nodes[to_index(body.response.node[to_index(vertex)])],
          body.response.inward[to_index(vertex)]};
}

}  // namespace palpate::fem
