// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/search_thread.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include "runtime/handles.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

TEST(LatestReport, IsNeverTorn) {
  runtime::LatestReport latest;
  std::atomic<bool> done = false;
  std::thread writer([&] {
    for (int k = 1; k <= 200000; ++k) {
      const double v = k;
      latest.write({{v, v, v}, k});
    }
    done = true;
  });
  int read = 0;
  std::int32_t newest = 0;
  runtime::TipReport report;
  bool last = false;
  while (!last) {
    last = done;
    if (!latest.read(report)) continue;
    ++read;
    EXPECT_EQ(report.position[0], report.position[2]);
    EXPECT_EQ(report.position[0], report.element);
    EXPECT_GT(report.element, newest);
    newest = report.element;
  }
  writer.join();
  EXPECT_EQ(newest, 200000);
  EXPECT_GT(read, 0);
}

TEST(LatestReport, IsReadOnceAfterEachWrite) {
  runtime::LatestReport latest;
  runtime::TipReport report;
  EXPECT_FALSE(latest.read(report));
  for (std::int32_t k = 1; k <= 5; ++k) {
    latest.write({{0.1 * k, 0, 0}, k});
    ASSERT_TRUE(latest.read(report)) << k;
    EXPECT_EQ(report.element, k);
    EXPECT_FALSE(latest.read(report));
  }
}

TEST(SearchThread, DeliversTheTrianglesOfASlideToAForceLoop) {
  // The real thread, at the pace of this machine. On equal springs the force after the slide does
  // not depend on when the triangles came: g(z), and mu g(z) against the motion.
  const palpate_library body(plate(20, 0.1, [](const Vec3&) { return wall_response(170, 170); }));
  palpate_state state(body, {0.2, 5e-3}, 1000);
  const auto wait = [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
  const auto stay_at = [&](const Vec3& x, std::uint32_t until, std::uint32_t without) {
    for (int i = 0; i < 5000; ++i) {
      const std::uint32_t status = state.step(x, 1e-3);
      if ((status & until) == until && !(status & without)) return;
      wait();
    }
    ADD_FAILURE() << "the triangles never came";
  };
  for (int i = 0; i < 100; ++i) {  // until the first delivery
    state.step({0.02, 0.05, 0.0005}, 1e-3);
    if (!state.delivery().elements().empty()) break;
    wait();
  }
  stay_at({0.02, 0.05, -0.0001}, PALPATE_CONTACT, 0);
  const double offset = state.contact.observation().offset;
  for (int i = 0; i <= 40; ++i) state.step({0.02, 0.05, -1e-4 * i}, 1e-3);
  for (int i = 1; i <= 400; ++i) {
    state.step({0.02 + 1e-4 * i, 0.05, -0.004}, 1e-3);
    if (i % 20 == 0) wait();
  }
  stay_at({0.06, 0.05, -0.004}, PALPATE_CONTACT, PALPATE_AWAITING);
  const double z = 0.004 - offset;
  const double g = 100 * 170 * z * z;
  EXPECT_NEAR(-state.contact.observation().force[2], g, 1e-6);
  EXPECT_NEAR(state.contact.observation().force[0], 0.2 * g, 1e-6);
}

}  // namespace
}  // namespace palpate::test
