// SPDX-License-Identifier: AGPL-3.0-or-later
// The structure of the input file: tags that close, counts, numbers that refer to what exists.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <regex>
#include <string>
#include <utility>

#include "format/numbers.hpp"
#include "tests/support/sample_laws.hpp"
#include "tests/unit/app/export/decks.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

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

TEST(FebioDeck, IsWellFormedAndCountsRight) {
  for (const fem::LawConstants& law : test::sample_laws(0.45)) {
    if (law.law == "mooney-rivlin-5" || law.law == "demiray-fung" || law.law == "arruda-boyce") {
      EXPECT_THROW(febio_deck(deck_of(law)), Error);
      continue;
    }
    const Deck deck = deck_of(law);
    const std::string text = febio_deck(deck);
    EXPECT_EQ(xml_fault(text), "") << law.law;
    EXPECT_EQ(count(text, "<node id="), static_cast<std::size_t>(deck.mesh.X.cols()));
    EXPECT_EQ(count(text, "<elem id="), deck.mesh.tetrahedra.size());
    EXPECT_EQ(count(text, "<material id="), 1u);
    const std::size_t set = text.find("<NodeSet name=\"patch\">");
    const std::size_t end = text.find("</NodeSet>", set);
    EXPECT_EQ(count(text.substr(set, end - set), ",") + 1, deck.patch.size());
  }
}

TEST(FebioDeck, OfAToolIsWellFormedAndCountsRight) {
  const Deck deck = sphere_deck();
  const std::string text = febio_deck(deck);
  EXPECT_EQ(xml_fault(text), "");
  EXPECT_EQ(count(text, "<node id="), nodes_of(deck));
  EXPECT_EQ(count(text, "<elem id="), elements_of(deck));
  EXPECT_EQ(count(text, "<tri6 id="), deck.tool->skin.size() + deck.tool->mesh.tetrahedra.size());
  EXPECT_EQ(count(text, "prescribed displacement"), 0u);
  EXPECT_THAT(text, HasSubstr("<value lc=\"1\">-2.000000000000e-03</value>"));
}

/// What FEBio 4.11 needs to run the deck as it is written: a small first step, retries, full
/// Newton, and a tenth of the penalty of palpate.
TEST(FebioDeck, OfAToolStepsFromAFiftiethOfThePathAndMeetsEveryIncrement) {
  const Deck deck = sphere_deck();
  const std::string text = febio_deck(deck);
  EXPECT_THAT(text, HasSubstr("<time_steps>50</time_steps>\n<step_size>0.02</step_size>"));
  EXPECT_THAT(text, HasSubstr("<max_ups>0</max_ups>"));
  EXPECT_THAT(text, HasSubstr("<dtmax lc=\"2\">1</dtmax>"));
  const std::string curve = text.substr(text.find("name=\"increments\""));
  EXPECT_EQ(count(curve, "<pt>"), static_cast<std::size_t>(deck.increments) + 1);
  const std::size_t value = text.find("<penalty>") + 9;
  EXPECT_DOUBLE_EQ(std::stod(text.substr(value)), 0.1 * deck.tool->stiffness);
}

/// The time of the first and the last point of a load curve.
std::pair<double, double> times_of(const std::string& text, const char* curve) {
  static const std::regex point("<pt>([^,]+),");
  const auto at = [&](std::size_t i) { return text.begin() + static_cast<std::ptrdiff_t>(i); };
  const std::size_t begin = text.find(curve), end = text.find("</load_controller>", begin);
  std::pair<double, double> times{kInfinity, 0};
  for (std::sregex_iterator it(at(begin), at(end), point), last; it != last; ++it) {
    const double time = std::stod((*it)[1]);
    times = {std::min(times.first, time), std::max(times.second, time)};
  }
  return times;
}

TEST(FebioDeck, OfTissueThatRelaxesTakesTheTimeOfPressAndHold) {
  Deck deck = relaxing_deck({{0.3, 0.05}, {0.2, 2}});
  deck.pace = PressAndHold{0.5, 3};
  const std::string text = febio_deck(deck);
  EXPECT_EQ(xml_fault(text), "");
  for (const char* curve : {"name=\"ramp\"", "name=\"increments\""})
    EXPECT_EQ(times_of(text, curve), std::pair(0.0, 3.5)) << curve;
  EXPECT_THAT(text, HasSubstr("<pt>0.5,1</pt><pt>3.5,1</pt>"));
  const double steps = std::stod(text.substr(text.find("<time_steps>") + 12)),
               step = std::stod(text.substr(text.find("<step_size>") + 11));
  EXPECT_NEAR(steps * step, 3.5, 1e-9);
  EXPECT_LE(step, 0.01);
  EXPECT_EQ(count(text, "uncoupled viscoelastic"), 1u);
  EXPECT_EQ(count(text, "<k>"), 1u);  // of the outer material: FEBio ignores that of the inner one
}

TEST(FebioDeck, OfTissueThatRelaxesNeedsATimeAndAtMostSixTerms) {
  const auto refusal = [](const auto& write) -> std::string {
    try {
      write();
    } catch (const Error& error) {
      return error.what();
    }
    return "written";
  };
  Deck deck = relaxing_deck({{0.3, 0.05}});
  EXPECT_THAT(refusal([&] { febio_deck(deck); }), HasSubstr("--press-seconds"));
  EXPECT_THAT(refusal([&] { calculix_deck(deck); }), HasSubstr("--febio"));
  RelaxationSeries many;
  for (int i = 1; i <= 7; ++i) many.push_back({0.1, 0.1 * i});
  deck = relaxing_deck(many);
  deck.pace = PressAndHold{};
  EXPECT_THAT(refusal([&] { febio_deck(deck); }), HasSubstr("at most 6 terms"));
  fem::CampaignSettings settings = pressed_by(kTools[0]);
  settings.materials.front().relaxation = {{0.3, 0.05}};
  EXPECT_THAT(refusal([&] {
                const Body body = block();
                make_patch_deck(body, settings, test::site_nearest(body, 0.01, 0.01), 0.0052);
              }),
              HasSubstr("without --patch"));
}

TEST(FebioDeck, NamesTheLawThatTheProgramLacks) {
  const fem::LawConstants fung("demiray-fung", {{"mu", 1e3}, {"b", 1}, {"poisson", 0.45}});
  EXPECT_THAT(refusal_of(febio_deck, fung), HasSubstr("FEBio has no law like demiray-fung"));
}

}  // namespace
}  // namespace palpate::app
