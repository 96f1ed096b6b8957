// SPDX-License-Identifier: AGPL-3.0-or-later
// Homogeneous deformations of a block of distorted elements between planes of symmetry, compared
// with the closed forms of the nominal stress P of the incompressible solid.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <utility>

#include "fem/laws/law_table.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/equilibrium.hpp"
#include "tests/verification/record.hpp"

namespace palpate::fem {
namespace {

using test::Prescribed;

/// A face that is moved along one axis, by a function of the reference position.
struct Motion {
  int face_axis;
  double face;  ///< 0 or 1
  int axis;
  std::function<double(const Eigen::Vector3d& X)> by;
};

/// A block with its displacements.
class Block {
 public:
  explicit Block(const LawConstants& law)
      : body_(test::uneven_cube()),
        model_(body_, {make_law(law, "block")}),
        u_(Displacement::Zero(3, model_.mesh().nodes())) {}

  void deform(const std::vector<Motion>& motions, double fraction) {
    std::vector<Prescribed> prescribed;
    for (int node = 0; node < model_.mesh().nodes(); ++node) {
      const Eigen::Vector3d X = model_.mesh().X.col(node);
      std::array<bool, 3> given{};
      for (const Motion& m : motions) {
        if (X[m.face_axis] != m.face || given[to_index(m.axis)]) continue;
        given[to_index(m.axis)] = true;
        prescribed.push_back({model_.equation(node) + m.axis, fraction * m.by(X)});
      }
    }
    test::equilibrate(model_, test::Loads::Zero(3, model_.mesh().nodes()), prescribed, u_);
  }
  void start_from(const Block& other) { u_ = other.u_; }

  /// The stretch along an axis; the faces across it stay plane.
  double stretch(int axis) const {
    for (int node = 0; node < model_.mesh().nodes(); ++node)
      if (model_.mesh().X(axis, node) == 1) return 1 + u_(axis, node);
    return 0;
  }

  /// Force on a face at 1 over its reference area.
  double nominal_stress(int face_axis, int axis) const {
    Eigen::VectorXd f;
    model_.forces(u_, f);
    double sum = 0;
    for (int node = 0; node < model_.mesh().nodes(); ++node)
      if (model_.mesh().X(face_axis, node) == 1) sum += f[model_.equation(node) + axis];
    return sum;
  }

