// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/unit/mesher/refusals.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesher/mesher.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher::test {

Settings settings_for(const std::filesystem::path& path, double unit) {
  Settings s;
  s.surface = {path, unit, "", {RepairMode::None}};
  s.supports = {PlaneSupport{{0, 0, 1e-3}, {0, 0, -1}}};
  s.patch_spacing = 0.010;
  s.element_size = 0.010;
  return s;
}

void expect_refused(const Settings& settings, const std::string& where, const std::string& problem,
                    const std::string& remedy, ErrorKind kind) {
  try {
    mesh(settings);
    FAIL() << "accepted, expected: " << problem;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_THAT(error.where(), testing::HasSubstr(where));
    EXPECT_THAT(error.problem(), testing::HasSubstr(problem));
    EXPECT_THAT(error.remedy(), testing::HasSubstr(remedy));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

void expect_file_refused(const std::string& name, const std::string& content,
                         const std::string& problem, const std::string& remedy) {
  const TemporaryFile file(name, content);
  expect_refused(settings_for(file.path()), name, problem, remedy);
}

Surface cube() {
  return box({0, 0, 0}, {0.05, 0.05, 0.05});
}

}  // namespace palpate::mesher::test
