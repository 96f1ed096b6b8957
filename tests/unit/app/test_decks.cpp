// SPDX-License-Identifier: AGPL-3.0-or-later
// Input files of other programs, by their structure: tags that close, counts, numbers that refer to
// what exists. That CalculiX computes the same is shown by the verification tests.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "app/export/deck.hpp"
#include "format/error.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/sample_laws.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

Body block() {
  Body body =
      test::make_block(test::even(0, 0.02, 4), test::even(0, 0.02, 4), test::even(0, 0.01, 2));
  body.name = "a <b> -- \"c\" & d";
  return body;
}

std::int32_t middle(const Body& body) {
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    const Vec3& x = body.nodes[static_cast<std::size_t>(body.response.node[v])];
    if (std::abs(x[0] - 0.01) + std::abs(x[1] - 0.01) < 1e-9) return static_cast<std::int32_t>(v);
  }
  return -1;
}

Deck deck_of(const fem::LawConstants& law) {
  const Body body = block();
  fem::CampaignSettings settings;
  settings.materials = {{"tissue", law}};
  settings.indentation.depth = 0.002;
  return make_deck(body, settings, middle(body), 0.0052);
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// Every tag closed in its order; the first fault in words, empty when there is none.
std::string xml_fault(const std::string& text) {
  static const std::regex tag(R"(<(/?)([A-Za-z_0-9]+)((?: [a-z_A-Z0-9]+="[^"<>]*")*)(/?)>)");
  std::vector<std::string> open;
  std::size_t marks = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), tag), end; it != end; ++it) {
    ++marks;
    const std::string name = (*it)[2];
    if ((*it)[1] == "/") {
      if (open.empty() || open.back() != name) return "unexpected </" + name + ">";
      open.pop_back();
    } else if ((*it)[4] != "/") {
      open.push_back(name);
    }
  }
  if (!open.empty()) return "<" + open.back() + "> is not closed";
  // The declaration and the comment are the only marks that are no tags.
  return marks + 2 == count(text, "<") ? "" : "a mark that is no tag";
}

TEST(Decks, MoveTheSurfaceNodesUnderThePatch) {
  const Deck deck = deck_of({10e3, 0.45});
  // Of a grid of 5 mm, the vertex and its four neighbours, and the edges between them: four along
  // the grid, two or so across a cell are longer than the patch but join nodes of it.
  std::set<std::int32_t> corners;
  const auto grid = static_cast<std::int32_t>(block().nodes.size());
  for (const std::int32_t node : deck.patch.nodes) {
    EXPECT_NEAR(deck.patch.mesh.X(2, node), 0.01, 1e-12);
    if (node < grid) corners.insert(node);
  }
  EXPECT_EQ(corners.size(), 5u);
  EXPECT_GE(deck.patch.nodes.size(), 9u);
}

TEST(Decks, RefuseAPatchOnASupportOrWithoutSize) {
  const Body body = block();
  fem::CampaignSettings settings;
  settings.materials = {{"tissue", {10e3, 0.45}}};
  EXPECT_THROW(make_deck(body, settings, middle(body), 0.02), Error);
  EXPECT_THROW(make_deck(body, settings, middle(body), 0), Error);
  EXPECT_THROW(make_deck(body, settings, 100000, 0.005), Error);
  settings.materials[0].law.at("poisson") = 0.5;
  EXPECT_THROW(make_deck(body, settings, middle(body), 0.005), Error);
}

TEST(Decks, CalculixHoldsEveryNodeAndElementOnce) {
  const Deck deck = deck_of({10e3, 0.45});
  const std::string text = calculix_deck(deck);
  const std::string nodes =
      text.substr(text.find("*NODE,"), text.find("** region") - text.find("*NODE,"));
  EXPECT_EQ(count(nodes, "\n") - 1, static_cast<std::size_t>(deck.patch.mesh.X.cols()));
  const std::size_t first = text.find("*ELEMENT"), last = text.find("*MATERIAL");
  EXPECT_EQ(count(text.substr(first, last - first), "\n") - 1, deck.patch.mesh.tetrahedra.size());
  EXPECT_THAT(text, HasSubstr("PATCH,3,3,-2.000000000000e-03"));
}

TEST(Decks, FebioIsWellFormedAndCountsRight) {
  for (const fem::LawConstants& law : test::sample_laws(0.45)) {
    if (law.law == "mooney-rivlin-5" || law.law == "demiray-fung" || law.law == "arruda-boyce") {
      EXPECT_THROW(febio_deck(deck_of(law)), Error);
      continue;
    }
    const Deck deck = deck_of(law);
    const std::string text = febio_deck(deck);
    EXPECT_EQ(xml_fault(text), "") << law.law;
    EXPECT_EQ(count(text, "<node id="), static_cast<std::size_t>(deck.patch.mesh.X.cols()));
    EXPECT_EQ(count(text, "<elem id="), deck.patch.mesh.tetrahedra.size());
    EXPECT_EQ(count(text, "<material id="), 1u);
    const std::size_t set = text.find("<NodeSet name=\"patch\">");
    const std::size_t end = text.find("</NodeSet>", set);
    EXPECT_EQ(count(text.substr(set, end - set), ",") + 1, deck.patch.nodes.size());
  }
}

TEST(Decks, NameTheLawThatTheOtherProgramLacks) {
  const auto message = [](auto write, const fem::LawConstants& law) -> std::string {
    try {
      write(deck_of(law));
    } catch (const Error& error) {
      return error.what();
    }
    return "written";
  };
  const fem::LawConstants fung("demiray-fung", {{"mu", 1e3}, {"b", 1}, {"poisson", 0.45}});
  EXPECT_THAT(message(calculix_deck, fung), HasSubstr("CalculiX has no law like demiray-fung"));
  EXPECT_THAT(message(calculix_deck, fung), HasSubstr("region 'tissue'"));
  EXPECT_THAT(message(febio_deck, fung), HasSubstr("FEBio has no law like demiray-fung"));
}

}  // namespace
}  // namespace palpate::app
