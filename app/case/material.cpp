// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/material.hpp"

namespace palpate::app {

fem::LawConstants law_of(const MaterialSection& material) {
  fem::LawConstants law(material.law, material.constants);
  if (!fem::law_entry(material.law).has_fibres) return law;
  fem::FibreField& fibres = law.fibres;
  const bool around = material.fibre_field == "cylindrical";
  fibres.kind = around ? fem::FibreField::Kind::Cylindrical : fem::FibreField::Kind::Constant;
  fibres.first = around ? material.fibre_axis : material.fibre_direction;
  fibres.second = material.fibre_plane;
  fibres.origin = material.fibre_axis_point;
  fibres.angle = material.fibre_angle;
  fibres.families = material.fibre_families;
  return law;
}

}  // namespace palpate::app
