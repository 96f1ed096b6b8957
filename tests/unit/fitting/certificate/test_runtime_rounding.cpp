// SPDX-License-Identifier: AGPL-3.0-or-later
// What the offline side computes with the inline functions of the runtime is what the runtime
// computes, to the bit: a bound of the force is one of the forces that are rendered.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <random>

#include "tests/support/bodies.hpp"
#include "tests/unit/fitting/certificate/evaluation.hpp"

namespace palpate::test {
namespace {

std::vector<Evaluated> states(const runtime::Surface& surface, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0, 1), across(-0.004, 0.004), into(0, 0.008);
  std::vector<Evaluated> all;
  for (int i = 0; i < 200; ++i) {
    const double a = part(random), b = part(random) * (1 - a);
    Evaluated state;
    state.point.element =
        static_cast<std::int32_t>(random() % static_cast<unsigned>(surface.element_count()));
    state.point.natural = {a, b, 1 - a - b};
    const Vec3 c = surface.position(state.point), n = surface.normal(state.point);
    for (int tip = 0; tip < 10; ++tip)
      state.tips.push_back(c + into(random) * n +
                           Vec3{across(random), across(random), across(random)});
    all.push_back(state);
  }
  return all;
}

class RuntimeRounding : public testing::TestWithParam<bool> {};

TEST_P(RuntimeRounding, IsTheSameOnBothSides) {
  const Library plain = bumpy_sphere(2, 0.04, 0.1, uneven);
  const runtime::Surface surface(GetParam() ? coupled(plain) : plain);
  const auto points = states(surface, 1);
  const auto here = evaluated_offline(surface, points);
  const auto there = evaluated_by_the_runtime(surface, points);
  ASSERT_EQ(here.size(), there.size());
  int different = 0;
  for (std::size_t i = 0; i < here.size(); ++i)
    different += std::bit_cast<std::uint64_t>(here[i]) != std::bit_cast<std::uint64_t>(there[i]);
  EXPECT_EQ(different, 0) << "of " << here.size();
}

INSTANTIATE_TEST_SUITE_P(Responses, RuntimeRounding, testing::Bool(), [](const auto& instance) {
  return instance.param ? "Coupled" : "Decoupled";
});

}  // namespace
}  // namespace palpate::test
