// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/export/deck.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "fem/campaign/bonded_patch.hpp"
#include "fem/campaign/first_touch.hpp"
#include "fem/mesh/tangent_frame.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"

namespace palpate::app {

namespace {

using Corners = std::array<std::int32_t, 3>;

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

std::vector<ElementSide> sides_of(const fem::QuadraticMesh& mesh,
                                  const std::vector<fem::Facet>& facets) {
  std::map<Corners, ElementSide> wanted;
  for (const fem::Facet& f : facets) wanted[sorted({f[0], f[1], f[2]})] = {-1, -1};
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    const fem::Tetrahedron10& nodes = mesh.tetrahedra[e];
    for (std::size_t side = 0; side < kTetSides.size(); ++side) {
      const auto [a, b, c] = kTetSides[side];
      const auto found = wanted.find(sorted({nodes[a], nodes[b], nodes[c]}));
      if (found != wanted.end())
        found->second = {static_cast<std::int32_t>(e), static_cast<std::int32_t>(side)};
    }
  }
  std::vector<ElementSide> sides;
  for (const auto& [corners, side] : wanted) sides.push_back(side);
  return sides;
}

/// All but what presses.
Deck body_deck(const Body& body, const fem::CampaignSettings& settings, std::int32_t vertex) {
  if (settings.gravity.acts() || !body.foundation.empty()) {
    throw Error(ErrorKind::Configuration, body.name,
                "decks for other programs have neither gravity nor springs",
                "export a case without [gravity] and without supports that have a stiffness");
  }
  if (fem::is_linear(settings.dilatation)) {
    throw Error(ErrorKind::Configuration, "solver.element",
                "other programs have no tetrahedron of four nodes with pressures around its nodes",
                "export with element = \"tet10-displacement\", which they have");
  }
  Deck deck;
  deck.region_names = body.region_names;
  for (const std::string& region : body.region_names) {
    const auto found =
        std::find_if(settings.materials.begin(), settings.materials.end(),
                     [&](const fem::RegionMaterial& m) { return m.region == region; });
    if (found == settings.materials.end()) {
      throw Error(ErrorKind::Configuration, "region '" + region + "'", "it has no material",
                  "describe every region of the body in the case");
    }
    const std::string where = "material of region '" + region + "'";
    fem::check_law(found->law, where);
    deck.laws.push_back(found->law);
    deck.relaxation.push_back(found->relaxation);
  }
  deck.direction = body.response.inward[to_index(vertex)];
  deck.depth = settings.indentation.depth;
  deck.increments = settings.indentation.increments;
  return deck;
}

void check_pressing(const Body& body, const fem::IndentationSettings& press, std::int32_t vertex) {
  const auto count = static_cast<std::int32_t>(body.response.node.size());
  if (vertex < 0 || vertex >= count || body.response.is_site[to_index(vertex)] == 0)
    throw Error(ErrorKind::Configuration, body.name,
                fmt::format("response vertex {} is not a site", vertex),
                fmt::format("choose a vertex outside the supports, from 0 to {}", count - 1));
  fem::check_tool(press.tool);
  if ((fem::Tool{press.tool}).has_sharp_edge())
    throw Error(ErrorKind::Configuration, "tool",
                "sharp edges are treated differently by other programs",
                "export a patch (--patch), or a tool with a rounded edge");
}

LateralMove first_lateral_move(const fem::IndentationSettings& press, const Vec3& inward) {
  if (press.azimuths.empty())
    throw Error(ErrorKind::Configuration, "indentation.azimuths", "there is no lateral path",
                "name a direction, or export the press alone");
  const auto [first, second] = fem::tangent_frame(fem::to_eigen(inward));
  const double azimuth = press.azimuths.front();
  return {fem::to_vec3(std::cos(azimuth) * first + std::sin(azimuth) * second),
          press.lateral_travel, press.lateral_increments};
}

}  // namespace

bool Deck::relaxes() const {
  return std::any_of(relaxation.begin(), relaxation.end(),
                     [](const RelaxationSeries& series) { return !series.empty(); });
}

fem::Facet facet_of(const fem::Tetrahedron10& element, std::int32_t side) {
  // kTetSides go around as seen from within.
  const auto [c, b, a] = kTetSides[to_index(side)];
  const auto middle = [&](std::size_t i, std::size_t j) { return element[fem::middle_node(i, j)]; };
  return {element[a], element[b], element[c], middle(a, b), middle(b, c), middle(c, a)};
}

Deck make_patch_deck(const Body& body, const fem::CampaignSettings& settings, std::int32_t vertex,
                     double radius) {
  if (settings.indentation.refine_under_tool != 0) {
    throw Error(ErrorKind::Configuration, body.name,
                "a bonded patch has the mesh of the body, without refinement under a tool",
                "export the tool (without --patch), or a case without solver.refine_under_tool");
  }
  fem::BondedPatch patch = fem::bonded_patch(body, vertex, radius);
  Deck deck = body_deck(body, settings, vertex);
  if (deck.relaxes())
    refuse(body.name, "a bonded patch is displaced at no speed, and tissue of the case relaxes",
           "export the tool (without --patch), or a case without relaxation");
  deck.title = fmt::format("{}: site {}, surface nodes within {:.6g} m moved inward by {:.6g} m",
                           body.name, vertex, radius, deck.depth);
  deck.mesh = std::move(patch.mesh);
  deck.patch = std::move(patch.nodes);
  return deck;
}

Deck make_tool_deck(const Body& body, const fem::CampaignSettings& settings, std::int32_t vertex,
                    bool lateral) {
  check_pressing(body, settings.indentation, vertex);
  Deck deck = body_deck(body, settings, vertex);
  const fem::ToolGeometry& tool = settings.indentation.tool;
  deck.title = fmt::format("{}: site {}, {} of radius {:.6g} m pressed in by {:.6g} m", body.name,
                           vertex, name_of(tool.shape), tool.radius, deck.depth);
  // Refined elements belong to a window, which the direct engine has not.
  const bool refined = settings.indentation.refine_under_tool != 0;
  const fem::CampaignContext context(body, settings,
                                     refined ? fem::Engine::SharedFactor : fem::Engine::Direct);
  const fem::FirstTouch touch = fem::first_touch(context, vertex);
  deck.mesh = touch.mesh;
  deck.tool = PressingTool{fem::make_tool_mesh(touch.tool, 2 * deck.depth + tool.radius),
                           sides_of(deck.mesh, touch.facets), context.contact_stiffness.contact};
  deck.no_slip = settings.indentation.friction == fem::ToolFriction::NoSlip;
  if (lateral) deck.lateral = first_lateral_move(settings.indentation, deck.direction);
  return deck;
}

}  // namespace palpate::app
