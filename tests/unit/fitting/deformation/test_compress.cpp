// SPDX-License-Identifier: AGPL-3.0-or-later
// From fields that are known in closed form to the skin that the runtime shows at a hold-out point.
#include "fitting/deformation/compress.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fitting/deformation/local_part.hpp"
#include "runtime/skin_deformation.hpp"
#include "tests/unit/fitting/deformation/pressed_plate.hpp"

namespace palpate::fitting {
namespace {

/// The tip z below and q beside a point of a triangle of the plate.
runtime::Touch touch_at(const PressedPlate& plate, std::int32_t element, const Vec3& natural,
                        double z, const Vec3& q = {}) {
  runtime::Touch touch;
  touch.point = {element, natural};
  const Triangle& corners = plate.library.triangles[static_cast<std::size_t>(element)];
  for (std::size_t l = 0; l < 3; ++l)
    touch.contact_point =
        touch.contact_point +
        natural[l] * plate.library.positions[static_cast<std::size_t>(corners[l])];
  touch.normal = kDown;
  touch.depth = z;
  touch.lateral = q;
  touch.tip = touch.contact_point + z * kDown + q;
  return touch;
}

std::vector<Vec3> shown(const runtime::SkinDeformation& skin, const runtime::Touch& touch) {
  std::vector<Vec3> x(skin.positions().size());
  skin.displace(touch, x.front().data());
  return x;
}

/// The largest distance from the field to the skin as shown, over the travel of the tip.
double worst_error(const runtime::SkinDeformation& skin, const runtime::Touch& touch,
                   const SkinField& field) {
  const auto x = shown(skin, touch);
  double worst = 0;
  for (std::size_t w = 0; w < x.size(); ++w) {
    const Vec3& at_rest = skin.positions()[w];
    const Vec3 direct = field(at_rest, touch.contact_point, touch.depth, touch.lateral);
    worst = std::max(worst, norm(x[w] - at_rest - direct));
  }
  return worst / std::hypot(touch.depth, norm(touch.lateral));
}

constexpr Vec3 kMiddle{0.3, 0.3, 0.4};  // of a triangle: 5 mm from the nearest site

TEST(Compress, ADimpleThatIsTheSameEverywhereMovesWithTheContact) {
  const PressedPlate plate;
  Deformation deformation = compressed(plate, dimple);
  // Of the same width at every depth; narrower than the dimple: it moves no vertex.
  deformation.tool_shape = "disc";
  deformation.tool_radius = 1e-4;
  const runtime::SkinDeformation skin(deformation, plate.library.triangles);
  for (const double z : {0.0005, 0.002, 0.0045, 0.006, 0.007})
    EXPECT_LT(worst_error(skin, touch_at(plate, 70, kMiddle, z), dimple), 0.01) << z;
  for (const Vec3& q : {Vec3{0.002, 0, 0}, Vec3{-0.001, 0.0015, 0}})
    EXPECT_LT(worst_error(skin, touch_at(plate, 70, kMiddle, 0.006, q), dimple), 0.01);
}

TEST(Compress, ARigidMotionStaysRigid) {
  const PressedPlate plate;
  const SkinField rigid = [](const Vec3&, const Vec3&, double z, const Vec3& q) {
    return z * kDown + q;
  };
  const runtime::SkinDeformation skin(compressed(plate, rigid), plate.library.triangles);
  for (const double z : {0.001, 0.004, 0.006})
    EXPECT_LT(worst_error(skin, touch_at(plate, 70, kMiddle, z), rigid), 1e-3);
  EXPECT_LT(worst_error(skin, touch_at(plate, 70, kMiddle, 0.006, {0.001, 0.002, 0}), rigid), 1e-3);
}

/// A dimple that is deeper than linear in the depth and grows across the plate, on a far field.
Vec3 uneven_dimple(const Vec3& x, const Vec3& c, double z, const Vec3& q) {
  const double far = 0.1 * z * (1 + 5 * c[0]) * std::cos(20 * x[1]);
  return dimple(x, c, z, (1 - 2 * c[1]) * q) +
         far * (1 - std::exp(-dot(x - c, x - c) / 1e-4)) * kDown;
}

TEST(Compress, TheContactPointMovesWithTheTip) {
  const PressedPlate plate;
  const runtime::SkinDeformation skin(compressed(plate, uneven_dimple), plate.library.triangles);
  // A corner of a triangle is a vertex of the skin: it goes where the tip is, at every depth.
  // Across n it does so as in the fields, of which the modes are rounded to 0.03 % of the deepest.
  for (const Vec3& corner : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    for (const double z : {0.0003, 0.0025, 0.006, 0.0065})
      for (const Vec3& q : {Vec3{}, Vec3{0.001, -0.0005, 0}}) {
        const runtime::Touch touch = touch_at(plate, 70, corner, z, q);
        const auto x = shown(skin, touch);
        const Vec3 nearest =
            *std::min_element(x.begin(), x.end(), [&](const Vec3& a, const Vec3& b) {
              return norm(a - touch.tip) < norm(b - touch.tip);
            });
        EXPECT_LT(std::abs(dot(nearest - touch.tip, kDown)), 1e-7);
        EXPECT_LT(norm(nearest - touch.tip), 3e-4 * kDeepest);
      }
}

/// The skin of an incompressible half-space under a frictionless sphere that then drags its contact
/// without slip. The press: [Johnson 1985, eq. 3.42]. The drag: within the contact radius
/// a = sqrt(R z) the skin follows; outside, with nu = 1/2 and the azimuth theta from q,
///   u = 2 |q| / (3 pi) (3 asin(a/r) + h cos 2 theta, h sin 2 theta),  h = (a/r) sqrt(1 - a^2/r^2),
/// the integral of Cerruti's solution over the traction (1 - r^2/a^2)^(-1/2) [Johnson 1985, 3.7].
Vec3 half_space(const Vec3& x, const Vec3& c, double z, const Vec3& q) {
  const Vec3 r = x - c;
  const double a = std::sqrt(kRadius * z), s = norm(r), ratio = a / s;
  if (s <= a) return z * (1 - 0.5 * s * s / (a * a)) * kDown + q;
  const double across = std::sqrt(1 - ratio * ratio);
  const double normal =
      z / std::numbers::pi * ((2 - 1 / (ratio * ratio)) * std::asin(ratio) + across / ratio);
  const Vec3 e = (1 / s) * r, mirrored = 2 * dot(e, q) * e - q;  // |q| (cos 2 theta, sin 2 theta)
  return normal * kDown +
         2 / (3 * std::numbers::pi) * (3 * std::asin(ratio) * q + ratio * across * mirrored);
}

TEST(Compress, ADragMovesTheSkinFarAwayAsTheContactIsWide) {
  const PressedPlate plate;
  // Dragged at 6 mm: at other depths the contact is narrower or wider.
  const Deformation deformation = compressed(plate, half_space);
  const runtime::SkinDeformation skin(deformation, plate.library.triangles);
  for (const double z : {0.0012, 0.003, 0.006, 0.0075})
    for (const Vec3& q : {Vec3{0.001, 0, 0}, Vec3{-0.0005, 0.001, 0}}) {
      const runtime::Touch touch = touch_at(plate, 70, kMiddle, z, q);
      const Vec3 c = touch.contact_point;
      const auto dragged = shown(skin, touch);
      const auto pressed = shown(skin, touch_at(plate, 70, kMiddle, z));
      double squares = 0, count = 0;
      for (std::size_t w = 0; w < dragged.size(); ++w) {
        const Vec3& x = skin.positions()[w];
        if (norm(x - c) < deformation.reach) continue;
        const Vec3 direct = half_space(x, c, z, q) - half_space(x, c, z, {});
        const Vec3 off = dragged[w] - pressed[w] - direct;
        squares += dot(off, off);
        ++count;
      }
      EXPECT_LT(std::sqrt(squares / count), 0.01 * norm(q)) << z;
    }
}

/// Root mean square over the skin within three tool radii of what a drag moves it otherwise than in
/// the field, over the drag.
double drag_error(const runtime::SkinDeformation& skin, const runtime::Touch& touch,
                  const SkinField& field) {
  runtime::Touch held = touch;
  held.lateral = {};
  held.tip = touch.tip - touch.lateral;
  const auto dragged = shown(skin, touch), pressed = shown(skin, held);
  const Vec3 c = touch.contact_point;
  double squares = 0, count = 0;
  for (std::size_t w = 0; w < dragged.size(); ++w) {
    const Vec3& x = skin.positions()[w];
    if (norm(x - c) > 3 * kRadius) continue;
    const Vec3 direct = field(x, c, touch.depth, touch.lateral) - field(x, c, touch.depth, {});
    const Vec3 off = dragged[w] - pressed[w] - direct;
    squares += dot(off, off);
    ++count;
  }
  return std::sqrt(squares / count) / norm(touch.lateral);
}

/// Under no tool, and as wide at every depth.
Deformation without_tool(Deformation deformation) {
  deformation.tool_shape = "disc";
  deformation.tool_radius = 1e-4;
  return deformation;
}

/// Twice as soft along `grain` as across it.
Vec3 grained(const Vec3& x, const Vec3& c, double z, const Vec3& q) {
  const Vec3 r = x - c, grain{std::cos(0.5), std::sin(0.5), 0};
  const double s = norm(r) / 0.007, fall = std::exp(-s * s);
  return dimple(x, c, z, {}) + fall * (q + 0.4 * s * s * dot(grain, q) * grain);
}

TEST(Compress, ADragMovesTheSkinAsItsDirectionAsks) {
  const PressedPlate plate;
  const runtime::SkinDeformation skin(without_tool(compressed(plate, grained)),
                                      plate.library.triangles);
  for (const double azimuth : {0.0, 0.5, 2.07, 3.6}) {
    const Vec3 q{0.001 * std::cos(azimuth), 0.001 * std::sin(azimuth), 0};
    EXPECT_LT(drag_error(skin, touch_at(plate, 70, kMiddle, kDeepest, q), grained), 0.015);
  }
}

/// The same with the frame of each site turned by an angle of its own.
TEST(Compress, TheFramesOfTheSitesMayDiffer) {
  const PressedPlate plate;
  Deformation d = without_tool(compressed(plate, grained));
  const runtime::SkinDeformation as_made(d, plate.library.triangles);
  const auto normals = inward_normals(d.positions, d.triangles);
  const std::size_t row = kTangents * kAnisotropicComponents * d.knots.size();
  for (std::size_t site = 0; site < d.sites.size(); ++site) {
    const double angle = 0.7 * static_cast<double>(site), cos = std::cos(angle),
                 sin = std::sin(angle);
    SiteFrame& frame = d.sites[site];
    frame.tangent = cos * frame.tangent + sin * cross(frame.inward, frame.tangent);
    const Vec3 second = cross(frame.inward, frame.tangent);
    Eigen::VectorXf u(static_cast<Eigen::Index>(3 * d.positions.size())), v = u;
    for (std::size_t w = 0; w < d.positions.size(); ++w)
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 &x = d.positions[w], &c = frame.position;
        const Vec3 pressed = grained(x, c, kDeepest, {});
        const auto at = static_cast<Eigen::Index>(3 * w + i);
        u[at] = static_cast<float>(grained(x, c, kDeepest, frame.tangent)[i] - pressed[i]);
        v[at] = static_cast<float>(grained(x, c, kDeepest, second)[i] - pressed[i]);
      }
    const auto taken = LocalPart(d.positions, normals, d.knots, frame).take_lateral(u, v);
    constexpr float kFine = 1e-5F;
    d.anisotropic_scale[site] = kFine;
    for (std::size_t i = 0; i < row; ++i)
      d.anisotropic[site * row + i] =
          static_cast<std::int16_t>(std::lround(taken.anisotropic[i] / kFine));
    const std::size_t modes = d.mode_count();
    float* amplitude = &d.lateral_modes[site * kTangents * modes];
    for (std::size_t m = 0; m < modes; ++m) {
      const float first = amplitude[m], other = amplitude[modes + m];
      amplitude[m] = static_cast<float>(cos) * first + static_cast<float>(sin) * other;
      amplitude[modes + m] = static_cast<float>(cos) * other - static_cast<float>(sin) * first;
    }
  }
  const runtime::SkinDeformation turned(d, plate.library.triangles);
  for (const Vec3& q : {Vec3{0.001, 0, 0}, Vec3{-0.0003, 0.0009, 0}}) {
    const runtime::Touch touch = touch_at(plate, 70, kMiddle, kDeepest, q);
    const auto x = shown(as_made, touch), y = shown(turned, touch);
    for (std::size_t w = 0; w < x.size(); ++w) EXPECT_LT(norm(x[w] - y[w]), 0.003 * norm(q)) << w;
  }
}

TEST(Compress, ToolThatSticksHoldsTheSkinWhereOneWithoutFrictionLetsItSlide) {
  const PressedPlate plate;
  const auto slides_by = [](double z) { return 0.08 * z * Vec3{0.8, -0.6, 0}; };
  const SkinField sliding = [&](const Vec3& x, const Vec3& c, double z, const Vec3& q) {
    return dimple(x, c, z, q + slides_by(z));
  };
  for (const char* friction : {"frictionless", "no-slip"}) {
    Deformation d =
        compress(plate.body, plate.library, {"sphere", kRadius, friction}, plate.all_vertices(),
                 [&](std::int32_t vertex) { return fields_at(plate, vertex, sliding); }, {});
    d.tool_shape = "disc";
    d.tool_radius = 1e-4;  // moves no vertex
    const bool slips = d.press_slips;
    EXPECT_EQ(slips, std::string(friction) == "frictionless");
    const runtime::SkinDeformation skin(d, plate.library.triangles);
    runtime::Touch touch = touch_at(plate, 70, {1, 0, 0}, kDeepest);  // at a site
    touch.shear = slides_by(kDeepest);
    EXPECT_LT(worst_error(skin, touch, slips ? SkinField(dimple) : sliding), 0.01);
    EXPECT_GT(worst_error(skin, touch, slips ? sliding : SkinField(dimple)), 0.05);
    touch.lateral = {0.0005, 0.001, 0};
    EXPECT_LT(worst_error(skin, touch, slips ? SkinField(dimple) : sliding), 0.01);
  }
}

TEST(Compress, NoVertexIsInsideTheTool) {
  const PressedPlate plate;
  // Narrower than the tool: without care the skin would cut through it.
  const SkinField narrow = [](const Vec3& x, const Vec3& c, double z, const Vec3& q) {
    const double s = norm(x - c) / 0.002;
    return std::exp(-s * s) * (z * kDown + q);
  };
  for (const char* shape : {"sphere", "disc"}) {
    Deformation deformation = compressed(plate, narrow);
    deformation.tool_shape = shape;
    deformation.tool_edge_radius = 0.001;
    const runtime::SkinDeformation skin(deformation, plate.library.triangles);
    for (const double z : {0.001, 0.003, 0.006}) {
      const runtime::Touch touch = touch_at(plate, 70, kMiddle, z, {0.001, 0, 0});
      std::size_t moved = 0;
      for (const Vec3& x : shown(skin, touch)) {
        const double below = dot(x - touch.tip, kDown);
        const double beside = norm(x - touch.tip - below * kDown);
        if (shape[0] == 's')
          EXPECT_GT(std::hypot(below + kRadius, beside), kRadius - 1e-9);
        else
          EXPECT_TRUE(below > -1e-9 || beside > 0.004 - 1e-9);
        if (below > -0.5 * z) ++moved;
      }
      EXPECT_GT(moved, 0U) << "the tool must be in contact for this test";
    }
  }
}

TEST(Compress, ASiteWithoutAllItsFieldsIsInterpolated) {
  const PressedPlate plate;
  const auto fields = [&](std::int32_t vertex) {
    SiteFields site = fields_at(plate, vertex, dimple);
    if (vertex == 40) site.normal.pop_back();
    if (vertex == 41) site.lateral.pop_back();
    return site;
  };
  const Deformation d = compress(plate.body, plate.library, {"sphere", kRadius, "frictionless"},
                                 plate.all_vertices(), fields, {});
  EXPECT_EQ(d.sites.size(), 79U);
  EXPECT_GT(d.donor_offset[41] - d.donor_offset[40], 2);
  EXPECT_EQ(d.donor_offset[43] - d.donor_offset[42], 1);
  const runtime::SkinDeformation skin(d, plate.library.triangles);
  EXPECT_LT(worst_error(skin, touch_at(plate, 70, {1, 0, 0}, 0.003), dimple), 0.01);
}

/// The integers of the weak modes are small, so that the file compresses; what that costs is less
/// than can be seen.
TEST(Compress, RoundsNoFinerThanNeedBe) {
  const PressedPlate plate;
  const Deformation d = compressed(plate, uneven_dimple);
  ASSERT_GT(d.mode_count(), 4U);
  const std::size_t row = d.modes.size() / d.mode_count();
  const auto largest = [&](std::size_t m) {
    int most = 0;
    for (std::size_t i = m * row; i < (m + 1) * row; ++i)
      most = std::max(most, std::abs(d.modes[i]));
    return most;
  };
  EXPECT_GT(largest(0), 10 * largest(d.mode_count() - 1));
  EXPECT_GT(largest(d.mode_count() - 1), 0);
  const runtime::SkinDeformation skin(d, plate.library.triangles);
  const runtime::Touch touch = touch_at(plate, 70, {1, 0, 0}, 0.006);
  const auto x = shown(skin, touch);
  double squares = 0;
  for (std::size_t w = 0; w < x.size(); ++w) {
    const Vec3 direct = uneven_dimple(skin.positions()[w], touch.contact_point, 0.006, {});
    const Vec3 off = x[w] - skin.positions()[w] - direct;
    // The tool moves what is inside it, whatever was rounded.
    if (norm(skin.positions()[w] - touch.contact_point) > 0.02) squares += dot(off, off);
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(x.size())), 1e-3 * 0.006);
}

TEST(Compress, FewModesSayWhatTheyLeaveOut) {
  const PressedPlate plate;
  const auto fields = [&](std::int32_t vertex) { return fields_at(plate, vertex, uneven_dimple); };
  const ToolDescription tool{"sphere", kRadius, "frictionless"};
  CompressSettings few, many;
  few.modes = 1;
  const Deformation one =
      compress(plate.body, plate.library, tool, plate.all_vertices(), fields, few);
  const Deformation all =
      compress(plate.body, plate.library, tool, plate.all_vertices(), fields, many);
  EXPECT_EQ(one.mode_count(), 1U);
  EXPECT_GT(one.rms_left_out, 10 * all.rms_left_out);
  EXPECT_LT(all.rms_left_out, 1e-3 * kDeepest);
}

}  // namespace
}  // namespace palpate::fitting
