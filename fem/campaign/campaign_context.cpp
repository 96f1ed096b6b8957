// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/campaign_context.hpp"

#include <algorithm>

#include "fem/campaign/region_laws.hpp"
#include "fem/campaign/site_body.hpp"
#include "fem/solve/preload.hpp"
#include "fem/solve/shared_factor_solver.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// Penalty over E/R: the gap it leaves is micrometres for a tool of millimetres, a change of the
/// force of about 0.1 %.
constexpr double kContactStiffness = 5000;
/// Of the window, over the tool radius. A wider one costs factorizations, a narrower one solves:
/// the total is flat between 1.6 and 2.4.
constexpr double kWindowRadius = 2;

Eigen::Vector3d to_eigen(const Vec3& v) {
  return Eigen::Vector3d(v.data());
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

/// What is divided under the tool knows the energy of the elements alone.
void check_division(const Body& body, const CampaignSettings& settings, Engine engine) {
  if (!settings.indentation.refine_under_tool) return;
  const auto refuse = [&](const char* with) {
    throw Error(ErrorKind::Configuration, body.name,
                std::string("elements cannot be divided under the tool ") + with,
                "leave solver.refine_under_tool out, and choose a smaller mesh.element_size");
  };
  if (has_nodal_pressure(settings.dilatation)) refuse("where pressures are nodal");
  if (!body.foundation.empty()) refuse("of a body on springs");
  if (settings.gravity.acts()) refuse("of a body under its weight");
  if (engine == Engine::Direct) refuse("where every step factorizes the body");
}

}  // namespace

CampaignContext::CampaignContext(const Body& b, const CampaignSettings& settings, Engine e,
                                 FactorCache* kept)
    : body(b),
      points(settings.points),
      indentation(settings.indentation),
      engine(e),
      model(b, laws_of_regions(b, settings.materials), settings.dilatation, settings.gravity),
      permutation(kept != nullptr ? kept->permutation(model.pattern())
                                  : nested_dissection(model.pattern())),
      rest(equilibrium_under_weight(model, permutation, b.name)),
      at_rest(model.energy(rest)) {
  use_one_thread_per_site();
  check_division(b, settings, engine);
  contact_stiffness = fem::contact_stiffness(b, settings, model);
  if (engine == Engine::Direct) return;
  std::vector<double> K;
  model.stiffness(rest, K);
  rest_factor =
      kept != nullptr
          ? kept->factor_of(model.pattern(), K, body.name, settings.memory, settings.threads)
          : std::make_shared<RestFactor>(model.pattern(), permutation, K, body.name,
                                         settings.memory, settings.threads);
}

Eigen::Vector3d CampaignContext::rest_position(const Vec3& X) const {
  return to_eigen(X) + displacement_at(model.mesh(), rest, to_eigen(X));
}

double window_radius(const CampaignContext& context) {
  const ToolGeometry& tool = context.indentation.tool;
  return tool.extent() + (kWindowRadius - 1) * tool.radius;
}

SolidModel window_at(const CampaignContext& context, const Eigen::Vector3d& site) {
  return {context.model, site, window_radius(context)};
}

double bytes_of_site(const CampaignContext& context, std::int32_t vertex) {
  // Counted here and in the solvers: history, trials and line searches of a path; residuals and
  // directions; the factor of a window over its stiffness.
  constexpr double kDisplacements = 12, kVectors = 8, kWindowFill = 8;
  constexpr double kPairs = 2.0 * SharedFactorSolver::kMostPairs * sizeof(float);
  const double nodes = context.model.mesh().nodes(), unknowns = context.model.pattern().n;
  const double held = static_cast<double>(context.indentation.lateral_depths.size());
  const double numbers = 3 * nodes * (kDisplacements + held) + unknowns * kVectors;
  const SiteBody site(context, to_eigen(context.place(vertex).position));
  return sizeof(double) * (numbers + kWindowFill * site.window().pattern().nonzeros()) +
         unknowns * kPairs + site.bytes();
}

PressPoint CampaignContext::place(std::int32_t vertex) const {
  if (!points.empty()) return points[to_index(vertex)];
  return {body.nodes[to_index(body.response.node[to_index(vertex)])],
          body.response.inward[to_index(vertex)]};
}

}  // namespace palpate::fem