 private:
  Body body_;
  SolidModel model_;
  Displacement u_;
};

struct Stress {
  int face_axis, axis;
};

/// Stresses of a law with its own Poisson's ratio, in ten steps from rest.
std::vector<double> stresses(const LawConstants& law, const std::vector<Motion>& motions,
                             const std::vector<Stress>& wanted, std::optional<Block>& block) {
  if (!block) {
    block.emplace(law);
    for (int step = 1; step <= 10; ++step) block->deform(motions, 0.1 * step);
  } else {
    Block next(law);
    next.start_from(*block);
    next.deform(motions, 1);
    block.emplace(std::move(next));
  }
  std::vector<double> found;
  for (const Stress& s : wanted) found.push_back(block->nominal_stress(s.face_axis, s.axis));
  return found;
}

/// Stresses of the incompressible solid. The bulk modulus grows threefold from state to state until
/// the error of the compressibility, which is proportional to its inverse, can be extrapolated to
/// 0.
std::vector<double> incompressible(LawConstants law, const std::vector<Motion>& motions,
                                   const std::vector<Stress>& wanted) {
  law.values.emplace_back("poisson", 0.45);
  std::optional<Block> block;
  std::vector<double> before, now;
  for (double compressibility = 0.05; compressibility > 1e-6; compressibility /= 3) {
    law.at("poisson") = 0.5 - compressibility;  // kappa goes as its inverse
    if (law.law == "neo-hookean") law.at("young") = 2 * (1.5 - compressibility);
    before = std::exchange(now, stresses(law, motions, wanted, block));
  }
  for (std::size_t i = 0; i < now.size(); ++i) now[i] += (now[i] - before[i]) / 2;
  return now;
}

Motion moved(int axis, double stretch) {
  return {axis, 1, axis, [stretch](const Eigen::Vector3d&) { return stretch - 1; }};
}
Motion at_rest(int face_axis, double face, int axis) {
  return {face_axis, face, axis, [](const Eigen::Vector3d&) { return 0.0; }};
}
std::vector<Motion> symmetry() {
  return {at_rest(0, 0, 0), at_rest(1, 0, 1), at_rest(2, 0, 2)};
}

enum class Mode { Uniaxial, Equibiaxial, PureShear };

std::vector<Motion> motions_of(Mode mode, double stretch) {
  std::vector<Motion> motions = symmetry();
  motions.push_back(moved(0, stretch));
  if (mode == Mode::Equibiaxial) motions.push_back(moved(1, stretch));
  if (mode == Mode::PureShear) motions.push_back(at_rest(1, 1, 1));
  return motions;
}

double incompressible_stress(const LawConstants& law, Mode mode, double stretch) {
  return incompressible(law, motions_of(mode, stretch), {{0, 0}}).front();
}

const char* name_of(Mode mode) {
  return mode == Mode::Uniaxial      ? "uniaxial"
         : mode == Mode::Equibiaxial ? "equibiaxial"
                                     : "pure shear";
}

constexpr auto kProblem = "Blocks: nominal stress of homogeneous deformations";

void check(const LawConstants& law, Mode mode, double stretch, double expected) {
  char name[80];
  std::snprintf(name, sizeof name, "%s, %s, stretch %.1f", law.law.c_str(), name_of(mode), stretch);
  test::verify({kProblem, name, "mu", incompressible_stress(law, mode, stretch), expected,
                test::Reference::ClosedForm, "incompressible", 1e-5});
}

struct Printed {
  LawConstants law;
  double compressed, uniaxial, equibiaxial, pure_shear;
};

/// Moduli in units of mu; stresses with six decimals.
std::vector<Printed> printed() {
  return {{LawConstants("neo-hookean", {{"young", 3}}), -0.334568, 0.708284, 1.030671, 0.844834},
          {LawConstants("mooney-rivlin", {{"C10", 0.4}, {"C01", 0.1}}), -0.342003, 0.675594,
           1.172904, 0.844834},
          {LawConstants("yeoh", {{"C10", 0.5}, {"C20", -0.02}, {"C30", 0.003}}), -0.333712,
           0.696004, 0.980359, 0.827000},
          {LawConstants("demiray-fung", {{"mu", 1}, {"b", 3}}), -0.368524, 1.405614, 9.212796,
           1.967045},
          {LawConstants("veronda-westmann", {{"C1", 0.25}, {"C2", 4}}), -0.389443, 2.987940,
           36.497640, 4.369419}};
}

class Blocks : public testing::TestWithParam<Printed> {};

TEST_P(Blocks, HaveTheStressOfTheClosedForm) {
  const Printed& p = GetParam();
  check(p.law, Mode::Uniaxial, 0.9, p.compressed);
  check(p.law, Mode::Uniaxial, 1.3, p.uniaxial);
  check(p.law, Mode::Equibiaxial, 1.3, p.equibiaxial);
  check(p.law, Mode::PureShear, 1.3, p.pure_shear);
}

INSTANTIATE_TEST_SUITE_P(Laws, Blocks, testing::ValuesIn(printed()), [](const auto& instance) {
  std::string name = instance.param.law.law;
  std::erase(name, '-');
  return name;
});

/// dW/dI1 and dW/dI2 of a law.
using Slopes = std::function<std::array<double, 2>(double I1, double I2)>;

/// P of the incompressible solid: 2 (l - l^-n) (W1 + W2 l^m).
double closed_form(const Slopes& slopes, Mode mode, double l) {
  const double l2 = l * l, l4 = l2 * l2;
  if (mode == Mode::Uniaxial) {
    const auto [W1, W2] = slopes(l2 + 2 / l, 2 * l + 1 / l2);
    return 2 * (l - 1 / l2) * (W1 + W2 / l);
  }
  if (mode == Mode::Equibiaxial) {
    const auto [W1, W2] = slopes(2 * l2 + 1 / l4, l4 + 2 / l2);
    return 2 * (l - 1 / (l4 * l)) * (W1 + l2 * W2);
  }
  const double I = l2 + 1 + 1 / l2;
  const auto [W1, W2] = slopes(I, I);
  return 2 * (l - 1 / (l2 * l)) * (W1 + W2);
}

void check_all(const LawConstants& law, const std::function<double(Mode, double)>& expected) {
  check(law, Mode::Uniaxial, 0.9, expected(Mode::Uniaxial, 0.9));
  for (const Mode mode : {Mode::Uniaxial, Mode::Equibiaxial, Mode::PureShear})
    check(law, mode, 1.3, expected(mode, 1.3));
}

TEST(Block, MooneyRivlinOfFiveConstantsHasTheStressOfTheClosedForm) {
  const LawConstants law("mooney-rivlin-5",
                         {{"C10", 0.3}, {"C01", 0.2}, {"C20", 0.12}, {"C11", 0.06}, {"C02", 0.09}});
  check_all(law, [](Mode mode, double l) {
    return closed_form(
        [](double I1, double I2) -> std::array<double, 2> {
          return {0.3 + 0.24 * (I1 - 3) + 0.06 * (I2 - 3), 0.2 + 0.06 * (I1 - 3) + 0.18 * (I2 - 3)};
        },
        mode, l);
  });
}

/// W1 = mu J_m/(2 (J_m - (I1 - 3))).
TEST(Block, GentHasTheStressOfTheClosedForm) {
  check_all(LawConstants("gent", {{"mu", 1}, {"J_m", 5}}), [](Mode mode, double l) {
    return closed_form(
        [](double I1, double) -> std::array<double, 2> {
          return {0.5 * 5 / (5 - (I1 - 3)), 0};
        },
        mode, l);
  });
}

/// W' and the modulus at rest of the series in its common form, term by term.
TEST(Block, ArrudaBoyceHasTheStressOfTheClosedForm) {
  const double n = 1.6 * 1.6;
  const double at_rest = 1 + 3 / (5 * n) + 99 / (175 * n * n) + 513 / (875 * n * n * n) +
                         42039 / (67375 * n * n * n * n);
  check_all(LawConstants("arruda-boyce", {{"mu", 1}, {"lambda_m", 1.6}}), [&](Mode mode, double l) {
    return closed_form(
        [&](double I1, double) -> std::array<double, 2> {
          const double x = I1 / n;
          return {(0.5 + x / 10 + 11 * x * x / 350 + 19 * x * x * x / 1750 +
                   519 * x * x * x * x / 134750) /
                      at_rest,
                  0};
        },
        mode, l);
  });
}

/// P = sum of 2 mu/alpha (l^(alpha-1) - l^-n), n = 1 + alpha/2, 1 + 2 alpha and 1 + alpha.
TEST(Block, OgdenOfOneAndTwoTermsHasTheStressOfTheClosedForm) {
  struct Term {
    double mu, alpha;
  };
  const auto stress = [](const std::vector<Term>& terms, Mode mode, double l) {
    double sum = 0;
    for (const auto& [mu, alpha] : terms) {
      const double lateral = mode == Mode::Uniaxial ? 0.5 : mode == Mode::Equibiaxial ? 2 : 1;
      sum += 2 * mu / alpha * (std::pow(l, alpha - 1) - std::pow(l, -lateral * alpha - 1));
    }
    return sum;
  };
  check_all(LawConstants("ogden-1", {{"mu_1", 1}, {"alpha_1", -4.7}}), [&](Mode mode, double l) {
    return stress({{1, -4.7}}, mode, l);
  });
  check_all(
      LawConstants("ogden-2", {{"mu_1", 0.6}, {"alpha_1", 3.5}, {"mu_2", 0.4}, {"alpha_2", -6}}),
      [&](Mode mode, double l) {
        return stress({{0.6, 3.5}, {0.4, -6}}, mode, l);
      });
}

/// mu_i of the table, MPa, is 2 mu/alpha of a term mu/alpha (sum l^alpha - 3): half alpha of it is
/// the shear modulus of the term.
TEST(Block, OgdenRubberHasTheStressOfTheClosedForm) {
  const LawConstants rubber("ogden-3", {{"mu_1", 0.5 * 1.3 * 0.63},
                                        {"alpha_1", 1.3},
                                        {"mu_2", 0.5 * 5 * 0.0012},
                                        {"alpha_2", 5},
                                        {"mu_3", 0.5 * 2 * 0.01},
                                        {"alpha_3", -2}});
  const auto row = [&](Mode mode, double expected) {
    test::verify({kProblem, std::string("ogden-3, ") + name_of(mode) + ", stretch 2.0", "MPa",
                  incompressible_stress(rubber, mode, 2), expected, test::Reference::ClosedForm,
                  "incompressible, five digits", 2e-5});
  };
  row(Mode::Uniaxial, 0.60272);
  row(Mode::Equibiaxial, 0.82161);
  row(Mode::PureShear, 0.68562);
}

/// S = E* E11 with the modulus of each mode; the law is compressible.
TEST(Block, SaintVenantKirchhoffHasTheStressOfTheClosedForm) {
  const double nu = 0.3, l = 1.2, uniaxial = l * (l * l - 1) / 2;
  const auto row = [&](Mode mode, double expected) {
    std::optional<Block> block;
    const LawConstants law("saint-venant-kirchhoff", {{"young", 1}, {"poisson", nu}});
    const double computed = stresses(law, motions_of(mode, l), {{0, 0}}, block).front();
    test::verify({kProblem, law.law + ", " + name_of(mode) + ", stretch 1.2, nu = 0.3", "E",
                  computed, expected, test::Reference::ClosedForm, "S = E* E11", 1e-8});
  };
  row(Mode::Uniaxial, uniaxial);
  row(Mode::Equibiaxial, uniaxial / (1 - nu));
  row(Mode::PureShear, uniaxial / (1 - nu * nu));
}

/// A beam of length 8 under a Cauchy stress of 2, C10 = 1.92505, D1 = 0.026. At the printed
/// elongation the stress must be 2. CalculiX has kappa/2 (J - 1)^2; J is 1.01 here.
TEST(Block, CompressibleNeoHookeanHasTheElongationThatCalculixPrints) {
  const double mu = 2 * 1.92505, kappa = 2 / 0.026;
  const double nu = (3 * kappa - 2 * mu) / (2 * (3 * kappa + mu));
  std::optional<Block> block;
  const double nominal = stresses({2 * mu * (1 + nu), nu},
                                  motions_of(Mode::Uniaxial, 1 + 1.415438 / 8), {{0, 0}}, block)
                             .front();
  test::verify({kProblem, "neo-hookean, compressible, Cauchy stress at an elongation of 1.415438/8",
                "1", nominal / (block->stretch(1) * block->stretch(2)), 2,
                test::Reference::Published, "CalculiX, test example beamnh", 0.005});
}

/// Neo-Hookean with mu = 1 and one family of fibres with k1 E exp(k2 E^2).
struct Fibred {
  static constexpr double k1 = 2, k2 = 0.8;

