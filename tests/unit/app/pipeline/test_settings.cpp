// SPDX-License-Identifier: AGPL-3.0-or-later
// The keys of a case are the settings of the stages: same defaults, and no key without effect.
#include "app/pipeline/settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <sstream>

#include "app/case/describe/case.hpp"
#include "app/case/range_text.hpp"

namespace palpate::app {
namespace {

const std::string kCase = R"([surface]
file = "skin.off"
unit = "mm"

[[inclusion]]
file = "nodule.off"
unit = "mm"
region = "nodule"

[[support]]
shape = "plane"
point = ["0 mm", "0 mm", "1 mm"]
normal = [0, 0, -1]

[[support]]
shape = "surface"
file = "bone.off"
unit = "mm"
distance = "1 mm"
normal_stiffness = "20 kPa/mm"

[[support]]
shape = "box"
low = ["0 mm", "0 mm", "0 mm"]
high = ["1 mm", "1 mm", "1 mm"]

[[support]]
shape = "sphere"
centre = ["0 mm", "0 mm", "0 mm"]
radius = "1 mm"

[[support]]
shape = "label"
label = "base"

[[material]]
young = "10 kPa"
poisson = 0.45
relaxation = [{ fraction = 0.3, time = "0.1 s" }, { fraction = 0.2, time = "2 s" }]
moduli = "instantaneous"

[[material]]
region = "nodule"
law = "holzapfel-gasser-ogden"
c = "3 kPa"
k1 = "2 kPa"
k2 = 0.8
kappa = 0.1
poisson = 0.49
fibre_direction = [1, 0, 0]
fibre_plane = [0, 1, 0]

[tool]
shape = "cylinder"
length = "4 mm"
)";

Workspace workspace(const Case& c) {
  Workspace space;
  space.c = c;
  space.case_folder = "/cases";
  return space;
}

/// Exact text of everything that the stages are given.
class SettingsText {
 public:
  explicit SettingsText(const Case& c) {
    out_.precision(17);
    const Workspace space = workspace(c);
    add(mesh_settings(space));
    add(campaign_settings(space));
    const fitting::FitSettings fit = fit_settings(space);
    add(fit.relative_tolerance, fit.absolute_tolerance, fit.max_knots, fit.fill_holes,
        fit.interpolate, fit.between_nodes, fit.lean, fit.soft_axes, static_cast<int>(fit.kind));
    add(c.sampling.initial_spacing, c.sampling.tolerance, c.sampling.hold_out_points,
        c.sampling.max_sites, static_cast<int>(c.sampling.method));
    add(c.certify.friction, c.certify.devices.size());
    add(c.deformation.depths, c.deformation.modes);
    const SimulateSection& s = c.simulate;
    add(static_cast<int>(s.path));
    add(s.from);
    add(s.to);
    add(s.rate, s.press_depth, s.press_speed, s.hold, s.slide_length, s.slide_speed, s.tank_cap,
        s.device.mass, s.device.damping, s.device.coulomb_friction, s.device.hand_stiffness,
        s.device.hand_damping);
    add(c.output.folder);
  }
  std::string text() const { return out_.str(); }

