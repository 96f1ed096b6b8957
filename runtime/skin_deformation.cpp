// SPDX-License-Identifier: Apache-2.0
#include "runtime/skin_deformation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "format/error.hpp"
#include "runtime/local_displacement.hpp"

namespace palpate::runtime {
namespace {

constexpr std::size_t kBlock = 256;  // vertices displaced at a time, in the first-level cache

std::size_t index(std::int64_t i) noexcept {
  return static_cast<std::size_t>(i);
}

/// A value between two levels: level k with `weight`, level k + 1 with `next`.
struct Levels {
  std::size_t k = 0;
  double weight = 0, next = 0;
};

/// Linear between depths; below the first proportional to the depth, beyond the last straight on.
Levels levels_at(const std::vector<double>& depths, double z) noexcept {
  if (z <= depths.front() || depths.size() == 1) return {0, z / depths.front(), 0};
  const auto above = std::upper_bound(depths.begin() + 1, depths.end() - 1, z);
  const auto k = static_cast<std::size_t>(above - depths.begin()) - 1;
  const double t = (z - depths[k]) / (depths[k + 1] - depths[k]);
  return {k, 1 - t, t};
}

/// The same for what is 1 at the contact at every depth: no extrapolation.
Levels levels_within(const std::vector<double>& depths, double z) noexcept {
  const double inside = std::clamp(z, depths.front(), depths.back());
  return levels_at(depths, inside);
}

/// add(site, level, weight) for each blended site at the two levels.
template <class Blend, class Add>
void at_both_levels(const Blend& blend, const Levels& levels, const Add& add) noexcept {
  for (std::size_t i = 0; i < blend.count; ++i) {
    if (levels.weight != 0) add(blend.site[i], levels.k, blend.weight[i] * levels.weight);
    if (levels.next != 0) add(blend.site[i], levels.k + 1, blend.weight[i] * levels.next);
  }
}

using Anisotropic = std::array<double, kAnisotropicComponents>;

/// The components along a tangent, as those along a direction from which it has the azimuth of
/// cosine c and sine s: cos m (phi - psi) and sin m (phi - psi) in terms of m phi, t and n x t in
/// terms of the direction.
Anisotropic turned_by(double c, double s, Anisotropic v) noexcept {
  const double c2 = c * c - s * s, s2 = 2 * s * c;
  const auto turn = [&v](std::size_t i, std::size_t j, double cos, double sin) {
    const double first = v[i];
    v[i] = cos * first - sin * v[j];
    v[j] = sin * first + cos * v[j];
  };
  for (std::size_t i = 0; i < v.size(); i += kHarmonics) turn(i + 1, i + 2, c, s);
  for (std::size_t i = 0; i < 2 * kHarmonics; i += kHarmonics) turn(i + 3, i + 4, c2, s2);
  for (std::size_t i = 0; i < kHarmonics; ++i) turn(i, kHarmonics + i, c, s);
  return v;
}

}  // namespace

/// The sites that the contact blends.
struct SkinDeformation::Blend {
  std::array<std::size_t, 3 * kMostDonors> site;
  std::array<double, 3 * kMostDonors> weight;
  std::size_t count = 0;
};

/// Profiles of one level, with its weight.
template <std::size_t Components>
struct Profiles {
  std::array<double, Components * SkinDeformation::kMostKnots> value{};
  double stretch = 1;  ///< distance where a profile is read, over that from the contact, near it
  bool used = false;
};

/// What displaces the vertices at one touch.
struct SkinDeformation::Shape {
  std::array<float, kMostModes> mode{};  ///< amplitudes, times the scale of the mode
  std::array<Profiles<kPressComponents>, 2> press;
  std::array<Profiles<kLateralComponents>, 2> lateral;
  /// m, along `drag` and around it; stretched as `lateral`.
  std::array<Profiles<kAnisotropicComponents>, 2> anisotropic;
  Vec3 drag{};  ///< unit, direction of the lateral deflection
  Vec3 correction{};
};

SkinDeformation::SkinDeformation(Deformation deformation, std::vector<Triangle> triangles)
    : d_(std::move(deformation)),
      surface_(std::move(triangles)),
      normals_(inward_normals(d_.positions, d_.triangles)) {
  std::int64_t most = 0;
  for (std::size_t v = 0; v + 1 < d_.donor_offset.size(); ++v)
    most = std::max(most, d_.donor_offset[v + 1] - d_.donor_offset[v]);
  if (d_.mode_count() <= kMostModes && d_.knots.size() <= kMostKnots && index(most) <= kMostDonors)
    return;
  throw Error(ErrorKind::Configuration, "deformation",
              "it has more modes, knots or donors than this program can blend",
              "make it again with this version");
}

SkinDeformation::Blend SkinDeformation::blend_at(const SurfacePoint& point) const noexcept {
  Blend blend;
  const Triangle& corners = surface_[index(point.element)];
  for (std::size_t l = 0; l < 3; ++l) {
    const std::size_t v = index(corners[l]);
    for (std::size_t i = index(d_.donor_offset[v]); i < index(d_.donor_offset[v + 1]); ++i) {
      const double weight = point.natural[l] * static_cast<double>(d_.donor_weight[i]);
      const std::size_t site = index(d_.donor[i]);
      std::size_t known = 0;
      while (known < blend.count && blend.site[known] != site) ++known;
      if (known == blend.count) {
        blend.site[known] = site;
        blend.weight[known] = 0;
        ++blend.count;
      }
      blend.weight[known] += weight;
    }
  }
  return blend;
}

/// The contact radius at a depth over that at a level. Under a round tool it grows like sqrt(z).
double SkinDeformation::contact_growth(double level, double depth) const noexcept {
  if (d_.tool_shape == "disc") return 1;
  return std::sqrt(std::max(depth, 0.0) / level);
}

/// The dimple grows with the contact: the profiles of a level are read at the same distance over
/// the contact radius.
double SkinDeformation::stretch(double level, double depth) const noexcept {
  constexpr double kMost = 4;
  const double growth = contact_growth(level, depth);
  return growth > 0 ? std::min(1 / growth, kMost) : 1;
}

void SkinDeformation::add_press(const Blend& blend, const Touch& touch,
                                Shape& shape) const noexcept {
  const std::size_t modes = d_.mode_count(), knots = d_.knots.size(), depths = d_.depths.size();
  const Levels levels = levels_at(d_.depths, std::max(touch.depth, 0.0));
  const auto add = [&](std::size_t site, std::size_t k, double weight) {
    const float* a = &d_.press_modes[(site * depths + k) * modes];
    for (std::size_t m = 0; m < modes; ++m)
      shape.mode[m] += static_cast<float>(weight) * a[m] * d_.mode_scale[m];
    const float* p = &d_.press_local[(site * depths + k) * kPressComponents * knots];
    Profiles<kPressComponents>& profiles = shape.press[k - levels.k];
    for (std::size_t j = 0; j < kPressComponents * knots; ++j)
      profiles.value[j] += weight * static_cast<double>(p[j]);
    profiles.stretch = stretch(d_.depths[k], touch.depth);
    profiles.used = true;
  };
  at_both_levels(blend, levels, add);
}

void SkinDeformation::add_lateral(const Blend& blend, const Touch& touch,
                                  Shape& shape) const noexcept {
  if (d_.lateral_depths.empty() || norm(touch.lateral) == 0) return;
  shape.drag = (1 / norm(touch.lateral)) * touch.lateral;
  const std::size_t modes = d_.mode_count(), knots = d_.knots.size(),
                    depths = d_.lateral_depths.size();
  const Levels levels = levels_within(d_.lateral_depths, touch.depth);
  const auto add = [&](std::size_t site, std::size_t k, double weight) {
    const SiteFrame& frame = d_.sites[site];
    const Vec3 second = cross(frame.inward, frame.tangent);
    const double along[kTangents] = {dot(touch.lateral, frame.tangent), dot(touch.lateral, second)};
    // Far away the skin follows the force, which for the same deflection grows like the contact
    // radius [Mindlin 1949].
    const double growth = contact_growth(d_.lateral_depths[k], touch.depth);
    for (std::size_t t = 0; t < kTangents; ++t) {
      const float* a = &d_.lateral_modes[((site * depths + k) * kTangents + t) * modes];
      const auto amplitude = static_cast<float>(weight * growth * along[t]);
      for (std::size_t m = 0; m < modes; ++m) shape.mode[m] += amplitude * a[m] * d_.mode_scale[m];
    }
    const float* p = &d_.lateral_local[(site * depths + k) * kLateralComponents * knots];
    Profiles<kLateralComponents>& profiles = shape.lateral[k - levels.k];
    for (std::size_t j = 0; j < kLateralComponents * knots; ++j)
      profiles.value[j] += weight * static_cast<double>(p[j]);
    profiles.stretch = stretch(d_.lateral_depths[k], touch.depth);
    profiles.used = true;
    if (d_.anisotropic.empty()) return;
    auto& anisotropic = shape.anisotropic[k - levels.k];
    add_anisotropic(site, k, weight, touch, anisotropic.value.data());
    anisotropic.stretch = profiles.stretch;
    anisotropic.used = true;
  };
  at_both_levels(blend, levels, add);
}

/// Turns what a site has along its tangents into what it has along the lateral deflection. The
/// frame of the site is carried to the contact.
void SkinDeformation::add_anisotropic(std::size_t site, std::size_t k, double weight,
                                      const Touch& touch, double* profiles) const noexcept {
  const std::size_t knots = d_.knots.size(), row = site * d_.lateral_depths.size() + k;
  const Vec3& tangent = d_.sites[site].tangent;
  const double along = dot(tangent, touch.lateral),
               around = dot(tangent, cross(touch.normal, touch.lateral)),
               length = std::sqrt(along * along + around * around);
  if (!(length > 0)) return;
  const double scale =
      weight * norm(touch.lateral) * static_cast<double>(d_.anisotropic_scale[row]);
  double c = along / length, s = around / length;  // of psi
  for (std::size_t t = 0; t < kTangents; ++t) {
    const std::int16_t* p = &d_.anisotropic[(row * kTangents + t) * kAnisotropicComponents * knots];
    for (std::size_t j = 0; j < knots; ++j) {
      Anisotropic v;
      for (std::size_t i = 0; i < v.size(); ++i)
        v[i] = scale * c * static_cast<double>(p[i * knots + j]);
      const auto turned = turned_by(c, s, v);
      for (std::size_t i = 0; i < v.size(); ++i) profiles[i * knots + j] += turned[i];
    }
    c = -std::exchange(s, c);  // the second tangent is a quarter turn on
  }
}

Vec3 SkinDeformation::shared_part(const Shape& shape, std::size_t vertex) const noexcept {
  Vec3 u{};
  const std::size_t row = 3 * d_.positions.size();
  for (std::size_t m = 0; m < d_.mode_count(); ++m)
    for (std::size_t i = 0; i < 3; ++i)
      u[i] += static_cast<double>(shape.mode[m]) *
              static_cast<double>(d_.modes[m * row + 3 * vertex + i]);
  return u;
}

/// There, the shared part is that of the corners of the triangle.
Vec3 SkinDeformation::at_contact(const Touch& touch, const Shape& shape) const noexcept {
  const Triangle& corners = surface_[index(touch.point.element)];
  Vec3 u{};
  for (const auto& press : shape.press) u = u + press.value[0] * touch.normal;
  for (const auto& lateral : shape.lateral) u = u + lateral.value[0] * touch.lateral;
  const std::size_t across = kHarmonics * d_.knots.size();
  for (const auto& part : shape.anisotropic)
    if (part.used)
      u = u + part.value[0] * shape.drag + part.value[across] * cross(touch.normal, shape.drag) +
          part.value[2 * across] * touch.normal;
  for (std::size_t l = 0; l < 3; ++l)
    u = u + touch.point.natural[l] * shared_part(shape, index(d_.vertex_of[index(corners[l])]));
  return u;
}

/// A press moves the contact point as deep as the tip, and lets it slip under the tool as in the
/// campaign; a lateral deflection moves it with the tip. What the blend moves it otherwise is taken
/// back around it.
void SkinDeformation::add_both(const Blend& blend, const Touch& touch,
                               Shape& shape) const noexcept {
  add_press(blend, touch, shape);
  const Vec3 pressed = at_contact(touch, shape);
  add_lateral(blend, touch, shape);
  const double too_shallow = std::max(touch.depth, 0.0) - dot(pressed, touch.normal);
  shape.correction =
      too_shallow * touch.normal + touch.lateral - (at_contact(touch, shape) - pressed);
}

Vec3 SkinDeformation::local_part(const Touch& touch, const Shape& shape,
                                 std::size_t vertex) const noexcept {
  const Vec3 r = d_.positions[vertex] - touch.contact_point;
  if (dot(r, r) >= d_.reach * d_.reach) return {};
  const FromContact from(touch.contact_point, touch.normal, d_.positions[vertex], normals_[vertex]);
  const double s = from.distance / d_.reach;
  const auto at = [&](const auto& profiles, std::size_t component) {
    const double read = from.distance * (profiles.stretch + (1 - profiles.stretch) * s * s);
    const KnotWeights knot = knot_weights(d_.knots, read);
    const std::size_t j = component * d_.knots.size() + knot.below;
    return (1 - knot.above_weight) * profiles.value[j] + knot.above_weight * profiles.value[j + 1];
  };
  Vec3 u = from.facing * (1 - s * s) * (1 - s * s) * shape.correction;
  for (const auto& press : shape.press)
    if (press.used) u = u + from.press(touch.normal, at(press, 0), at(press, 1));
  for (const auto& lateral : shape.lateral)
    if (lateral.used)
      u = u +
          from.lateral(touch.normal, touch.lateral, at(lateral, 0), at(lateral, 1), at(lateral, 2));
  for (const auto& part : shape.anisotropic) {
    if (!part.used) continue;
    Anisotropic p;
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = at(part, i);
    u = u + from.anisotropic(touch.normal, shape.drag, p);
  }
  return u;
}

/// The nearest point of the tool for a point inside it. The tool stands upright on the contact
/// point's normal direction.
Vec3 SkinDeformation::outside_of_tool(const Touch& touch, const Vec3& x) const noexcept {
  const Vec3& n = touch.normal;
  const double radius = d_.tool_radius;
  if (d_.tool_shape == "sphere") {
    const Vec3 r = x - (touch.tip - radius * n);
    const double distance = norm(r);
    if (distance >= radius) return x;
    return touch.tip - radius * n + (distance > 0 ? (radius / distance) * r : radius * n);
  }
  if (d_.tool_shape != "disc") return x;
  // The end of a disc: flat to the fillet, of the same radius as a torus from there.
  const double below = dot(x - touch.tip, n);  // < 0 on the side of the tool
  const Vec3 across = x - touch.tip - below * n;
  const double distance = norm(across), fillet = d_.tool_edge_radius;
  if (below >= 0 || below < -touch.depth - radius || distance >= radius) return x;
  const double flat = radius - fillet, beyond = distance - flat;
  if (beyond <= 0) return x - below * n;
  const double end = -fillet + std::sqrt(std::max(fillet * fillet - beyond * beyond, 0.0));
  return below < end ? x + (end - below) * n : x;
}

/// Adds the shared part of `count` components from `begin` on. Four modes at a time, which saves
/// most of the loads and stores of u; the sums are those of one after the other.
void SkinDeformation::add_modes(const Shape& shape, std::size_t begin, std::size_t count,
                                float* u) const noexcept {
  const std::size_t row = 3 * d_.positions.size(), modes = d_.mode_count();
  const auto of = [&](std::size_t m) { return d_.modes.data() + m * row + begin; };
  std::size_t m = 0;
  for (; m + 4 <= modes; m += 4) {
    const std::int16_t *first = of(m), *second = of(m + 1), *third = of(m + 2), *last = of(m + 3);
    const float a = shape.mode[m], b = shape.mode[m + 1], c = shape.mode[m + 2],
                d = shape.mode[m + 3];
    for (std::size_t i = 0; i < count; ++i)
      u[i] = u[i] + a * static_cast<float>(first[i]) + b * static_cast<float>(second[i]) +
             c * static_cast<float>(third[i]) + d * static_cast<float>(last[i]);
  }
  for (; m < modes; ++m)
    for (std::size_t i = 0; i < count; ++i) u[i] += shape.mode[m] * static_cast<float>(of(m)[i]);
}

void SkinDeformation::displace(Touch touch, double* positions) const noexcept {
  if (d_.press_slips) touch.lateral = touch.lateral - touch.shear;
  const std::size_t count = d_.positions.size();
  const bool touches = touch.point.element >= 0;
  Shape shape;
  const Blend blend = touches ? blend_at(touch.point) : Blend{};
  if (blend.count > 0) add_both(blend, touch, shape);
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t size = std::min(kBlock, count - begin);
    std::array<float, 3 * kBlock> u{};
    if (blend.count > 0) add_modes(shape, 3 * begin, 3 * size, u.data());
    for (std::size_t i = 0; i < size; ++i) {
      Vec3 x = d_.positions[begin + i];
      if (blend.count > 0) {
        const Vec3 shared{static_cast<double>(u[3 * i]), static_cast<double>(u[3 * i + 1]),
                          static_cast<double>(u[3 * i + 2])};
        x = outside_of_tool(touch, x + shared + local_part(touch, shape, begin + i));
      }
      const Vec3 world = touch.pose.to_world(x);
      std::copy(world.begin(), world.end(), positions + 3 * (begin + i));
    }
  }
}

}  // namespace palpate::runtime
