// SPDX-License-Identifier: AGPL-3.0-or-later
// The structure of the input file; that CalculiX computes the same is in tests/verification.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/app/export/decks.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

TEST(CalculixDeck, HoldsEveryNodeAndElementOnce) {
  const Deck deck = deck_of({10e3, 0.45});
  const std::string text = calculix_deck(deck);
  const std::string nodes =
      text.substr(text.find("*NODE,"), text.find("** region") - text.find("*NODE,"));
  EXPECT_EQ(count(nodes, "\n") - 1, static_cast<std::size_t>(deck.mesh.X.cols()));
  const std::size_t first = text.find("*ELEMENT"), last = text.find("*MATERIAL");
  EXPECT_EQ(count(text.substr(first, last - first), "\n") - 1, deck.mesh.tetrahedra.size());
  EXPECT_THAT(text, HasSubstr("PATCH,3,3,-2.000000000000e-03"));
}

TEST(CalculixDeck, OfAToolMovesItsNodes) {
  const Deck deck = sphere_deck();
  const std::string text = calculix_deck(deck);
  EXPECT_EQ(count(text, "*NODE, NSET=TOOL"), 1u);
  EXPECT_THAT(text, HasSubstr("TOOL,3,3,-2.000000000000e-03"));
  EXPECT_THAT(text, HasSubstr(std::to_string(elements_of(deck)) + ","));
}

/// The press first, then the motion along the tangent at its depth; the surface sticks in the steps
/// in which it does here.
TEST(CalculixDeck, MovesTheToolSidewaysWithoutSlip) {
  Deck deck = sphere_deck();
  EXPECT_EQ(count(calculix_deck(deck), "*FRICTION"), 0u);
  deck.lateral = LateralMove{{0, 1, 0}, 0.001, 4};
  std::string text = calculix_deck(deck);
  EXPECT_EQ(count(text, "*STEP"), 2u);
  const std::string aside = text.substr(text.find("*END STEP"));
  EXPECT_EQ(count(aside, "*CHANGE FRICTION, INTERACTION=CONTACT\n*FRICTION"), 1u);
  EXPECT_THAT(aside, HasSubstr("*STATIC\n0.25,1.,"));
  EXPECT_THAT(aside, HasSubstr("TOOL,2,2,1.000000000000e-03"));
  EXPECT_THAT(aside, HasSubstr("TOOL,3,3,-2.000000000000e-03"));
  EXPECT_THROW(febio_deck(deck), Error);
  deck.no_slip = true;
  text = calculix_deck(deck);
  EXPECT_LT(text.find("*FRICTION"), text.find("*CONTACT PAIR"));
  EXPECT_EQ(count(text, "*CHANGE FRICTION"), 0u);
  deck.lateral.reset();
  EXPECT_THROW(febio_deck(deck), Error);
}

TEST(CalculixDeck, NamesTheLawThatTheProgramLacks) {
  const fem::LawConstants fung("demiray-fung", {{"mu", 1e3}, {"b", 1}, {"poisson", 0.45}});
  EXPECT_THAT(refusal_of(calculix_deck, fung), HasSubstr("CalculiX has no law like demiray-fung"));
  EXPECT_THAT(refusal_of(calculix_deck, fung), HasSubstr("region 'tissue'"));
  const fem::LawConstants gent("gent", {{"mu", 1e3}, {"J_m", 12}, {"poisson", 0.45}});
  EXPECT_THAT(refusal_of(calculix_deck, gent), HasSubstr("CalculiX has no law like gent"));
}

}  // namespace
}  // namespace palpate::app
