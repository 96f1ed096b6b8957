// SPDX-License-Identifier: AGPL-3.0-or-later
// A block and its decks, for the tests of the input files of other programs.
#pragma once

#include <string>

#include "app/export/deck.hpp"
#include "format/error.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::app {

inline Body block() {
  Body body =
      test::make_block(test::even(0, 0.02, 4), test::even(0, 0.02, 4), test::even(0, 0.01, 2));
  body.name = "a <b> -- \"c\" & d";
  return body;
}

inline Deck deck_of(const fem::LawConstants& law) {
  const Body body = block();
  fem::CampaignSettings settings;
  settings.materials = {{"tissue", law}};
  settings.indentation.depth = 0.002;
  return make_patch_deck(body, settings, test::site_nearest(body, 0.01, 0.01), 0.0052);
}

inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

inline fem::CampaignSettings pressed_by(const fem::ToolGeometry& tool) {
  fem::CampaignSettings settings;
  settings.materials = {{"tissue", {10e3, 0.45}}};
  settings.indentation.tool = tool;
  settings.indentation.depth = 0.002;
  return settings;
}

inline const fem::ToolGeometry kTools[] = {{fem::ToolShape::Sphere, 0.004, 0, 0},
                                           {fem::ToolShape::Disc, 0.004, 0.001, 0},
                                           {fem::ToolShape::Disc, 0.004, 0.004, 0},
                                           {fem::ToolShape::Cylinder, 0.003, 0, 0.004}};

/// The deck of a site under the sphere.
inline Deck sphere_deck() {
  const Body body = block();
  return make_tool_deck(body, pressed_by(kTools[0]), test::site_nearest(body, 0.01, 0.01));
}

/// The same where the tissue relaxes.
inline Deck relaxing_deck(const RelaxationSeries& series) {
  const Body body = block();
  fem::CampaignSettings settings = pressed_by(kTools[0]);
  settings.materials.front().relaxation = series;
  return make_tool_deck(body, settings, test::site_nearest(body, 0.01, 0.01));
}

/// Nodes and elements of body and tool.
inline std::size_t nodes_of(const Deck& deck) {
  return static_cast<std::size_t>(deck.mesh.X.cols() + deck.tool->mesh.X.cols());
}
inline std::size_t elements_of(const Deck& deck) {
  return deck.mesh.tetrahedra.size() + deck.tool->mesh.tetrahedra.size();
}

/// What is said of a law that a deck cannot have; "written" where it can.
template <class Write>
std::string refusal_of(Write write, const fem::LawConstants& law) {
  try {
    write(deck_of(law));
  } catch (const Error& error) {
    return error.what();
  }
  return "written";
}

}  // namespace palpate::app
