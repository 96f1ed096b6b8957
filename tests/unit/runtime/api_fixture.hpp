// SPDX-License-Identifier: AGPL-3.0-or-later
// A state of the C interface on a plate, from a file.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"

namespace palpate::test {

inline constexpr double kStiffness = 170;
inline constexpr double kDt = 5e-4;

class PalpateApi : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() / ("palpate_api_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / "library.h5").string();
    write_library(path_,
                  plate(8, 0.08, [](const Vec3&) { return wall_response(kStiffness, 120); }));
    ASSERT_EQ(palpate_library_load(path_.c_str(), &library_), PALPATE_OK) << palpate_last_error();
    palpate_settings_default(&settings_);
    settings_.friction = 0.3;
    ASSERT_EQ(palpate_state_create(library_, &settings_, &state_), PALPATE_OK);
  }
  void TearDown() override {
    palpate_state_destroy(state_);
    palpate_library_destroy(library_);
    std::filesystem::remove_all(folder_);
  }

  std::uint32_t step(const Vec3& x) {
    const double velocity[3] = {0, 0, 0};
    return palpate_step(state_, x.data(), velocity, kDt, force_.data());
  }
  palpate_observation observe() const {
    palpate_observation o{};
    o.size = sizeof o;
    EXPECT_EQ(palpate_observe(state_, &o), PALPATE_OK);
    return o;
  }

  std::filesystem::path folder_;
  std::string path_;
  palpate_library* library_ = nullptr;
  palpate_state* state_ = nullptr;
  palpate_settings settings_{};
  Vec3 force_{};
};

}  // namespace palpate::test
