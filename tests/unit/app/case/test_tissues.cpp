// SPDX-License-Identifier: AGPL-3.0-or-later
// data/materials.toml: every entry is read as the material of a case, and its law has the uniaxial
// stress of the closed form with the constants as they are written. Series have the moduli over
// time that their sources state.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "app/case/case.hpp"
#include "app/case/material.hpp"
#include "app/case/quantity.hpp"
#include "fem/laws/law.hpp"
#include "format/numbers.hpp"
#include "format/relaxation.hpp"
#include "tests/support/source_folder.hpp"

namespace palpate::app {
namespace {

/// The tissue as the only material of a case.
std::string case_with(toml::table tissue) {
  for (const char* about : {"name", "source", "range", "note"}) tissue.erase(about);
  std::ostringstream keys;
  keys << tissue;
  std::string fibres;
  if (tissue.contains("fibre_families"))
    fibres =
        "\nfibre_field = \"cylindrical\"\nfibre_axis = [0, 0, 1]\n"
        "fibre_axis_point = [\"0 mm\", \"0 mm\", \"0 mm\"]";
  return "[surface]\nfile = \"a.off\"\nunit = \"mm\"\n[[support]]\nshape = \"sphere\"\n"
         "centre = [\"0 mm\", \"0 mm\", \"0 mm\"]\nradius = \"1 mm\"\n[[material]]\n" +
         keys.str() + fibres + "\n";
}

double written(const toml::table& tissue, const char* key) {
  if (const auto text = tissue[key].value_exact<std::string>())
    return parse_quantity(*text, Dimension::Pressure).value;
  return tissue[key].value<double>().value();
}

/// Nominal stress along l of the incompressible solid whose other stretches are l^-1/2; of fibres
/// at
/// +-29 degrees from it, the stress above that across their plane.
double closed_form(const toml::table& t, double l) {
  const std::string law = t["law"].value<std::string>().value();
  const double I1 = l * l + 2 / l, I2 = 2 * l + 1 / (l * l);
  const auto invariants = [&](double W1, double W2) {
    return 2 * (l - 1 / (l * l)) * (W1 + W2 / l);
  };
  if (law == "ogden-1") {
    const double mu = written(t, "mu_1"), a = written(t, "alpha_1");
    return 2 * mu / a * (std::pow(l, a - 1) - std::pow(l, -0.5 * a - 1));
  }
  if (law == "neo-hookean") {
    const double nu = written(t, "poisson");
    return invariants(written(t, "young") / (4 * (1 + nu)), 0);  // C10 = mu/2
  }
  if (law == "yeoh")
    return invariants(written(t, "C10") + 2 * written(t, "C20") * (I1 - 3) +
                          3 * written(t, "C30") * std::pow(I1 - 3, 2),
                      0);
  if (law == "mooney-rivlin-5")
    return invariants(
        written(t, "C10") + 2 * written(t, "C20") * (I1 - 3) + written(t, "C11") * (I2 - 3),
        written(t, "C01") + 2 * written(t, "C02") * (I2 - 3) + written(t, "C11") * (I1 - 3));
  if (law != "holzapfel-gasser-ogden") throw std::runtime_error("no closed form of " + law);
  const double cosine = std::cos(29 * M_PI / 180), sine = std::sin(29 * M_PI / 180);
  const double E = std::max(0.0, l * l * cosine * cosine + sine * sine / l - 1);
  const double k2 = written(t, "k2");
  return written(t, "c") * (l - 1 / (l * l)) +
         2 * 2 * written(t, "k1") * E * std::exp(k2 * E * E) * l * cosine * cosine;
}

/// At F = diag(l, l^-1/2, l^-1/2) around the axis of the fibres: X on the first axis, the mean
/// direction along the second.
double nominal_stress(const fem::LawConstants& constants, double l) {
  const fem::Law law = fem::make_law(constants, "tissue");
  const double s = 1 / std::sqrt(l);
  fem::Tensor2<fem::Lanes> F{}, cof;
  for (fem::Lanes& entry : F) entry = fem::Lanes::Constant(0.0);
  F[0] = fem::Lanes::Constant(s);
  F[4] = fem::Lanes::Constant(l);
  F[8] = fem::Lanes::Constant(s);
  cof = fem::cofactor(F);
  fem::Fibres<fem::Lanes> fibres;
  const auto directions = law.fibres_at({0.01, 0, 0});
  for (std::size_t family = 0; family < 2; ++family)
    for (std::size_t i = 0; i < 3; ++i)
      fibres[family][i] = fem::Lanes::Constant(directions[family][i]);
  const auto P = law.piola(F, cof, fem::Lanes::Constant(1.0), fibres);
  // The pressure of the incompressible solid takes the stress across, on the first axis, away.
  return P[4][0] - P[0][0] * s / l;
}

toml::table table_of_tissues() {
  return toml::parse_file((test::source_folder() / "data/materials.toml").string());
}

TEST(Tissues, AreMaterialsOfACaseAndHaveTheStressOfTheirConstants) {
  const toml::table file = table_of_tissues();
  const toml::array& tissues = *file["tissue"].as_array();
  EXPECT_GE(tissues.size(), 9u);
  for (const toml::node& node : tissues) {
    const toml::table& tissue = *node.as_table();
    const std::string name = tissue["name"].value<std::string>().value();
    SCOPED_TRACE(name);
    for (const char* about : {"source", "range", "note"})
      EXPECT_GE(tissue[about].value<std::string>().value().size(), 10u) << about;
    const Case c = parse_case(case_with(tissue), "tissue.toml");
    const fem::LawConstants law = c.materials.at(0).law;
    for (const double stretch : {0.9, 1.1, 1.2}) {
      const double expected = closed_form(tissue, stretch);
      EXPECT_NEAR(nominal_stress(law, stretch), expected, 1e-9 * std::abs(expected) + 1e-9);
    }
  }
}

/// The material of a tissue as the stages get it.
fem::RegionMaterial material_of(const toml::table& tissue) {
  const Case c = parse_case(case_with(tissue), "tissue.toml");
  return campaign_material(c.materials.at(0), {});
}

/// Shear modulus at small strain, Pa, at a time t (s) after a step of strain.
double shear_modulus(const fem::RegionMaterial& material, double t) {
  return fem::rest_moduli(material.law).mu() * relaxed_fraction(material.relaxation, t);
}

TEST(Tissues, RelaxByFractionsAndTimesThatADeviceFeels) {
  std::size_t series = 0;
  const toml::table file = table_of_tissues();
  for (const toml::node& node : *file["tissue"].as_array()) {
    const toml::table& tissue = *node.as_table();
    SCOPED_TRACE(tissue["name"].value<std::string>().value());
    EXPECT_EQ(tissue.contains("relaxation"), tissue.contains("moduli"));
    const RelaxationSeries relaxation = material_of(tissue).relaxation;
    if (relaxation.empty()) continue;
    ++series;
    EXPECT_EQ(tissue["note"].value<std::string>().value().find("read"), 0U);  // not recalled
    EXPECT_GT(long_term_fraction(relaxation), 0.01);
    for (const RelaxationBranch& branch : relaxation) {
      EXPECT_GT(branch.fraction, 0.01);
      EXPECT_GT(branch.time_s, 0.02);  // twenty periods of a loop of 1 kHz
      EXPECT_LT(branch.time_s, 3600);
    }
  }
  EXPECT_GE(series, 5U);
}

/// What a source states of a shear modulus, and the time after a step of strain.
struct StatedModulus {
  const char* tissue;
  double time_s, modulus;  ///< s, Pa
};

/// In the abstracts that the entries cite. A Maxwell element beside a spring has relaxed to 1/e of
/// its modulus at its time.
TEST(Tissues, HaveTheModuliThatTheirSourcesState) {
  const double e = std::exp(1.0);
  const StatedModulus stated[] = {{"brain, human cortex", 0, 700 + 2000},
                                  {"brain, human cortex", 9.7, 700 + 2000 / e},
                                  {"brain, human cortex", kInfinity, 700},
                                  {"brain, human corona radiata", 0, 300 + 900},
                                  {"brain, human corona radiata", 14.9, 300 + 900 / e},
                                  {"brain, human corona radiata", kInfinity, 300},
                                  {"skeletal muscle, swine", 0, 8509},
                                  {"skeletal muscle, swine", 20, 1.1 * 609},
                                  {"skeletal muscle, swine", kInfinity, 609},
                                  {"liver, human, elastography", 0, 2300}};
  const toml::table file = table_of_tissues();
  for (const StatedModulus& s : stated) {
    const auto& tissues = *file["tissue"].as_array();
    const auto found = std::find_if(tissues.begin(), tissues.end(), [&](const toml::node& node) {
      return (*node.as_table())["name"].value<std::string>() == s.tissue;
    });
    ASSERT_NE(found, tissues.end()) << s.tissue;
    EXPECT_NEAR(shear_modulus(material_of(*found->as_table()), s.time_s), s.modulus,
                5e-3 * s.modulus)
        << s.tissue << " at " << s.time_s << " s";
  }
}

}  // namespace
}  // namespace palpate::app
