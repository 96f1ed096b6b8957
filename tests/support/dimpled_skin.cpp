// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/dimpled_skin.hpp"

#include <cmath>
#include <cstdint>
#include <numeric>

#include "format/to_index.hpp"

namespace palpate::test {
namespace {

constexpr std::size_t kModes = 7, kKnots = 9;

Vec3 across(const Vec3& n) {
  const Vec3 t = cross(n, std::abs(n[2]) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0});
  return (1 / norm(t)) * t;
}

void add_sites(const Library& library, Deformation& d) {
  d.donor_offset = {0};
  for (std::size_t v = 0; v < library.positions.size(); ++v) {
    if (library.responses[v].status != ResponseStatus::Hole) {
      d.donor.push_back(static_cast<std::int32_t>(d.sites.size()));
      d.donor_weight.push_back(1);
      d.sites.push_back({library.positions[v], library.inward[v], across(library.inward[v])});
    }
    d.donor_offset.push_back(static_cast<std::int64_t>(d.donor.size()));
  }
}

/// (1 - (s/R_c)^2)^2 along n, a tenth of its slope outwards.
void add_local_parts(Deformation& d) {
  const auto profile = [&](auto& out, double scale, double sign) {
    for (std::size_t j = 0; j < kKnots; ++j) {
      const double s = static_cast<double>(j) / (kKnots - 1);
      const double bump = (1 - s * s) * (1 - s * s);
      out.push_back(static_cast<float>(scale * (sign > 0 ? bump : 0.1 * s * bump)));
    }
  };
  for (std::size_t j = 0; j < kKnots; ++j)
    d.knots.push_back(d.reach * static_cast<double>(j) / (kKnots - 1));
  for (std::size_t site = 0; site < d.sites.size(); ++site) {
    for (const double depth : d.depths) {
      profile(d.press_local, depth, 1);
      profile(d.press_local, depth, -1);
    }
    for (std::size_t k = 0; k < d.lateral_depths.size(); ++k) {
      profile(d.lateral_local, 1, 1);
      profile(d.lateral_local, 1, 1);
      profile(d.lateral_local, 1, -1);
    }
  }
}

/// A twentieth of the deflection, otherwise in each direction, on a ring around the contact.
void add_anisotropic_parts(Deformation& d) {
  d.anisotropic_scale.assign(d.sites.size() * d.lateral_depths.size(), 5e-5F);
  for (std::size_t row = 0; row < d.anisotropic_scale.size() * kTangents; ++row)
    for (std::size_t c = 0; c < kAnisotropicComponents; ++c)
      for (std::size_t j = 0; j < kKnots; ++j) {
        const double s = static_cast<double>(j) / (kKnots - 1);
        const double ring = 4 * s * (1 - s) * std::cos(static_cast<double>(row + 3 * c));
        d.anisotropic.push_back(static_cast<std::int16_t>(1000 * ring));
      }
}

void add_waves(double size, Deformation& d) {
  for (std::size_t m = 0; m < kModes; ++m) {
    d.mode_scale.push_back(static_cast<float>(1.0 / (32767 * static_cast<double>(m + 1))));
    for (const Vec3& x : d.positions) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double phase = static_cast<double>(m + 1) * x[i] / size + static_cast<double>(i);
        d.modes.push_back(static_cast<std::int16_t>(std::lround(32767 * std::sin(phase))));
      }
    }
  }
  for (std::size_t s = 0; s < d.sites.size(); ++s) {
    const double turn = static_cast<double>(s);
    for (const double depth : d.depths)
      for (std::size_t m = 0; m < kModes; ++m)
        d.press_modes.push_back(
            static_cast<float>(0.1 * depth * std::cos(turn + static_cast<double>(m))));
    for (std::size_t k = 0; k < d.lateral_depths.size() * kTangents; ++k)
      for (std::size_t m = 0; m < kModes; ++m)
        d.lateral_modes.push_back(
            static_cast<float>(0.1 * std::sin(turn + 0.7 * static_cast<double>(k + m))));
  }
}

}  // namespace

SkinMesh skin_of(const Library& library) {
  SkinMesh skin;
  skin.positions = library.positions;
  skin.triangles = library.triangles;
  skin.node.resize(library.positions.size());
  std::iota(skin.node.begin(), skin.node.end(), 0);
  skin.vertex_of = skin.node;
  return skin;
}

Deformation dimpled(const Library& library, const SkinMesh& skin, double depth,
                    double tool_radius) {
  Deformation d;
  d.surface = surface_digest(library.positions, library.triangles);
  d.tool_shape = "sphere";
  d.tool_radius = tool_radius;
  d.reach = 4 * tool_radius;
  d.positions = skin.positions;
  d.triangles = skin.triangles;
  d.vertex_of = skin.vertex_of;
  d.depths = {0.25 * depth, depth};
  d.lateral_depths = {0.5 * depth};
  add_sites(library, d);
  add_local_parts(d);
  add_anisotropic_parts(d);
  add_waves(10 * tool_radius, d);
  return d;
}

}  // namespace palpate::test
