// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/laws/relaxation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "format/error.hpp"
#include "tests/unit/fem/laws/law_samples.hpp"

namespace palpate::fem {
namespace {

/// Isochoric and volumetric energy densities of a law at a deformation with a change of volume.
std::pair<double, double> energies(const LawConstants& constants) {
  constexpr std::array<double, 9> values{1.2, 0.1, 0, -0.05, 0.9, 0.2, 0.02, 0, 1.05};
  const Law law = make_law(constants, "tissue");
  Tensor2<Lanes> F;
  for (std::size_t i = 0; i < 9; ++i) F[i] = Lanes::Constant(values[i]);
  Fibres<Lanes> fibres;
  const std::array<Vec3, 2> directions = law.fibres_at({});
  for (std::size_t family = 0; family < fibres.size(); ++family)
    for (std::size_t j = 0; j < 3; ++j) fibres[family][j] = Lanes::Constant(directions[family][j]);
  const Lanes J = determinant(F, cofactor(F));
  return {law.psi(F, J, fibres)[0], law.volumetric_energy(J)[0]};
}

TEST(RelaxationOfLaw, ScalesTheIsochoricEnergyAloneOfEveryLaw) {
  for (const LawConstants& sample : test::sample_laws(kPoisson)) {
    if (!has_isochoric_part(sample.law)) continue;
    for (const double factor : {0.4, 1.6}) {
      const auto [isochoric, volumetric] = energies(sample);
      const auto scaled = energies(with_isochoric_scaled(sample, factor, "tissue"));
      EXPECT_NEAR(scaled.first, factor * isochoric, 1e-12 * isochoric) << sample.law;
      EXPECT_NEAR(scaled.second, volumetric, 1e-12 * volumetric) << sample.law;
    }
  }
}

TEST(RelaxationOfLaw, InstantaneousModuliFollowFromThoseOfTheLongTerm) {
  const RelaxationSeries series{{0.3, 0.1}, {0.2, 1}};
  const LawConstants law(10e3, 0.45);
  const double mu = 10e3 / 2.9, K = 10e3 / 0.3;
  const LawConstants at_once = instantaneous_law(law, series, Moduli::LongTerm, "t");
  EXPECT_NEAR(at_once.at("young"), 9 * K * 2 * mu / (3 * K + 2 * mu), 1e-8);
  EXPECT_NEAR(at_once.at("poisson"), (3 * K - 4 * mu) / (6 * K + 4 * mu), 1e-14);
  EXPECT_EQ(instantaneous_law(law, series, Moduli::Instantaneous, "t").values, law.values);
  EXPECT_EQ(instantaneous_law(law, {}, Moduli::LongTerm, "t").values, law.values);
}

TEST(RelaxationOfLaw, RefusesALawWithoutIsochoricPartAndABulkModulusThatIsTooSmall) {
  const auto message = [](const LawConstants& law, const RelaxationSeries& series, Moduli moduli) {
    try {
      instantaneous_law(law, series, moduli, "region 'liver'");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      return std::string(error.what());
    }
    return std::string();
  };
  using ::testing::HasSubstr;
  const RelaxationSeries series{{0.9, 1}};
  const LawConstants unsplit{"saint-venant-kirchhoff", {{"young", 1e3}, {"poisson", 0.3}}};
  EXPECT_THAT(message(unsplit, series, Moduli::Instantaneous), HasSubstr("no isochoric part"));
  EXPECT_THAT(message(LawConstants(1e3, 0.3), series, Moduli::LongTerm),
              HasSubstr("Poisson's ratio -0."));
  EXPECT_EQ(message(LawConstants(1e3, 0.3), series, Moduli::Instantaneous), "");
}

}  // namespace
}  // namespace palpate::fem
