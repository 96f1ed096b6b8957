// SPDX-License-Identifier: AGPL-3.0-or-later
// What FEBio makes of the constants in a deck: its Cauchy stresses, from the formulas of its source
// (FEBioMech, version 4, January 2026), against those of the laws.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <string>

#include "app/export/deck.hpp"
#include "fem/laws/law.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/sample_laws.hpp"
#include "tests/unit/app/export/decks.hpp"

namespace palpate::app {
namespace {

using Matrix = Eigen::Matrix3d;

std::string deck_with(const fem::LawConstants& law) {
  const Body body =
      test::make_block(test::even(0, 0.02, 2), test::even(0, 0.02, 2), test::even(0, 0.01, 1));
  fem::CampaignSettings settings;
  settings.materials = {{"tissue", law}};
  return febio_deck(make_patch_deck(body, settings, test::site_nearest(body, 0.01, 0.01), 0.0052));
}

struct Material {
  std::string type;
  std::map<std::string, double> values;
  Matrix axes = Matrix::Identity();

  double at(const std::string& name) const { return values.at(name); }
};

Eigen::Vector3d vector_in(const std::string& text, const char* tag) {
  std::smatch found;
  const std::regex three(std::string("<") + tag + ">([^,<]+),([^,<]+),([^,<]+)</");
  EXPECT_TRUE(std::regex_search(text, found, three)) << tag;
  return {std::stod(found[1]), std::stod(found[2]), std::stod(found[3])};
}

/// The first material of a deck, as FEBio reads it: a along the first axis, d in the plane of the
/// first two.
Material material_in(const std::string& deck) {
  const std::size_t begin = deck.find("<material id"), end = deck.find("</material>");
  const std::string text = deck.substr(begin, end - begin);
  Material material;
  std::smatch found;
  EXPECT_TRUE(std::regex_search(text, found, std::regex("type=\"([^\"]+)\"")));
  material.type = found[1];
  const std::regex number("<([A-Za-z0-9_]+)>([-+.0-9e]+)</");
  for (std::sregex_iterator it(text.begin(), text.end(), number), last; it != last; ++it)
    material.values[(*it)[1]] = std::stod((*it)[2]);
  if (text.find("<mat_axis") != std::string::npos) {
    const Eigen::Vector3d a = vector_in(text, "a").normalized();
    const Eigen::Vector3d c = a.cross(vector_in(text, "d")).normalized();
    material.axes << a, c.cross(a), c;
  }
  return material;
}

/// W1 B + W2 (I1 B - B^2), twice.
Matrix of_invariants(const Matrix& B, double W1, double W2) {
  return 2 * ((W1 + W2 * B.trace()) * B - W2 * B * B);
}

Matrix ogden_stress(const Material& m, const Matrix& B) {
  const Eigen::SelfAdjointEigenSolver<Matrix> principal(B);
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  for (int i = 1; m.values.contains(std::string("c") + std::to_string(i)); ++i) {
    const double c = m.at(std::string("c") + std::to_string(i)),
                 power = m.at(std::string("m") + std::to_string(i));
    for (int axis = 0; axis < 3; ++axis)
      t[axis] += c / power * (std::pow(principal.eigenvalues()[axis], power / 2) - 1);
  }
  return principal.eigenvectors() * t.asDiagonal() * principal.eigenvectors().transpose();
}

Matrix fibre_stress(const Material& m, const Matrix& F, const Matrix& B) {
  const double kappa = m.at("kappa"), gamma = m.at("gamma") * M_PI / 180;
  Matrix stress = m.at("c") * B;
  for (const double side : {1.0, -1.0}) {
    const Eigen::Vector3d a =
        F * (std::cos(gamma) * m.axes.col(0) + side * std::sin(gamma) * m.axes.col(1));
    const double E = kappa * (B.trace() - 3) + (1 - 3 * kappa) * (a.squaredNorm() - 1);
    if (E < 0) continue;
    stress += 2 * m.at("k1") * E * std::exp(m.at("k2") * E * E) *
              (kappa * B + (1 - 3 * kappa) * a * a.transpose());
  }
  return stress;
}

/// Cauchy stress at J = 1, but for a pressure in the uncoupled materials.
Matrix febio_stress(const Material& m, const Matrix& F) {
  const Matrix B = F * F.transpose();
  const double x = B.trace() - 3;
  if (m.type == "Mooney-Rivlin") return of_invariants(B, m.at("c1"), m.at("c2"));
  if (m.type == "Yeoh")
    return of_invariants(B, m.at("c1") + m.at("c2") * x + m.at("c3") * x * x, 0);
  if (m.type == "Veronda-Westmann") {
    const double modulus = m.at("c1") * m.at("c2");
    return of_invariants(B, modulus * std::exp(m.at("c2") * x), -modulus / 2);
  }
  if (m.type == "Gent") return of_invariants(B, 0.5 * m.at("G") * m.at("Jm") / (m.at("Jm") - x), 0);
  if (m.type == "Ogden") return ogden_stress(m, B);
  if (m.type == "Holzapfel-Gasser-Ogden") return fibre_stress(m, F, B);
  EXPECT_EQ(m.type, "isotropic elastic");
  const double E = m.at("E"), nu = m.at("v");
  return nu * E / ((1 + nu) * (1 - 2 * nu)) * x / 2 * B + E / (2 * (1 + nu)) * (B * B - B);
}

/// Cauchy stress of the law, eight times the same.
Matrix own_stress(const fem::LawConstants& constants, const Matrix& F) {
  const fem::Law law = fem::make_law(constants, "test");
  fem::Tensor2<fem::Lanes> f, cof;
  fem::Fibres<fem::Lanes> a;
  const Matrix cofactor = F.inverse().transpose();
  for (std::size_t i = 0; i < 9; ++i) {
    const auto row = static_cast<Eigen::Index>(i / 3), column = static_cast<Eigen::Index>(i % 3);
    f[i] = fem::Lanes::Constant(F(row, column));
    cof[i] = fem::Lanes::Constant(cofactor(row, column));
  }
  const auto fibres = law.fibres_at({});
  for (std::size_t family = 0; family < 2; ++family)
    for (std::size_t i = 0; i < 3; ++i) a[family][i] = fem::Lanes::Constant(fibres[family][i]);
  const auto P = law.piola(f, cof, fem::Lanes::Constant(1), a);
  Matrix nominal;
  for (std::size_t i = 0; i < 9; ++i)
    nominal(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) = P[i][0];
  return nominal * F.transpose();
}

Matrix deviator(const Matrix& s) {
  return s - s.trace() / 3 * Matrix::Identity();
}

TEST(FebioLaws, HaveTheStressesOfTheirs) {
  Matrix F;
  F << 1.25, 0.2, -0.05, 0.1, 0.9, 0.15, 0, -0.1, 1.1;
  F /= std::cbrt(F.determinant());
  int compared = 0;
  for (fem::LawConstants law : test::sample_laws(0.45)) {
    if (law.law == "mooney-rivlin-5" || law.law == "demiray-fung" || law.law == "arruda-boyce")
      continue;
    for (const int families : {1, 2}) {
      law.fibres.families = families;
      const Material material = material_in(deck_with(law));
      Matrix own = own_stress(law, F), febio = febio_stress(material, F);
      if (law.law != "saint-venant-kirchhoff") {
        own = deviator(own);
        febio = deviator(febio);
        // U = k/4 (J^2 - 1 - 2 ln J).
        EXPECT_EQ(material.at("pressure_model"), 3);
        EXPECT_NEAR(material.at("k"), fem::rest_moduli(law).kappa(), 1e-9 * material.at("k"));
      }
      EXPECT_LT((own - febio).norm(), 1e-9 * own.norm()) << law.law << ", " << families;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 20);
}

/// FEBio's stress in steps (FEUncoupledViscoElasticMaterial, January 2026), for one that is 1 at
/// once and grows evenly until `press`.
double relaxed_by_febio(const Material& m, double press, double end, int steps) {
  double before = 0, stress = 0;
  std::map<std::string, double> times, history;  // of each term, by its number
  for (const auto& [name, value] : m.values)
    if (name[0] == 't') times[name.substr(1)] = value;
  const double dt = end / steps;
  for (int step = 1; step <= steps; ++step) {
    const double now = std::min(step * dt / press, 1.0);
    stress = m.at("g0") * now;
    for (const auto& [number, time] : times) {
      const double x = dt / time;
      double& H = history[number];
      H = H * std::exp(-x) + (now - before) * (1 - std::exp(-x)) / x;
      stress += m.at(std::string("g").append(number)) * H;
    }
    before = now;
  }
  return stress;
}

/// The hereditary integral of g(t - s) over a stress that grows evenly for `press`.
TEST(FebioLaws, RelaxAsTheSeriesOfTheCase) {
  const RelaxationSeries series{{0.3, 0.05}, {0.2, 2}};
  Deck deck = relaxing_deck(series);
  deck.pace = PressAndHold{0.5, 3};
  const std::string text = febio_deck(deck);
  EXPECT_NE(text.find("<elastic type=\"Mooney-Rivlin\">"), std::string::npos);
  const Material material = material_in(text);
  EXPECT_EQ(material.type, "uncoupled viscoelastic");
  EXPECT_NEAR(material.at("c1"), fem::rest_moduli(deck.laws[0]).mu() / 2, 1e-9 * material.at("c1"));
  for (const double end : {0.5, 0.6, 3.5}) {
    constexpr int kParts = 20000;
    double expected = 0;
    for (int i = 0; i < kParts; ++i)
      expected += relaxed_fraction(series, end - 0.5 * (i + 0.5) / kParts) / kParts;
    EXPECT_NEAR(relaxed_by_febio(material, 0.5, end, 700), expected, 1e-6) << end;
  }
}

}  // namespace
}  // namespace palpate::app
