// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/delivery.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace palpate::test {
namespace {

using runtime::Delivery;

TEST(Delivery, IsEmptyAtFirst) {
  const Delivery delivery;
  EXPECT_TRUE(delivery.elements().empty());
  EXPECT_FALSE(delivery.holds(0));
  EXPECT_EQ(delivery.entry.element, runtime::kNoElement);
}

TEST(Delivery, HoldsTheAssignedTrianglesInAnyOrder) {
  Delivery delivery;
  const std::vector<std::int32_t> elements{7, 3, 100, 0};
  delivery.assign(elements);
  for (const std::int32_t m : elements) EXPECT_TRUE(delivery.holds(m));
  EXPECT_FALSE(delivery.holds(1));
  EXPECT_FALSE(delivery.holds(101));
  EXPECT_TRUE(std::is_sorted(delivery.elements().begin(), delivery.elements().end()));
}

TEST(Delivery, ReplacesThePreviousTriangles) {
  Delivery delivery;
  delivery.assign(std::vector<std::int32_t>{1, 2, 3});
  delivery.assign(std::vector<std::int32_t>{4});
  EXPECT_EQ(delivery.elements().size(), 1U);
  EXPECT_FALSE(delivery.holds(2));
}

TEST(Delivery, TakesTheFirstTrianglesWhenThereAreTooMany) {
  std::vector<std::int32_t> elements(Delivery::kMost + 10);
  std::iota(elements.rbegin(), elements.rend(), 0);  // descending
  Delivery delivery;
  delivery.assign(elements);
  EXPECT_EQ(delivery.elements().size(), Delivery::kMost);
  EXPECT_TRUE(delivery.holds(elements.front()));
  EXPECT_FALSE(delivery.holds(elements.back()));
}

}  // namespace
}  // namespace palpate::test
