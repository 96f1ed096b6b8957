// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/fit_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

constexpr const char* kTest =
    "[[test]]\nfile = \"table.csv\"\nmode = \"uniaxial\"\ndeformation = \"stretch\"\n"
    "stress = \"stress\"\n";

class FitFiles : public testing::Test {
 protected:
  FitFile read(const std::string& fit, const std::string& test = kTest) const {
    std::ofstream(folder_ / "table.csv")
        << "stretch (1),stress (kPa)\n1.1,1\n1.2,2\n1.3,3\n1.4,4\n";
    std::ofstream(folder_ / "fit.toml") << "name = \"a\"\nsource = \"b\"\nlicence = \"c\"\n[fit]\n"
                                        << fit << test;
    return read_fit_file(folder_ / "fit.toml");
  }
  std::string refusal(const std::string& fit, const std::string& test = kTest) const {
    try {
      read(fit, test);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }

  samples::TemporaryFolder folder_;
};

TEST_F(FitFiles, HaveTheirRecordsInSi) {
  const FitFile fit = read("law = \"yeoh\"\npoisson = 0.45\n");
  EXPECT_EQ(fit.settings.law, "yeoh");
  EXPECT_EQ(fit.settings.poisson, 0.45);
  ASSERT_EQ(fit.tests.size(), 1U);
  EXPECT_THAT(fit.tests[0].deformation, testing::ElementsAre(1.1, 1.2, 1.3, 1.4));
  EXPECT_THAT(fit.tests[0].nominal, testing::ElementsAre(1e3, 2e3, 3e3, 4e3));
  EXPECT_EQ(read("law = \"yeoh\"\n").settings.poisson, calibrate::kCasePoisson);
}

TEST_F(FitFiles, ConstantsAreThoseOfTheCases) {
  const auto constant = [](const char* name) {
    return "law = \"ogden-1\"\n[[constant]]\nname = \"" + std::string(name) +
           "\"\nstart = \"2 kPa\"\nlow = \"1 kPa\"\nhigh = \"none\"\n";
  };
  const FitFile fit = read(constant("mu_1"));
  ASSERT_EQ(fit.settings.constants.size(), 1U);
  EXPECT_EQ(fit.settings.constants[0].start, 2e3);
  EXPECT_EQ(fit.settings.constants[0].low, 1e3);
  EXPECT_THAT(refusal(constant("mu")), HasSubstr("its constants are mu_1, alpha_1"));
}

TEST_F(FitFiles, OfLawsThatCannotBeCalibratedAreRefused) {
  EXPECT_THAT(refusal("law = \"yeoh\"\n", ""),
              HasSubstr("key 'test' is missing; add it: [[test]], a record"));
  EXPECT_THAT(refusal("law = \"hooke\"\n"), HasSubstr("hooke"));
  for (const char* law : {"saint-venant-kirchhoff", "holzapfel-gasser-ogden"})
    EXPECT_THAT(refusal("law = \"" + std::string(law) + "\"\n"),
                HasSubstr("homogeneous tests cannot calibrate it"));
}

TEST_F(FitFiles, RefuseColumnsThatAreNotClear) {
  const std::string test = "[[test]]\nfile = \"table.csv\"\nmode = \"uniaxial\"\n";
  EXPECT_THAT(refusal("law = \"yeoh\"\n", test), HasSubstr("the columns are not clear"));
  EXPECT_THAT(refusal("law = \"yeoh\"\n", test + "displacement = \"stretch\"\nforce = \"stress\"\n"
                                                 "gauge_length = \"1 cm\"\n"),
              HasSubstr("a force needs the section of the specimen"));
}

}  // namespace
}  // namespace palpate::app
