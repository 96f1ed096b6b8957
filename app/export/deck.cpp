// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/export/deck.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "format/error.hpp"

namespace palpate::app {

Deck make_deck(const Body& body, const fem::CampaignSettings& settings, std::int32_t vertex,
               double radius) {
  Deck deck;
  deck.patch = fem::stuck_patch(body, vertex, radius);
  deck.title = fmt::format("{}: site {}, surface nodes within {:.6g} m moved inward by {:.6g} m",
                           body.name, vertex, radius, settings.indentation.depth);
  deck.region_names = body.region_names;
  for (const std::string& region : body.region_names) {
    const auto found =
        std::find_if(settings.materials.begin(), settings.materials.end(),
                     [&](const fem::RegionMaterial& m) { return m.region == region; });
    if (found == settings.materials.end()) {
      throw Error(ErrorKind::Configuration, "region '" + region + "'", "it has no material",
                  "describe every region of the body in the case");
    }
    fem::check_law(found->law, "material of region '" + region + "'");
    deck.laws.push_back(found->law);
  }
  deck.direction = body.response.inward[static_cast<std::size_t>(vertex)];
  deck.depth = settings.indentation.depth;
  deck.increments = settings.indentation.increments;
  return deck;
}

}  // namespace palpate::app
