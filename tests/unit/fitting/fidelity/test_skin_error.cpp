// SPDX-License-Identifier: AGPL-3.0-or-later
// Errors of a skin whose displacement is known in closed form.
#include "fitting/fidelity/skin_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/fitting/deformation/pressed_plate.hpp"

namespace palpate::fidelity {
namespace {

class SkinError : public testing::Test {
 protected:
  SkinError() {
    write_library(folder_ / "library.h5", plate_.library);
    Deformation deformation = fitting::compressed(plate_, fitting::dimple);
    // The dimple is as wide at every depth, as under a disc, and this one moves no vertex.
    deformation.tool_shape = "disc";
    deformation.tool_radius = 1e-4;
    write_deformation(folder_ / "deformation.pdef", deformation);
    for (const Vec3& at : {Vec3{0.033, 0.042, 0}, Vec3{0.047, 0.025, 0}})
      points_.push_back({0, {}, at, fitting::kDown, false, 0});
  }

  /// Direct fields of the dimple, `scale` times as large.
  SiteFields direct(std::int32_t point, float scale) const {
    const SkinMesh skin = skin_mesh(plate_.body);
    const Vec3& c = points_[static_cast<std::size_t>(point)].position;
    SiteFields fields{point,
                      "",
                      {{0.002, {}}, {0.005, {}}},
                      {{0.005, kAlong, kHeld, {}}, {0.005, kAlong, kBeyond, {}}}};
    for (const Vec3& x : skin.positions)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto at = [&](double z, const Vec3& q) {
          return scale * static_cast<float>(fitting::dimple(x, c, z, q)[i]);
        };
        fields.normal[0].skin.push_back(at(0.002, {}));
        fields.normal[1].skin.push_back(at(0.005, {}));
        for (LateralField& field : fields.lateral)
          field.skin.push_back(at(0.005, field.travel * kAlong) - at(0.005, {}));
      }
    return fields;
  }

  /// A press by 1 N, and as much aside for each millimetre.
  static SiteCurves forces() {
    CurvePath path;
    path.kind = PathKind::Lateral;
    path.lateral_depth = 0.005;
    path.direction = kAlong;
    for (const double travel : {0.0, kHeld, kBeyond}) {
      CurveSample sample;
      sample.displacement = travel;
      sample.force = fitting::kDown + 1e3 * travel * kAlong;
      path.samples.push_back(sample);
    }
    SiteCurves curves;
    curves.paths = {path};
    curves.status = SiteStatus::Complete;
    return curves;
  }

  std::vector<SkinErrorRow> measured(const std::vector<SiteFields>& fields,
                                     double friction = 0.3) const {
    const RenderedBody body(folder_ / "library.h5");
    const RenderedSkin skin(body, folder_ / "deformation.pdef");
    Curves direct;
    direct.tool.radius = 0.005;
    for (const SiteFields& of : fields) {
      direct.sites.push_back(curves_);
      direct.sites.back().vertex = of.vertex;
    }
    const auto of_site = [&](const SiteCurves& site) {
      return *std::find_if(fields.begin(), fields.end(),
                           [&](const SiteFields& of) { return of.vertex == site.vertex; });
    };
    return measure_skin(body, skin, points_, direct, of_site, friction);
  }

  static constexpr Vec3 kAlong{0, 1, 0};
  static constexpr double kHeld = 2e-4, kBeyond = 1e-3;  // m
  const SiteCurves curves_ = forces();
  samples::TemporaryFolder folder_;
  fitting::PressedPlate plate_;
  std::vector<HoldOutPoint> points_;
};

TEST_F(SkinError, IsSmallWhereTheSkinIsRight) {
  const auto rows = measured({direct(0, 1), direct(1, 1)});
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(rows[0].states, 4U);
  EXPECT_EQ(rows[2].states, 2U);
  EXPECT_EQ(rows[4].states, 2U);
  for (const SkinErrorRow& row : rows) EXPECT_LT(row.worst, 0.015) << row.what;
  EXPECT_GT(rows[0].p95, rows[1].p95);  // most of the plate does not move
}

TEST_F(SkinError, IsThatOfAWrongDirectField) {
  // A tenth too large at the second point: at its contact a tenth of the depth.
  const auto rows = measured({direct(0, 1), direct(1, 1.1F)});
  EXPECT_NEAR(rows[0].worst, 0.1, 0.015);
  EXPECT_EQ(rows[0].worst_point, 1U);
  EXPECT_EQ(rows[3].worst_point, 1U);
  EXPECT_EQ(rows[5].worst_point, 1U);
}

TEST_F(SkinError, DividesDragsByTheFrictionCoefficient) {
  const auto held = measured({direct(0, 1)}, 1.1);
  ASSERT_EQ(held.size(), 4U);
  EXPECT_EQ(held[2].what, "lateral within friction, within 3 tool radii");
  EXPECT_EQ(held[2].states, 2U);
  const auto beyond = measured({direct(0, 1)}, 0.1);
  ASSERT_EQ(beyond.size(), 4U);
  EXPECT_EQ(beyond[2].what, "lateral beyond friction, within 3 tool radii");
  EXPECT_EQ(beyond[2].states, 2U);
}

TEST_F(SkinError, OfAStateWithoutAForceIsRefused) {
  SiteFields fields = direct(0, 1);
  fields.lateral[0].travel = 3e-4;
  EXPECT_THROW(measured({fields}), Error);
}

TEST_F(SkinError, OfFieldsOfAnotherBodyIsRefused) {
  SiteFields fields = direct(0, 1);
  fields.normal[0].skin.pop_back();
  EXPECT_THROW(measured({fields}), Error);
}

}  // namespace
}  // namespace palpate::fidelity
