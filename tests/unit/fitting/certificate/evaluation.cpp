// SPDX-License-Identifier: AGPL-3.0-or-later
// PALPATE_EVALUATED: the name of the function on this side.
#include "tests/unit/fitting/certificate/evaluation.hpp"

#include "runtime/local_model.hpp"

namespace palpate::test {

std::vector<double> PALPATE_EVALUATED(const runtime::Surface& surface,
                                      const std::vector<Evaluated>& states) {
  std::vector<double> numbers;
  const auto add = [&](const Vec3& v) { numbers.insert(numbers.end(), v.begin(), v.end()); };
  for (const Evaluated& state : states) {
    const runtime::LocalModel model(surface, state.point, 1e-5);
    add(model.contact_point());
    add(model.normal());
    for (const Vec3& tip : state.tips) {
      numbers.push_back(surface.outside_distance(surface.element(state.point.element), tip));
      const runtime::Deflection d = model.deflection(tip);
      numbers.insert(numbers.end(), {d.geometric, d.depth, d.lateral});
      add(d.tangent);
      const runtime::LocalResponse r = model.respond(d);
      numbers.insert(numbers.end(),
                     {r.normal_force, r.lateral_force, r.energy, r.friction_normal_force});
      add(r.force);
    }
  }
  return numbers;
}

}  // namespace palpate::test
