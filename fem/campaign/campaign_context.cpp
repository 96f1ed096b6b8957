// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/campaign_context.hpp"

#include <algorithm>

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

/// Refined elements have energies of elements alone: no nodal pressure, springs or weight.
void check_refinement(const Body& body, const CampaignSettings& settings, Engine engine) {
  if (!settings.indentation.refine_under_tool) return;
  const auto refuse = [&](const char* with) {
    throw Error(ErrorKind::Configuration, body.name,
                std::string("elements cannot be refined under the tool ") + with,
                "remove solver.refine_under_tool and choose a smaller mesh.element_size");
  };
  if (has_nodal_pressure(settings.dilatation)) refuse("with nodal pressures");
  if (!body.foundation.empty()) refuse("of a body on springs");
  if (settings.gravity.acts()) refuse("of a body under its weight");
  if (engine == Engine::Direct) refuse("when every step factorizes the body");
}

}  // namespace

CampaignContext::CampaignContext(const Body& b, const CampaignSettings& settings, Engine e,
                                 FactorCache* cache)
    : body(b),
      points(settings.points),
      indentation(settings.indentation),
      engine(e),
      model(b, laws_of_regions(b, settings.materials), settings.dilatation, settings.gravity),
      permutation(cache != nullptr ? cache->permutation(model.pattern())
                                   : nested_dissection(model.pattern())),
      rest(equilibrium_under_weight(model, permutation, b.name)),
      at_rest(model.energy(rest)),
      round_off(settings.gravity.acts() ? rounding_of_rest(model, rest) : 0) {
  use_one_thread_per_site();
  check_refinement(b, settings, engine);
  contact_stiffness = fem::contact_stiffness(b, settings, model);
  if (engine == Engine::Direct) return;
  std::vector<double> K;
  model.stiffness(rest, K);
  rest_factor =
      cache != nullptr
          ? cache->factor_of(model.pattern(), K, body.name, settings.memory, settings.threads)
          : std::make_shared<RestFactor>(model.pattern(), permutation, K, body.name,
                                         settings.memory, settings.threads);
}

Eigen::Vector3d CampaignContext::rest_position(const Vec3& X) const {
  return to_eigen(X) + displacement_at(model.mesh(), rest, to_eigen(X));
}

PressPoint CampaignContext::press_point(std::int32_t vertex) const {
  if (!points.empty()) return points[to_index(vertex)];
  return {body.nodes[to_index(body.response.node[to_index(vertex)])],
          body.response.inward[to_index(vertex)]};
}

}  // namespace palpate::fem
