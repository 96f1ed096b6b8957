// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/material.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/app/case/good_case.hpp"

namespace palpate::app {
namespace {

/// The good case with the material of its first region replaced.
std::string with_material(const std::string& keys) {
  return replaced(kGood, "young = \"10 kPa\"\npoisson = 0.49\n", keys);
}

TEST(MaterialSection, ReadsEveryLawByItsConstants) {
  const Case c = parse_case(
      with_material("law = \"ogden-2\"\nmu_1 = \"2 kPa\"\nalpha_1 = 1.3\nmu_2 = \"-100 Pa\"\n"
                    "alpha_2 = -6\npoisson = 0.48\n"),
      "ball.toml");
  const fem::LawConstants law = c.materials[0].law;
  EXPECT_EQ(law.law, "ogden-2");
  EXPECT_DOUBLE_EQ(law.at("mu_2"), -100);
  EXPECT_DOUBLE_EQ(law.at("alpha_2"), -6);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c) << resolved_toml(c);
  EXPECT_EQ(c.materials[1].law.law, "neo-hookean");
}

TEST(MaterialSection, ReadsFibreFields) {
  const std::string hgo =
      "law = \"holzapfel-gasser-ogden\"\nc = \"3 kPa\"\nk1 = \"2.4 kPa\"\nk2 = 0.84\nkappa = 0\n"
      "poisson = 0.49\nfibre_families = 2\nfibre_angle = \"29 deg\"\n";
  const Case c =
      parse_case(with_material(hgo + "fibre_field = \"cylindrical\"\nfibre_axis = [0, 0, 1]\n"
                                     "fibre_axis_point = [\"5 mm\", \"0 mm\", \"0 mm\"]\n"),
                 "ball.toml");
  const fem::FibreField fibres = c.materials[0].law.fibres;
  EXPECT_EQ(fibres.kind, fem::FibreField::Kind::Cylindrical);
  EXPECT_DOUBLE_EQ(fibres.origin[0], 0.005);
  EXPECT_EQ(fibres.families, 2);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c) << resolved_toml(c);
  EXPECT_THAT(message_of(with_material(hgo)), HasSubstr("material[0].fibre_direction"));
  EXPECT_THAT(message_of(with_material(hgo + "fibre_direction = [1, 0, 0]\n"
                                             "fibre_plane = [2, 0, 0]\n")),
              HasSubstr("parallel"));
}

TEST(MaterialSection, ReadsFibreFieldsThatDependOnTheBody) {
  const std::string hgo =
      "law = \"holzapfel-gasser-ogden\"\nc = \"3 kPa\"\nk1 = \"2.4 kPa\"\nk2 = 0.84\nkappa = 0\n"
      "poisson = 0.49\nfibre_plane = [0, 0, 1]\n";
  const std::string box =
      "fibre_field = \"laplace\"\nfibre_from_low = [\"0 mm\", \"0 mm\", \"0 mm\"]\n"
      "fibre_from_high = [\"1 mm\", \"1 mm\", \"1 mm\"]\nfibre_to_low = [\"3 mm\", \"0 mm\", \"0 "
      "mm\"]\n";
  const std::string end = "fibre_to_high = [\"4 mm\", \"1 mm\", \"1 mm\"]\n";
  const Case between = parse_case(with_material(hgo + box + end), "ball.toml");
  const fem::FibreField fibres = between.materials[0].law.fibres;
  EXPECT_EQ(fibres.kind, fem::FibreField::Kind::Laplace);
  EXPECT_DOUBLE_EQ(fibres.to.low[0], 0.003);
  EXPECT_DOUBLE_EQ(fibres.from.high[1], 0.001);
  EXPECT_EQ(parse_case(resolved_toml(between), "resolved"), between) << resolved_toml(between);
  EXPECT_THAT(message_of(with_material(hgo + box)), HasSubstr("material[0].fibre_to_high"));

  const Case of_file = parse_case(
      with_material(hgo + "fibre_field = \"file\"\nfibre_file = \"f.csv\"\nfibre_unit = \"mm\"\n"),
      "ball.toml");
  EXPECT_EQ(of_file.materials[0].law.fibres.kind, fem::FibreField::Kind::Sampled);
  EXPECT_TRUE(reads_fibre_file(of_file.materials[0]));
  EXPECT_THROW(campaign_material(of_file.materials[0], "/nonexistent"), Error);
  EXPECT_EQ(parse_case(resolved_toml(of_file), "resolved"), of_file) << resolved_toml(of_file);
}

