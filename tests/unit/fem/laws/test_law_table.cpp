// SPDX-License-Identifier: AGPL-3.0-or-later
// What the table of laws refuses: constants outside their ranges, by name, value and range.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/laws/law.hpp"
#include "fem/laws/law_table.hpp"
#include "format/error.hpp"
#include "tests/support/sample_laws.hpp"

namespace palpate::fem {
namespace {

using testing::HasSubstr;

constexpr double kPoisson = 0.45;

std::string refusal(const LawConstants& constants) {
  try {
    make_law(constants, "liver");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    return error.what();
  }
  return "accepted";
}

class EveryEntry : public testing::TestWithParam<LawConstants> {};

TEST_P(EveryEntry, RefusesEachConstantOutsideItsRangeByNameValueAndRange) {
  EXPECT_EQ(refusal(GetParam()), "accepted");
  for (const LawConstant& constant : law_entry(GetParam().law).constants) {
    const std::string name(constant.name);
    const auto with = [&](double value) {
      LawConstants changed = GetParam();
      changed.at(name) = value;
      return refusal(changed);
    };
    for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL})
      EXPECT_THAT(with(value), testing::AllOf(HasSubstr("liver"), HasSubstr(name + " = ")));
    const auto expect_refused = [&](double value) {
      std::ostringstream shown;
      shown << name << " = " << value;
      EXPECT_THAT(with(value), testing::AllOf(HasSubstr("liver"), HasSubstr(shown.str()),
                                              HasSubstr("out of range"), HasSubstr("with ")));
    };
    if (std::isfinite(constant.low)) {
      expect_refused(constant.low - 1);
      if (constant.low_open) expect_refused(constant.low);
    }
    if (std::isfinite(constant.high)) {
      expect_refused(constant.high + 1);
      if (constant.high_open) expect_refused(constant.high);
    }
    LawConstants without = GetParam();
    std::erase_if(without.values, [&](const auto& v) { return v.first == name; });
    EXPECT_THAT(refusal(without), HasSubstr(name + " is missing"));
  }
  LawConstants more = GetParam();
  more.values.emplace_back("gamma", 1.0);
  EXPECT_THAT(refusal(more), HasSubstr("no constant gamma"));
}

INSTANTIATE_TEST_SUITE_P(Table, EveryEntry, testing::ValuesIn(test::sample_laws(kPoisson)),
                         [](const auto& instance) {
                           std::string name = instance.param.law;
                           std::erase(name, '-');
                           return name;
                         });

TEST(LawTable, SamplesCoverIt) {
  const auto samples = test::sample_laws(kPoisson);
  ASSERT_EQ(samples.size(), law_table().size());
  for (std::size_t i = 0; i < samples.size(); ++i) EXPECT_EQ(samples[i].law, law_table()[i].name);
}

TEST(LawTable, RefusesConstantsThatDoNotFitTogether) {
  EXPECT_THAT(refusal({"mooney-rivlin", {{"C10", 1}, {"C01", -3}, {"poisson", 0.4}}}),
              HasSubstr("C10 + C01 = -2"));
  EXPECT_THAT(refusal({"ogden-1", {{"mu_1", -1}, {"alpha_1", 2}, {"poisson", 0.4}}}),
              HasSubstr("sum of mu_i = -1"));
  EXPECT_THAT(refusal({"ogden-1", {{"mu_1", 1}, {"alpha_1", 0}, {"poisson", 0.4}}}),
              HasSubstr("alpha_1 = 0"));
  EXPECT_THAT(refusal({"hooke", {}}), HasSubstr("use one of neo-hookean"));
}

}  // namespace
}  // namespace palpate::fem
