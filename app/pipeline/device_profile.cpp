// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/device_profile.hpp"

#include "app/case/reader.hpp"
#include "format/error.hpp"

namespace palpate::fitting {

/// The keys of a device profile (found by argument-dependent lookup, so in this namespace).
template <class V>
void describe(V& v, DeviceProfile& p) {
  using palpate::Dimension;
  v.text(p.name, {"name", "name of the device", app::kRequired});
  v.quantity(
      p.damping, Dimension::Damping,
      {"damping", "smallest viscous damping over all directions", app::kOptional, app::kPositive});
  v.quantity(p.coulomb_friction, Dimension::Force,
             {"coulomb_friction", "dry friction", app::kOptional, app::kNotNegative});
  v.quantity(p.delay, Dimension::Time,
             {"delay", "delay between position and force, beyond a sample of the loop",
              app::kOptional, app::kNotNegative});
  v.quantity(p.position_resolution, Dimension::Length,
             {"position_resolution", "step of the reported position along an axis", app::kOptional,
              app::kNotNegative});
  v.quantity(
      p.force_resolution, Dimension::Force,
      {"force_resolution", "step of the force along an axis", app::kOptional, app::kNotNegative});
  v.quantity(p.continuous_force, Dimension::Force,
             {"continuous_force", "largest force that the device sustains", app::kOptional,
              app::kPositive});
  v.quantity(p.peak_force, Dimension::Force,
             {"peak_force", "largest force", app::kOptional, app::kPositive});
  v.text(p.source, {"source", "source of the values", app::kRequired});
}

}  // namespace palpate::fitting

namespace palpate::app {

fitting::DeviceProfile read_device_profile(const std::filesystem::path& path) {
  const toml::table table = read_toml(path, "the device profile");
  SourceMap sources(path.string());
  fitting::DeviceProfile profile;
  TableReader reader(table, "the device profile", "", sources);
  describe(reader, profile);
  reader.finish();
  return profile;
}

}  // namespace palpate::app
