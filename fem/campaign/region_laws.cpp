// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/region_laws.hpp"

#include <algorithm>

#include "fem/laws/relaxation.hpp"
#include "fem/solid/fibre_potential.hpp"
#include "format/error.hpp"

namespace palpate::fem {

namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

LawConstants placed_on(const Body& body, std::int32_t region, const LawConstants& law) {
  if (!law_entry(law.law).has_fibres) return law;
  const std::string where =
      "material of region '" + body.region_names[static_cast<std::size_t>(region)] + "'";
  LawConstants placed = law;
  if (law.fibres.kind == FibreField::Kind::Laplace) {
    law.fibres.check(where);
    placed.fibres = fibres_of_potential(body, region, law.fibres, where);
  }
  if (placed.fibres.kind == FibreField::Kind::Sampled && !placed.fibres.samples)
    refuse(where, "the directions of its fibres are missing", "read them from their file first");
  return placed;
}

std::vector<Law> laws_of_regions(const Body& body, const std::vector<RegionMaterial>& materials) {
  for (const auto& material : materials)
    if (std::find(body.region_names.begin(), body.region_names.end(), material.region) ==
        body.region_names.end())
      refuse("material of region '" + material.region + "'", "the body has no such region",
             "use one of: " + joined(body.region_names));
  std::vector<Law> laws;
  for (const auto& region : body.region_names) {
    const auto is_it = [&](const RegionMaterial& m) { return m.region == region; };
    const auto count = std::count_if(materials.begin(), materials.end(), is_it);
    if (count != 1)
      refuse("region '" + region + "'", std::to_string(count) + " materials are given for it",
             "give exactly one");
    const auto& law = std::find_if(materials.begin(), materials.end(), is_it)->law;
    const std::string where = "material of region '" + region + "'";
    check_law(law, where);
    laws.push_back(make_law(placed_on(body, static_cast<std::int32_t>(laws.size()), law), where));
  }
  return laws;
}

RegionRelaxation relaxation_of_regions(const Body& body,
                                       const std::vector<RegionMaterial>& materials) {
  std::vector<RelaxationSeries> series(body.region_names.size());
  for (std::size_t region = 0; region < series.size(); ++region)
    for (const RegionMaterial& material : materials) {
      if (material.region != body.region_names[region] || material.relaxation.empty()) continue;
      if (!has_isochoric_part(material.law.law))
        refuse("material of region '" + material.region + "'",
               "the law " + material.law.law + " has no isochoric part that could relax",
               "remove relaxation, or choose another law");
      series[region] = material.relaxation;
    }
  return over_one_list(series, "material of a region of " + body.name);
}

Gravity gravity_on(const Body& body, const CampaignSettings& settings) {
  Gravity gravity = settings.gravity;
  gravity.region_density.assign(body.region_names.size(), gravity.density);
  for (std::size_t region = 0; region < body.region_names.size(); ++region)
    for (const RegionMaterial& material : settings.materials)
      if (material.region == body.region_names[region] && material.density > 0)
        gravity.region_density[region] = material.density;
  return gravity;
}

}  // namespace palpate::fem