 private:
  template <class... Values>
  void add(const Values&... values) {
    ((out_ << values << ' '), ...);
    out_ << '\n';
  }
  void add(const Vec3& v) { add(v[0], v[1], v[2]); }
  void add(const std::vector<double>& values) {
    for (const double value : values) add(value);
  }
  void add(const mesher::SurfaceFile& file) {
    add(file.path.string(), file.unit, file.region_name, file.is_void, file.smooth);
    add(static_cast<int>(file.repair.mode), file.repair.largest_part, file.repair.max_hole,
        file.repair.max_change);
  }
  void add(const mesher::PlaneSupport& s) { add(s.point), add(s.normal); }
  void add(const mesher::BoxSupport& s) { add(s.low), add(s.high); }
  void add(const mesher::SphereSupport& s) { add(s.centre), add(s.radius); }
  void add(const mesher::SurfaceSupport& s) { add(s.surface), add(s.distance); }
  void add(const mesher::LabelSupport& s) { add(s.label); }
  void add(const mesher::Zone& zone) {
    add(zone.inverted);
    std::visit([this](const auto& s) { add(s); }, zone.shape);
  }
  void add(const mesher::VolumeMeshFile& file) {
    add(file.path.string(), file.unit, file.region_array);
    for (const auto& [group, region] : file.regions) add(group, region);
  }
  void add(const mesher::Settings& s) {
    add(s.name, static_cast<int>(s.method), s.patch_spacing, s.element_size, s.interior_coarsening,
        s.support_coarsening, s.feature_angle, static_cast<int>(s.directions), s.curved_facets,
        s.tool_radius, s.depth, s.lateral_travel);
    add(s.surface);
    add(s.volume_mesh);
    for (const auto& zone : s.press) add(zone);
    for (const auto& inclusion : s.inclusions) add(inclusion);
    for (const auto& layer : s.layers) add(layer.thickness, layer.region_name);
    for (const auto& support : s.supports) add(support);
    for (const auto& springs : s.foundation) {
      add(springs.where);
      add(springs.normal_stiffness, springs.tangential_stiffness);
    }
  }
  void add(const fem::RegionMaterial& m) {
    add(m.region, m.density, m.law.law);
    for (const auto& [name, value] : m.law.values) add(name, value);
    for (const RelaxationBranch& branch : m.relaxation) add(branch.fraction, branch.time_s);
    const fem::FibreField& f = m.law.fibres;
    add(static_cast<int>(f.kind), f.angle, f.families);
    for (const Vec3& v :
         {f.first, f.second, f.origin, f.from.low, f.from.high, f.to.low, f.to.high})
      add(v);
  }
  void add(const fem::CampaignSettings& s) {
    for (const auto& material : s.materials) add(material);
    add(static_cast<int>(s.dilatation), s.gravity.density, static_cast<int>(s.gravity.shape),
        s.mesh_error_sites);
    add(s.gravity.acceleration);
    const fem::IndentationSettings& i = s.indentation;
    add(static_cast<int>(i.tool.shape), i.tool.radius, i.tool.edge_radius, i.tool.length,
        static_cast<int>(i.friction), i.tool_azimuth, i.depth, i.increments, i.lateral_travel,
        i.lateral_increments, i.force_tolerance, i.refine_under_tool);
    add(i.lateral_depths);
    add(i.azimuths);
    add(i.drag_across);
  }

  std::ostringstream out_;
};

/// Visits the keys of a case and gives the one with this number another value.
class Change {
 public:
  explicit Change(int number) : number_(number) {}
  const std::string& key() const { return key_; }  ///< empty when there are fewer keys

  void text(std::string& value, const Key& key, const Choices& choices = {}) {
    if (!is_next(key)) return;
    if (choices.empty()) {
      value += "x";
    } else {
      value = value == choices[0] ? choices[1] : choices[0];
    }
  }
  void texts(std::vector<std::string>& values, const Key& key) {
    if (is_next(key)) values.emplace_back("x");
  }
  void flag(bool& value, const Key& key) {
    if (is_next(key)) value = !value;
  }
  void flag_or_count(int& value, std::string_view, const Key& key) {
    if (is_next(key)) ++value;
  }
  void integer(int& value, const Key& key) {
    if (is_next(key)) ++value;
  }
  void number(double& value, const Key& key) {
    if (is_next(key)) value += 1e-3;
  }
  void quantity(double& value, Dimension, const Key& key) { number(value, key); }
  void quantities(std::vector<double>& values, Dimension, const Key& key) {
    number(values.front(), key);
  }
  void quantity_or_auto(double& value, Dimension, const Key& key) {
    if (is_next(key)) value = std::isnan(value) ? 1 : value + 1e-3;
  }
  void quantities_or_auto(std::vector<double>& values, Dimension dimension, const Key& key) {
    quantities(values, dimension, key);
  }
  void point(Vec3& value, Dimension, const Key& key) { number(value[1], key); }
  void direction(Vec3& value, const Key& key) { number(value[1], key); }
  template <class S, class Body>
  void tables(std::vector<S>& list, const Key&, Body body) {
    for (S& s : list) body(*this, s);
  }
  bool when(std::string_view, const std::string& value, std::string_view wanted) {
    return value == wanted;
  }
  bool has_section(std::string_view, bool has_values) { return has_values; }
  template <class Body>
  void section(std::string_view name, Presence, std::string_view, Body body) {
    section_ = std::string(name) + ".";
    body(*this);
  }
  template <class S, class Body>
  void sections(std::string_view name, std::vector<S>& list, Presence, std::string_view,
                Body body) {
    section_ = std::string(name) + ".";
    for (S& s : list) body(*this, s);
  }

