// SPDX-License-Identifier: AGPL-3.0-or-later
// The same mesh, element, laws and boundary conditions in CalculiX, by the decks that `palpate
// export site --calculix` writes: a bonded patch and rigid tools in contact, pressed into a block.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "app/export/deck.hpp"
#include "app/export/mesh_file.hpp"
#include "fem/campaign/bonded_patch.hpp"
#include "fem/campaign/indentation.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/prism_body.hpp"
#include "tests/support/round_cap.hpp"
#include "tests/support/sample_laws.hpp"
#include "tests/verification/calculix.hpp"
#include "tests/verification/record.hpp"

namespace palpate::app {
namespace {

constexpr double kPatchRadius = 0.005;

/// 30 x 30 x 15 mm, base fixed; the lower half is a second region.
Body block(int cells) {
  Body body = test::make_block(test::even(-0.015, 0.015, cells), test::even(-0.015, 0.015, cells),
                               test::even(-0.015, 0, cells / 2));
  body.region_names = {"upper", "lower"};
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t) {
    double z = 0;
    for (const std::int32_t n : body.tetrahedra[t]) z += 0.25 * body.nodes[to_index(n)][2];
    body.tetrahedron_region[t] = z < -0.0075 ? 1 : 0;
  }
  return body;
}

fem::CampaignSettings settings_of(const fem::LawConstants& law, fem::Dilatation dilatation) {
  fem::CampaignSettings settings;
  settings.materials = {{"upper", law}, {"lower", law}};
  settings.dilatation = dilatation;
  settings.indentation.depth = 0.003;
  settings.indentation.increments = 3;
  settings.indentation.lateral_depths.clear();
  return settings;
}

using test::numbers_below;
using test::printed_by_calculix;

/// Force of the patch on the body after each increment, as CalculiX prints it.
std::vector<Vec3> run_calculix(const Deck& deck) {
  return numbers_below<3>("total force", printed_by_calculix(calculix_deck(deck)));
}

constexpr auto kProblem =
    "CalculiX on the same mesh and element: a bonded patch of 5 mm, 3 mm deep";

/// The normal force at every increment; its largest relative difference is a row.
void compare(const std::string& what, const Body& body, const fem::CampaignSettings& settings,
             double allowed) {
  const std::int32_t vertex = test::site_nearest(body);
  const auto ours = fem::press_patch(body, settings, vertex, kPatchRadius);
  EXPECT_EQ(ours.reason, "");
  const auto theirs = run_calculix(make_patch_deck(body, settings, vertex, kPatchRadius));
  EXPECT_EQ(theirs.size() + 1, ours.samples.size());
  double worst = 0;
  for (std::size_t i = 0; i < std::min(theirs.size(), ours.samples.size() - 1); ++i) {
    const double a = ours.samples[i + 1].force[2], b = theirs[i][2];
    worst = std::max(worst, std::abs(a / b - 1));
  }
  if (!theirs.empty()) {
    test::verify({kProblem, what + ", force at the end", "N", -ours.samples.back().force[2],
                  -theirs.back()[2], test::Reference::OtherSolver,
                  "CalculiX, deck of palpate export", allowed});
  }
  EXPECT_LT(worst, allowed);
}

double volume_of(const Body& body, const Tetrahedron& t) {
  const auto from_first = [&](std::size_t k) {
    return body.nodes[to_index(t[k])] - body.nodes[to_index(t[0])];
  };
  return dot(cross(from_first(1), from_first(2)), from_first(3)) / 6;
}

/// The mesh that `palpate export mesh` writes, with the lines that a user adds: each region weighs
/// what it does, and the set of the support holds it.
TEST(CalculixMesh, RegionsHaveTheirVolumeAndTheSupportCarriesTheWeight) {
  const Body body = block(4);
  std::string deck = abaqus_mesh(body) + "*MATERIAL, NAME=SOFT\n*ELASTIC\n10000., 0.45\n";
  deck += "*DENSITY\n1000.\n*BOUNDARY\nfixed, 1, 3\n";
  for (const char* region : {"upper", "lower"})
    deck += std::string("*SOLID SECTION, ELSET=") + region + ", MATERIAL=SOFT\n";
  deck += "*STEP\n*STATIC\n*DLOAD\nupper, GRAV, 10., 0., 0., -1.\nlower, GRAV, 10., 0., 0., -1.\n";
  for (const char* region : {"upper", "lower"})
    deck += std::string("*EL PRINT, ELSET=") + region + ", TOTALS=ONLY\nEVOL\n";
  deck += "*NODE PRINT, NSET=fixed, TOTALS=ONLY\nRF\n*END STEP\n";
  const std::string printed = printed_by_calculix(deck);
  const auto volumes = numbers_below<1>("total volume", printed);
  ASSERT_EQ(volumes.size(), 2U) << printed;
  for (const auto& volume : volumes) EXPECT_NEAR(volume[0], 0.5 * 13.5e-6, 1e-12);
  // A quarter of the weight of each tetrahedron at a fixed corner goes straight into the ground,
  // and is no force of the body on it.
  double carried = 1000 * 10 * 13.5e-6;
  for (const Tetrahedron& t : body.tetrahedra)
    for (const std::int32_t v : t)
      if (std::binary_search(body.fixed_nodes.begin(), body.fixed_nodes.end(), v))
        carried -= 1000 * 10 * volume_of(body, t) / 4;
  const auto forces = numbers_below<3>("total force", printed);
  ASSERT_EQ(forces.size(), 1U);
  EXPECT_NEAR(forces[0][2], carried, 1e-5 * carried);
  EXPECT_NEAR(std::hypot(forces[0][0], forces[0][1]), 0, 1e-8);
}

class Calculix : public testing::TestWithParam<fem::LawConstants> {};

/// With the same volumetric energy the two programs solve the same equations; with CalculiX's
/// kappa/2 (J - 1)^2 they differ by what that makes of a compressible tissue.
double allowed(const std::string& law) {
  return law == "arruda-boyce" || law == "saint-venant-kirchhoff" ? 1e-4 : 0.005;
}

TEST_P(Calculix, AgreesOnEveryLawItHas) {
  auto settings = settings_of(GetParam(), fem::Dilatation::Pointwise);
  std::string what = GetParam().law + ", nu = 0.45";
  if (GetParam().law == "saint-venant-kirchhoff") {  // deeper it loses ellipticity
    settings.indentation.depth = 0.001;
    what += ", 1 mm deep";
  }
  compare(what, block(4), settings, allowed(GetParam().law));
}

std::vector<fem::LawConstants> shared_laws() {
  std::vector<fem::LawConstants> laws;
  for (const fem::LawConstants& law : test::sample_laws(0.45))
    if (law.law != "demiray-fung" && law.law != "veronda-westmann" && law.law != "gent" &&
        law.law != "holzapfel-gasser-ogden")
      laws.push_back(law);
  return laws;
}

INSTANTIATE_TEST_SUITE_P(Laws, Calculix, testing::ValuesIn(shared_laws()),
                         [](const auto& instance) {
                           std::string name = instance.param.law;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Calculix, AgreesOnRegionsOfDifferentLaws) {
  auto settings = settings_of({"arruda-boyce", {{"mu", 3e3}, {"lambda_m", 1.6}, {"poisson", 0.45}}},
                              fem::Dilatation::Pointwise);
  settings.materials[1].law = {"saint-venant-kirchhoff", {{"young", 30e3}, {"poisson", 0.4}}};
  compare("two regions", block(4), settings, 1e-4);
}

/// At nu = 0.49 pure displacement elements lock in both programs; element-constant pressures do
/// not.
TEST(Calculix, SharesTheLockingOfPureDisplacementsAndThePressureElementDoesNot) {
  const Body body = block(6);
  const auto pointwise = settings_of({10e3, 0.49}, fem::Dilatation::Pointwise);
  compare("neo-hookean, nu = 0.49, pure displacement elements in both", body, pointwise, 0.005);
  const auto force = [&](fem::Dilatation dilatation) {
    const auto settings = settings_of({10e3, 0.49}, dilatation);
    return -fem::press_patch(body, settings, test::site_nearest(body), kPatchRadius)
                .samples.back()
                .force[2];
  };
  const double displacement = force(fem::Dilatation::Pointwise);
  const double pressure = force(fem::Dilatation::Mean);
  EXPECT_LT(pressure, 0.98 * displacement);
}

constexpr auto kToolProblem =
    "CalculiX with the tool: pressed 2 mm without friction, nu = 0.45, elements of 3 mm";
constexpr auto kDeck = "CalculiX, deck of palpate export, the same contact stiffness";

/// 30 x 30 x 15 mm, base fixed, finer towards the middle of its top.
Body graded_block() {
  return test::graded_block(0.015, 0.006, 0.003, 1.7);
}

fem::CampaignSettings pressing(const fem::ToolGeometry& tool) {
  // The volumetric energy of this law is the same in both programs: only the contact differs.
  auto settings = settings_of({"arruda-boyce", {{"mu", 3.5e3}, {"lambda_m", 2}, {"poisson", 0.45}}},
                              fem::Dilatation::Pointwise);
  settings.materials = {{"tissue", settings.materials.front().law}};
  settings.indentation.tool = tool;
  settings.indentation.depth = 0.002;
  settings.indentation.increments = 2;
  settings.indentation.lateral_travel = 0;
  return settings;
}

double own_force(const Body& body, const fem::CampaignSettings& settings) {
  const fem::CampaignContext context(body, settings, fem::Engine::SharedFactor);
  const SiteCurves curves = fem::solve_site(context, test::site_nearest(body), nullptr);
  EXPECT_EQ(curves.status, SiteStatus::Complete) << curves.reason;
  return -curves.paths.front().samples.back().force[2];
}

double their_force(const Deck& deck) {
  const auto forces = run_calculix(deck);
  EXPECT_EQ(forces.size(), static_cast<std::size_t>(deck.increments));
  return forces.empty() ? 0 : -forces.back()[2];
}

/// Both programs have a pressure of eps times the penetration with the same eps. palpate evaluates
/// it at twelve points of a facet, CalculiX at seven points of each piece into which the facets of
/// the tool cut it. They differ where a facet is touched in part or the pressure peaks within it.
void compare_tool(const std::string& what, const fem::ToolGeometry& tool, double bound) {
  const Body body = graded_block();
  const auto settings = pressing(tool);
  test::verify({kToolProblem, what, "N", own_force(body, settings),
                their_force(make_tool_deck(body, settings, test::site_nearest(body))),
                test::Reference::OtherSolver, kDeck, bound});
}

/// The pressure peaks over the edge, which is a third of an element here.
TEST(CalculixTool, AgreesOnADisc) {
  compare_tool("disc of 5 mm, edge of 1 mm", {fem::ToolShape::Disc, 0.005, 0.001, 0}, 0.025);
}

TEST(CalculixTool, AgreesOnALyingCylinder) {
  compare_tool("cylinder of 3 mm, 8 mm long", {fem::ToolShape::Cylinder, 0.003, 0, 0.008}, 0.01);
}

/// The elements that `solver.refine_under_tool` makes, which CalculiX gets as they are. It has no
/// element with a pressure of its own: the default element of a campaign is compared with its
/// displacement element, which is stiffer on the same mesh.
TEST(CalculixTool, AgreesOnRefinedElementsAndWithTheDefaultOne) {
  const Body body = graded_block();
  auto settings = pressing({fem::ToolShape::Sphere, 0.005, 0, 0});
  settings.indentation.refine_under_tool = 1;
  const double force = their_force(make_tool_deck(body, settings, test::site_nearest(body)));
  test::verify({kToolProblem, "sphere of 5 mm, elements under it divided once", "N",
                own_force(body, settings), force, test::Reference::OtherSolver, kDeck, 0.01});
  settings.dilatation = fem::Dilatation::Mean;
  test::verify({kToolProblem,
                "sphere of 5 mm, elements under it divided once, tet10-pressure here and "
                "tet10-displacement in CalculiX",
                "N", own_force(body, settings), force, test::Reference::OtherSolver, kDeck, 0.03});
}

/// The penetration lowers the force in proportion to one over the contact stiffness: a tenth of the
/// stiffness changes it by nine times the error that is left at the full stiffness.
TEST(CalculixTool, AgreesOnASphereWhateverTheContactStiffness) {
  const Body body = graded_block();
  const auto settings = pressing({fem::ToolShape::Sphere, 0.005, 0, 0});
  Deck deck = make_tool_deck(body, settings, test::site_nearest(body));
  const double force = their_force(deck);
  test::verify({kToolProblem, "sphere of 5 mm", "N", own_force(body, settings), force,
                test::Reference::OtherSolver, kDeck, 0.01});
  deck.tool->stiffness *= 0.1;
  test::verify({kToolProblem, "sphere of 5 mm, CalculiX with a tenth of the contact stiffness", "N",
                their_force(deck), force, test::Reference::SameSolver,
                "CalculiX with the full contact stiffness: CalculiX against itself", 0.01});
}

constexpr auto kCurvedProblem =
    "A ball of 30 mm with curved facets of 4 mm, pressed by a sphere of 5 mm, nu = 0.45";

/// Force at the pole after each increment of 0.5 mm, with elements divided so often, N.
std::vector<double> forces_at_pole(const Body& body, fem::CampaignSettings settings, int levels) {
  settings.indentation.refine_under_tool = levels;
  const fem::CampaignContext context(body, settings, fem::Engine::SharedFactor);
  const SiteCurves curves = fem::solve_site(context, 0, nullptr);
  EXPECT_EQ(curves.status, SiteStatus::Complete) << curves.reason;
  std::vector<double> forces;
  for (const CurveSample& sample : curves.paths.front().samples) forces.push_back(-sample.force[2]);
  return forces;
}

/// On one mesh the programs agree once the contact is as wide as a facet. Where they do not, at 0.5
/// mm, refinement decides against both: coarse facets err by more than the programs differ.
TEST(CalculixTool, AgreesOnCurvedFacetsAndBothErrThereUntilTheyAreDivided) {
  const Body body = test::curved_cap(0.004);
  auto settings = pressing({fem::ToolShape::Sphere, 0.005, 0, 0});
  settings.indentation.depth = 0.0015;
  settings.indentation.increments = 3;
  const auto theirs = run_calculix(make_tool_deck(body, settings, 0));
  ASSERT_EQ(theirs.size(), 3U);
  const auto coarse = forces_at_pole(body, settings, 0), twice = forces_at_pole(body, settings, 2),
             finest = forces_at_pole(test::curved_cap(0.003), settings, 3);
  constexpr auto kFinest = "palpate, facets of 3 mm, divided three times";
  constexpr std::array<const char*, 4> kDeep{"", "0.5 mm deep, ", "1.0 mm deep, ", "1.5 mm deep, "};
  for (const std::size_t i : {2U, 3U})
    test::verify({kCurvedProblem, std::string(kDeep[i]) + "one mesh", "N", coarse[i],
                  -theirs[i - 1][2], test::Reference::OtherSolver, kDeck, 0.015});
  for (const std::size_t i : {1U, 2U, 3U}) {
    const std::string depth = kDeep[i];
    test::verify({kCurvedProblem, depth + "CalculiX, not divided", "N", -theirs[i - 1][2],
                  finest[i], test::Reference::OtherSolver, kFinest, 0.4});
    test::verify({kCurvedProblem, depth + "palpate, not divided", "N", coarse[i], finest[i],
                  test::Reference::SameSolver, kFinest, 0.25});
    test::verify({kCurvedProblem, depth + "palpate, divided twice", "N", twice[i], finest[i],
                  test::Reference::SameSolver, kFinest, 0.01});
  }
}

}  // namespace
}  // namespace palpate::app
