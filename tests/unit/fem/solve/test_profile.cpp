// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/profile.hpp"

#include <gtest/gtest.h>

#include <ctime>
#include <set>
#include <string>
#include <thread>

namespace palpate::fem {
namespace {

double thread_cpu() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Keeps the processor busy. @return seconds of it.
double work(double seconds) {
  const double start = thread_cpu();
  while (thread_cpu() - start < seconds) {
  }
  return thread_cpu() - start;
}

class Profiles : public testing::Test {
 protected:
  void SetUp() override { active_profile = &profile; }
  void TearDown() override { active_profile = nullptr; }

  Profile profile;
};

TEST_F(Profiles, CountAnInnerPartOnce) {
  const double start = thread_cpu();
  double outer = 0, inner = 0;
  {
    const PartTimer timer(Part::BodyPasses);
    outer += work(0.01);
    {
      const PartTimer nested(Part::Contact);
      inner += work(0.02);
    }
    outer += work(0.01);
  }
  const double all = thread_cpu() - start;
  const double counted = profile.seconds(Part::BodyPasses) + profile.seconds(Part::Contact);
  EXPECT_LE(counted, all);
  EXPECT_GE(profile.seconds(Part::Contact), inner);
  EXPECT_LE(profile.seconds(Part::Contact), all - outer);
  EXPECT_GE(profile.seconds(Part::BodyPasses), outer);
  EXPECT_LE(profile.seconds(Part::BodyPasses), all - inner);
  EXPECT_EQ(profile.seconds(Part::Vectors), 0);
}

TEST_F(Profiles, AddUpOverThreads) {
  const auto busy = [] {
    const PartTimer timer(Part::WindowFactor);
    work(0.01);
  };
  std::thread other(busy);
  busy();
  other.join();
  EXPECT_GE(profile.seconds(Part::WindowFactor), 0.02);
  EXPECT_EQ(profile.times(Part::WindowFactor), 2);
}

TEST_F(Profiles, AreNotTimedWithoutAProfile) {
  active_profile = nullptr;
  const PartTimer timer(Part::Contact);
  work(0.001);
  active_profile = &profile;  // a timer that did not start does not stop
  EXPECT_EQ(profile.seconds(Part::Contact), 0);
}

TEST_F(Profiles, NameEveryPartDifferently) {
  std::set<std::string> names;
  for (std::size_t p = 0; p < kParts; ++p) names.insert(name_of(static_cast<Part>(p)));
  EXPECT_EQ(names.size(), kParts);
  EXPECT_EQ(names.count(""), 0u);
}

}  // namespace
}  // namespace palpate::fem