TEST(MaterialSection, RejectsConstantsThatTheLawLacksOrThatAreInconsistent) {
  const std::string mooney = "law = \"mooney-rivlin\"\nC10 = \"1 kPa\"\npoisson = 0.49\n";
  EXPECT_THAT(message_of(with_material(mooney)), HasSubstr("material[0].C01"));
  EXPECT_THAT(message_of(with_material(mooney + "C01 = \"-2 kPa\"\n")),
              HasSubstr("C10 + C01 = -1000"));
  EXPECT_THAT(message_of(with_material(mooney + "C01 = \"1 kPa\"\nyoung = \"1 kPa\"\n")),
              HasSubstr("unknown key 'young'"));
  EXPECT_THAT(message_of(with_material("law = \"demiray-fung\"\nmu = \"1 kPa\"\nb = -1\n"
                                       "poisson = 0.49\n")),
              HasSubstr("material[0].b = -1"));
  EXPECT_THAT(message_of(with_material("law = \"mooney\"\n")),
              HasSubstr("is 'mooney', which is not one of neo-hookean, mooney-rivlin"));
}

constexpr const char* kSeries =
    "relaxation = [{ fraction = 0.3, time = \"0.1 s\" }, { fraction = 0.2, time = \"2 s\" }]\n";
constexpr const char* kElastic = "young = \"10 kPa\"\npoisson = 0.45\n";

TEST(MaterialSection, RelaxationReachesTheCampaignWithTheInstantaneousModuli) {
  const std::string keys = std::string(kElastic) + kSeries;
  const RelaxationSeries series{{0.3, 0.1}, {0.2, 2}};
  const Case at_once =
      parse_case(with_material(keys + "moduli = \"instantaneous\"\n"), "ball.toml");
  const fem::RegionMaterial same = campaign_material(at_once.materials[0], ".");
  EXPECT_EQ(same.relaxation, series);
  EXPECT_EQ(same.law.at("young"), 10e3);
  EXPECT_EQ(parse_case(resolved_toml(at_once), "resolved"), at_once) << resolved_toml(at_once);

  const Case relaxed = parse_case(with_material(keys + "moduli = \"long-term\"\n"), "ball.toml");
  EXPECT_EQ(relaxed.materials[0].law.at("young"), 10e3);
  EXPECT_NE(relaxed, at_once);
  EXPECT_EQ(parse_case(resolved_toml(relaxed), "resolved"), relaxed) << resolved_toml(relaxed);
  const fem::RegionMaterial twice = campaign_material(relaxed.materials[0], ".");
  const fem::RestModuli rest = fem::rest_moduli(twice.law);
  EXPECT_NEAR(rest.mu(), 2 * 10e3 / 2.9, 1e-9 * rest.mu());
  EXPECT_NEAR(rest.kappa(), 10e3 / 0.3, 1e-9 * rest.kappa());
}

TEST(MaterialSection, RefusesRelaxationThatIsIncompleteOrInconsistent) {
  const std::string series = kSeries, keys = kElastic + series;
  EXPECT_THAT(message_of(with_material(keys)), HasSubstr("key 'material[0].moduli' is missing"));
  EXPECT_THAT(message_of(with_material(keys + "moduli = \"initial\"\n")),
              HasSubstr("not one of instantaneous, long-term"));
  EXPECT_THAT(message_of(with_material(std::string(kElastic) + "moduli = \"long-term\"\n")),
              HasSubstr("moduli without relaxation"));
  const auto message = [](const std::string& list) {
    return message_of(with_material(kElastic + ("moduli = \"long-term\"\nrelaxation = " + list)));
  };
  EXPECT_THAT(message("[]\n"), HasSubstr("a list with at least one table"));
  EXPECT_THAT(message("[0.3]\n"), HasSubstr("a list with at least one table"));
  EXPECT_THAT(message("[{ fraction = 0.3 }]\n"),
              HasSubstr("key 'material[0].relaxation[0].time' is missing"));
  EXPECT_THAT(message("[{ fraction = 0.3, time = 1 }]\n"), HasSubstr("a time with its unit"));
  EXPECT_THAT(message("[{ fraction = 1, time = \"1 s\" }]\n"),
              HasSubstr("material[0].relaxation[0].fraction = 1 is out of range"));
  EXPECT_THAT(
      message("[{ fraction = 0.5, time = \"1 s\" }, { fraction = 0.1, time = \"1 ms\" }]\n"),
      HasSubstr("not above the time before it"));
  EXPECT_THAT(message("[{ fraction = 0.99, time = \"1 s\" }]\n"), HasSubstr("Poisson's ratio -"));
  const std::string unsplit = "law = \"saint-venant-kirchhoff\"\nmoduli = \"long-term\"\n";
  EXPECT_THAT(message_of(with_material(unsplit + keys)), HasSubstr("no isochoric part"));
  const std::string weight =
      "[gravity]\nacceleration = [\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]\n";
  EXPECT_THAT(message_of(with_material(keys + "moduli = \"long-term\"\n") + weight),
              HasSubstr("relaxation of a body under its weight"));
}

}  // namespace
}  // namespace palpate::app