 private:
  bool is_next(const Key& key) {
    if (count_++ != number_) return false;
    key_ = section_ + std::string(key.name);
    return true;
  }

  int number_, count_ = 0;
  std::string section_, key_;
};

Case adaptive_case() {
  return parse_case(kCase + "[sampling]\nmethod = \"adaptive\"\n", "body.toml", [](const Case&) {
    return BodySize{0.15, 0.05};
  });
}

TEST(StageSettings, EveryKeyChangesTheSettingsOfAStage) {
  const Case c = adaptive_case();
  const std::string before = SettingsText(c).text();
  int keys = 0;
  for (;; ++keys) {
    Change change(keys);
    Case other = c;
    describe(change, other);
    if (change.key().empty()) break;
    EXPECT_NE(SettingsText(other).text(), before) << change.key();
  }
  EXPECT_GT(keys, 70);
}

TEST(StageSettings, EveryKeyOfAVolumeMeshAndAPressZoneChangesTheSettings) {
  Case c = adaptive_case();
  c.mesh.volume_mesh = {"organ.vtu", 1e-3, "part", {{"part=1", "matrix"}}};
  c.mesh.press = {mesher::LabelSupport{"top"}};
  const std::string before = SettingsText(c).text();
  int changed = 0;
  for (int key = 0;; ++key) {
    Change change(key);
    Case other = c;
    describe(change, other);
    if (change.key().empty()) break;
    const std::string section = change.key().substr(0, change.key().find('.'));
    if (section != "volume_mesh" && section != "mesh_region" && section != "press") continue;
    EXPECT_NE(SettingsText(other).text(), before) << change.key();
    ++changed;
  }
  EXPECT_EQ(changed, 8);
}

TEST(StageSettings, KeysThatACaseLeavesOutHaveTheDefaultsOfTheStages) {
  const Case c = adaptive_case();
  const Workspace space = workspace(c);
  const mesher::Settings mesh = mesh_settings(space), mesh_default;
  EXPECT_EQ(mesh.interior_coarsening, mesh_default.interior_coarsening);
  EXPECT_EQ(mesh.support_coarsening, mesh_default.support_coarsening);
  EXPECT_EQ(mesh.feature_angle, mesh_default.feature_angle);
  EXPECT_EQ(mesh.directions, mesh_default.directions);
  EXPECT_EQ(mesh.curved_facets, mesh_default.curved_facets);
  EXPECT_EQ(mesh.surface.region_name, mesh_default.surface.region_name);
  const fem::CampaignSettings campaign = campaign_settings(space), campaign_default;
  EXPECT_EQ(campaign.dilatation, campaign_default.dilatation);
  EXPECT_EQ(campaign.gravity.density, campaign_default.gravity.density);
  EXPECT_EQ(campaign.gravity.shape, campaign_default.gravity.shape);
  const auto& paths = campaign.indentation;
  const auto& paths_default = campaign_default.indentation;
  EXPECT_EQ(paths.friction, paths_default.friction);
  EXPECT_EQ(paths.increments, paths_default.increments);
  EXPECT_EQ(paths.lateral_increments, paths_default.lateral_increments);
  EXPECT_EQ(paths.azimuths, paths_default.azimuths);
  EXPECT_TRUE(paths.drag_across);
  EXPECT_EQ(paths.force_tolerance, paths_default.force_tolerance);
  EXPECT_EQ(paths.refine_under_tool, paths_default.refine_under_tool);
  EXPECT_EQ(campaign.mesh_error_sites, campaign_default.mesh_error_sites);
  const fitting::FitSettings fit = fit_settings(space), fit_default;
  EXPECT_EQ(fit.relative_tolerance, fit_default.relative_tolerance);
  EXPECT_TRUE(std::isnan(fit.absolute_tolerance));
  EXPECT_EQ(fit.max_knots, fit_default.max_knots);
  EXPECT_EQ(fit.kind, ResponseKind::Coupled);
  EXPECT_EQ(certify_settings(space).friction, fitting::CertifySettings{}.friction);
}

TEST(StageSettings, DirectionsForSlidesAreARemedyWhereTheyAreNotInUse) {
  Case c = adaptive_case();
  EXPECT_EQ(certify_settings(workspace(c)).slide_remedy,
            "press_directions = \"sliding\" in [mesh]");
  c.mesh.directions = mesher::PressDirections::Sliding;
  EXPECT_EQ(certify_settings(workspace(c)).slide_remedy, "");
}

TEST(StageSettings, PathsAreRelativeToTheCaseAndNormalsOfUnitLength) {
  Case c = adaptive_case();
  std::get<mesher::PlaneSupport>(c.supports[0].where.shape).normal = {0, 0, -4};
  const mesher::Settings mesh = mesh_settings(workspace(c));
  EXPECT_EQ(mesh.surface.path, "/cases/skin.off");
  EXPECT_EQ(mesh.inclusions.at(0).path, "/cases/nodule.off");
  EXPECT_EQ(std::get<mesher::PlaneSupport>(mesh.supports.at(0).shape).normal, (Vec3{0, 0, -1}));
  ASSERT_EQ(mesh.foundation.size(), 1U);
  EXPECT_EQ(std::get<mesher::SurfaceSupport>(mesh.foundation[0].where.shape).surface.path,
            "/cases/bone.off");
  EXPECT_EQ(mesh.supports.size(), 4U);
}

TEST(StageSettings, NodesAsSitesHaveTheElementSizeAsPatchSpacing) {
  Case c = adaptive_case();
  c.sampling.method = SamplingMethod::Nodes;
  EXPECT_EQ(mesh_settings(workspace(c)).patch_spacing, c.mesh.element_size);
  EXPECT_FALSE(fit_settings(workspace(c)).interpolate);
}

TEST(StageSettings, StagesDependOnTheirSectionsAlone) {
  const Case c = adaptive_case();
  Case other = c;
  other.certify.friction = 0.5;
  for (const Stage stage : {Stage::Mesh, Stage::Precompute, Stage::Fit})
    EXPECT_EQ(stage_case(workspace(c), stage), stage_case(workspace(other), stage))
        << stage_name(stage);
  EXPECT_NE(stage_case(workspace(c), Stage::Certify), stage_case(workspace(other), Stage::Certify));
}

TEST(StageSettings, InputsOfAStageAreItsFiles) {
  Case c = adaptive_case();
  c.certify.devices = {"a.toml", "b.toml"};
  const Workspace space = workspace(c);
  using ::testing::ElementsAre;
  EXPECT_THAT(stage_inputs(space, Stage::Mesh),
              ElementsAre("/cases/skin.off", "/cases/nodule.off", "/cases/bone.off"));
  EXPECT_THAT(stage_inputs(space, Stage::Precompute), ElementsAre(space.body()));
  EXPECT_THAT(stage_inputs(space, Stage::Fit), ElementsAre(space.body(), space.curves()));
  EXPECT_THAT(stage_inputs(space, Stage::Certify), ElementsAre("/cases/a.toml", "/cases/b.toml"));
}

TEST(CaseNames, AreThoseOfTheSolver) {
  for (const auto& [shape, name] : kToolShapes) EXPECT_EQ(fem::name_of(shape), name);
  for (const auto& [friction, name] : kToolFrictions) EXPECT_EQ(fem::name_of(friction), name);
}

}  // namespace
}  // namespace palpate::app
