// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/material.hpp"

#include <memory>

#include "app/case/fibre_file.hpp"

namespace palpate::app {

bool reads_fibre_file(const MaterialSection& material) {
  return fem::law_entry(material.law.law).has_fibres &&
         material.law.fibres.kind == fem::FibreField::Kind::Sampled;
}

fem::RegionMaterial campaign_material(const MaterialSection& material,
                                      const std::filesystem::path& folder) {
  fem::RegionMaterial result = material;
  result.law = fem::instantaneous_law(material.law, material.relaxation, material.moduli,
                                      "material of region '" + material.region + "'");
  if (reads_fibre_file(material))
    result.law.fibres.samples = std::make_shared<const fem::FibreSamples>(
        read_fibre_file(folder / material.fibre_file, material.fibre_unit));
  return result;
}

}  // namespace palpate::app
