// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(ImportRequest, FindsTheSidecarBesideTheRecords) {
  const samples::TemporaryFolder folder;
  for (const char* name : {"a.csv", "b.csv"}) std::ofstream(folder / name) << "x\n";
  const std::string pattern = (folder / "*.csv").string();
  const auto refusal = [&](const std::vector<std::string>& inputs) -> std::string {
    try {
      import_request(inputs);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal({pattern}), HasSubstr("none lies beside it"));
  std::ofstream(folder / "case.toml") << "[tool]\n";  // no sidecar
  EXPECT_THAT(refusal({pattern}), HasSubstr("none lies beside it"));
  std::ofstream(folder / "one.toml") << "[columns]\n";
  const ImportRequest request = import_request({pattern});
  EXPECT_EQ(request.sidecar, folder / "one.toml");
  EXPECT_THAT(request.records, ElementsAre(folder / "a.csv", folder / "b.csv"));
  std::ofstream(folder / "two.toml") << "[columns]\n";
  EXPECT_THAT(refusal({pattern}), HasSubstr("several sidecars lie beside it: one.toml, two.toml"));
  const std::string two = (folder / "two.toml").string();
  EXPECT_EQ(import_request({two, pattern}).sidecar, two);
  EXPECT_TRUE(import_request({two}).records.empty());
  EXPECT_THAT(refusal({two, (folder / "one.toml").string()}), HasSubstr("two sidecars"));
  EXPECT_THAT(refusal({(folder / "*.dat").string()}), HasSubstr("no file matches"));
}

}  // namespace
}  // namespace palpate::app