  static LawConstants law(double dispersion, double angle) {
    FibreField field;
    field.angle = angle;
    return {
        "holzapfel-gasser-ogden", {{"c", 1}, {"k1", k1}, {"k2", k2}, {"kappa", dispersion}}, field};
  }
  static double pull(double E) { return k1 * E * std::exp(k2 * E * E); }
};
constexpr double kAlong = 0, kAcross = M_PI / 2;  ///< angles of fibres from the direction of pull

/// Fibres along the loading direction add 2 l k1 E exp(k2 E^2), E = l^2 - 1, to a solid of mu = 1;
/// fibres in compression carry no stress.
TEST(Block, FibresHaveTheStressOfTheClosedForm) {
  check_all(Fibred::law(0, kAlong), [](Mode mode, double l) {
    const double matrix = closed_form(
        [](double, double) -> std::array<double, 2> {
          return {0.5, 0};
        },
        mode, l);
    return matrix + 2 * l * Fibred::pull(std::max(0.0, l * l - 1));
  });
}

constexpr double kShear = 0.4;

/// Nominal tractions on the sheared face with normal y, which is moved along x.
struct ShearTractions {
  double along, normal;
};

/// u_x = g y on the faces across x and y; the body is free to thin or thicken along z.
std::vector<Motion> simple_shear(double g) {
  std::vector<Motion> motions{at_rest(2, 0, 2)};
  for (const int face_axis : {0, 1})
    for (const double face : {0.0, 1.0}) {
      motions.push_back({face_axis, face, 0, [g](const Eigen::Vector3d& X) { return g * X[1]; }});
      motions.push_back(at_rest(face_axis, face, 1));
    }
  return motions;
}
const std::vector<Stress> kShearTractions{{1, 0}, {1, 1}};

void verify_shear(const std::string& name, const std::string& unit,
                  const std::vector<double>& found, const ShearTractions& expected,
                  const std::string& source, double bound) {
  const auto row = [&](const char* direction, double computed, double reference) {
    // The bound of a traction that vanishes is relative to the other one.
    const bool none = reference == 0;
    test::verify({kProblem, name + ", simple shear 0.4, " + direction, unit, computed,
                  none ? 0.0 : reference, test::Reference::ClosedForm, source,
                  none ? bound * std::abs(expected.along) : bound,
                  none ? test::Error::Absolute : test::Error::Relative});
  };
  row("along the face", found[0], expected.along);
  row("normal to the face", found[1], expected.normal);
}

void check_shear(const std::string& name, const LawConstants& law, const ShearTractions& expected,
                 const std::string& unit = "mu") {
  verify_shear(name, unit, incompressible(law, simple_shear(kShear), kShearTractions), expected,
               "incompressible", 1e-5);
}

/// s12 = 2 g (W1 + W2); with s33 = 0 the traction normal to the sheared face is -2 g^2 W2.
ShearTractions sheared(const Slopes& slopes, double g) {
  const double I = 3 + g * g;
  const auto [W1, W2] = slopes(I, I);
  return {2 * g * (W1 + W2), -2 * g * g * W2};
}

struct Sheared {
  LawConstants law;
  Slopes slopes;
};

/// The laws of the invariants, with dW/dI1 and dW/dI2 independent of the implementation.
std::vector<Sheared> laws_of_invariants() {
  using Two = std::array<double, 2>;
  const double n = 1.6 * 1.6;
  const double at_rest = 1 + 3 / (5 * n) + 99 / (175 * n * n) + 513 / (875 * n * n * n) +
                         42039 / (67375 * n * n * n * n);
  return {{LawConstants("neo-hookean", {{"young", 3}}),
           [](double, double) {
             return Two{0.5, 0};
           }},
          {LawConstants("mooney-rivlin", {{"C10", 0.4}, {"C01", 0.1}}),
           [](double, double) {
             return Two{0.4, 0.1};
           }},
          {LawConstants("mooney-rivlin-5",
                        {{"C10", 0.3}, {"C01", 0.2}, {"C20", 0.12}, {"C11", 0.06}, {"C02", 0.09}}),
           [](double I1, double I2) {
             return Two{0.3 + 0.24 * (I1 - 3) + 0.06 * (I2 - 3),
                        0.2 + 0.06 * (I1 - 3) + 0.18 * (I2 - 3)};
           }},
          {LawConstants("yeoh", {{"C10", 0.5}, {"C20", -0.02}, {"C30", 0.003}}),
           [](double I1, double) {
             return Two{0.5 - 0.04 * (I1 - 3) + 0.009 * (I1 - 3) * (I1 - 3), 0};
           }},
          {LawConstants("demiray-fung", {{"mu", 1}, {"b", 3}}),
           [](double I1, double) {
             return Two{0.5 * std::exp(3 * (I1 - 3)), 0};
           }},
          {LawConstants("veronda-westmann", {{"C1", 0.25}, {"C2", 4}}),
           [](double I1, double) {
             return Two{std::exp(4 * (I1 - 3)), -0.5};
           }},
          {LawConstants("gent", {{"mu", 1}, {"J_m", 5}}),
           [](double I1, double) {
             return Two{0.5 * 5 / (5 - (I1 - 3)), 0};
           }},
          {LawConstants("arruda-boyce", {{"mu", 1}, {"lambda_m", 1.6}}),
           [n, at_rest](double I1, double) {
             const double x = I1 / n;
             return Two{(0.5 + x / 10 + 11 * x * x / 350 + 19 * x * x * x / 1750 +
                         519 * x * x * x * x / 134750) /
                            at_rest,
                        0};
           }}};
}

class ShearedBlocks : public testing::TestWithParam<Sheared> {};

TEST_P(ShearedBlocks, HaveTheTractionsOfTheClosedForm) {
  check_shear(GetParam().law.law, GetParam().law, sheared(GetParam().slopes, kShear));
}

INSTANTIATE_TEST_SUITE_P(Laws, ShearedBlocks, testing::ValuesIn(laws_of_invariants()),
                         [](const auto& instance) {
                           std::string name = instance.param.law.law;
                           std::erase(name, '-');
                           return name;
                         });

/// The principal stretches are l, 1 and 1/l with g = l - 1/l, and l lies at the angle atan(1/l)
/// from the direction of shear [Ogden 1984]: with t_i = sum of 2 mu/alpha l_i^alpha,
/// s12 = (t_1 - t_3) l/(1 + l^2) and s22 - s33 = (t_1 + l^2 t_3)/(1 + l^2) - t_2.
ShearTractions sheared_ogden(const std::vector<std::array<double, 2>>& terms, double g) {
  const double l = g / 2 + std::sqrt(1 + g * g / 4);
  std::array<double, 3> t{};
  for (const auto& [mu, alpha] : terms)
    for (std::size_t i = 0; i < 3; ++i)
      t[i] += 2 * mu / alpha * std::pow(l, alpha * (1 - static_cast<double>(i)));
  return {(t[0] - t[2]) * l / (1 + l * l), (t[0] + l * l * t[2]) / (1 + l * l) - t[1]};
}

TEST(ShearedBlock, OgdenHasTheTractionsOfTheClosedForm) {
  const auto check_terms = [](const std::vector<std::array<double, 2>>& terms,
                              const std::string& unit = "mu") {
    const std::string name = "ogden-" + std::to_string(terms.size());
    std::vector<std::pair<std::string, double>> constants;
    for (std::size_t i = 0; i < terms.size(); ++i) {
      constants.emplace_back("mu_" + std::to_string(i + 1), terms[i][0]);
      constants.emplace_back("alpha_" + std::to_string(i + 1), terms[i][1]);
    }
    check_shear(name, {name, constants}, sheared_ogden(terms, kShear), unit);
  };
  check_terms({{1, -4.7}});
  check_terms({{0.6, 3.5}, {0.4, -6}});
  check_terms({{0.4095, 1.3}, {0.003, 5}, {0.01, -2}}, "MPa");
}

/// Fibres across the plane of shear are lengthened, a = (g, 1, 0): with E = (1 - 2 kappa) g^2 and
/// p = k1 E exp(k2 E^2), s12 = g (1 + 2 kappa p) + 2 g (1 - 3 kappa) p and s22 - s33 = 2 (1 - 3
/// kappa) p [Gasser, Ogden & Holzapfel 2006]. Those along the direction of shear keep their length:
/// only the dispersed part of them, E = kappa g^2, is drawn, and its mean direction (1, 0, 0) has
/// no traction.
TEST(ShearedBlock, FibresHaveTheTractionsOfTheClosedForm) {
  const double g = kShear;
  for (const double kappa : {0.0, 0.1}) {
    const auto named = [kappa](const char* direction) {
      char name[80];
      std::snprintf(name, sizeof name, "holzapfel-gasser-ogden, kappa = %g, fibres %s", kappa,
                    direction);
      return std::string(name);
    };
    const double across = Fibred::pull((1 - 2 * kappa) * g * g),
                 along = Fibred::pull(kappa * g * g);
    check_shear(named("across"), Fibred::law(kappa, kAcross),
                {g * (1 + 2 * kappa * across) + 2 * g * (1 - 3 * kappa) * across,
                 2 * (1 - 3 * kappa) * across});
    check_shear(named("along"), Fibred::law(kappa, kAlong), {g * (1 + 2 * kappa * along), 0});
  }
}

/// E12 = g/2, E22 = g^2/2, S33 = 0: S12 = mu g, S22 = E22 young/(1 - nu^2), P = F S.
TEST(ShearedBlock, SaintVenantKirchhoffHasTheTractionsOfTheClosedForm) {
  const double nu = 0.3, g = kShear, S12 = g / (2 * (1 + nu)), S22 = g * g / 2 / (1 - nu * nu);
  std::optional<Block> block;
  const LawConstants law("saint-venant-kirchhoff", {{"young", 1}, {"poisson", nu}});
  verify_shear("saint-venant-kirchhoff, nu = 0.3", "E",
               stresses(law, simple_shear(g), kShearTractions, block), {S12 + g * S22, S22},
               "P = F S", 1e-8);
}

class Patch : public testing::TestWithParam<Dilatation> {};

/// An affine displacement of the faces of a cube of 3 x 3 x 3 distorted cells must be affine
/// inside.
TEST_P(Patch, AnAffineBoundaryGivesAnAffineInterior) {
  Body body = test::make_block(test::even(0, 1, 3), test::even(0, 1, 3), test::even(0, 1, 3));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-0.07, 0.07);
  body.fixed_nodes.clear();
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    Vec3& x = body.nodes[i];
    if (*std::min_element(x.begin(), x.end()) == 0 || *std::max_element(x.begin(), x.end()) == 1)
      body.fixed_nodes.push_back(static_cast<std::int32_t>(i));
    else
      x = x + Vec3{shift(random), shift(random), shift(random)};
  }
  const SolidModel model(body, {NeoHookean::from_young_poisson(1, 0.49, "block")}, GetParam());
  Eigen::Matrix3d F;
  F << 1.10, 0.20, -0.05, 0.00, 0.92, 0.10, 0.04, -0.03, 1.02;
  const Displacement affine = F * model.mesh().X - model.mesh().X;
  Displacement u = affine;
  for (int node = 0; node < model.mesh().nodes(); ++node)
    if (model.equation(node) >= 0)
      u.col(node) += 0.02 * Eigen::Vector3d(shift(random), shift(random), shift(random));
  test::equilibrate(model, test::Loads::Zero(3, model.mesh().nodes()), {}, u);
  test::verify(
      {"Patch test on a distorted mesh, finite strain, nu = 0.49",
       std::string("largest distance from the affine field over the edge, ") + name_of(GetParam()),
       "1", (u - affine).lpNorm<Eigen::Infinity>(), 0, test::Reference::ClosedForm, "affine field",
       1e-9, test::Error::Absolute});
}

INSTANTIATE_TEST_SUITE_P(Elements, Patch,
                         testing::Values(Dilatation::Mean, Dilatation::Nodal, Dilatation::Pointwise,
                                         Dilatation::LinearNodal));

}  // namespace
}  // namespace palpate::fem
