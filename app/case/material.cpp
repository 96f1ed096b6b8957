// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/material.hpp"

#include "app/case/fibre_file.hpp"
#include "app/case/quantity.hpp"

namespace palpate::app {

fem::LawConstants law_of(const MaterialSection& material) {
  fem::LawConstants law(material.law, material.constants);
  if (!fem::law_entry(material.law).has_fibres) return law;
  fem::FibreField& fibres = law.fibres;
  using Kind = fem::FibreField::Kind;
  fibres.kind = material.fibre_field == "cylindrical" ? Kind::Cylindrical
                : material.fibre_field == "file"      ? Kind::Sampled
                : material.fibre_field == "laplace"   ? Kind::Laplace
                                                      : Kind::Constant;
  fibres.first = fibres.kind == Kind::Cylindrical ? material.fibre_axis : material.fibre_direction;
  fibres.second = material.fibre_plane;
  fibres.origin = material.fibre_axis_point;
  fibres.from = {material.fibre_from_low, material.fibre_from_high};
  fibres.to = {material.fibre_to_low, material.fibre_to_high};
  fibres.angle = material.fibre_angle;
  fibres.families = material.fibre_families;
  return law;
}

fem::LawConstants law_of(const MaterialSection& material, const std::filesystem::path& folder) {
  fem::LawConstants law = law_of(material);
  if (reads_fibre_file(material)) {
    const double unit = parse_quantity("1 " + material.fibre_unit, Dimension::Length).value;
    law.fibres.samples = std::make_shared<const fem::FibreSamples>(
        read_fibre_file(folder / material.fibre_file, unit));
  }
  return law;
}

bool reads_fibre_file(const MaterialSection& material) {
  return fem::law_entry(material.law).has_fibres && material.fibre_field == "file";
}

}  // namespace palpate::app
