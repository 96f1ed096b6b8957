// SPDX-License-Identifier: AGPL-3.0-or-later
// Numbers as a spreadsheet reads them are those of the artifact, to the bit.
#include "app/export/csv.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/support/sample_artifacts.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/app/csv_rows.hpp"

namespace palpate::app {
namespace {

double number(const test::CsvRow& row, const std::string& name) {
  return std::strtod(row.at(name).c_str(), nullptr);
}

/// NaN stands for what is unknown.
void expect_same(double found, double expected) {
  if (std::isnan(expected))
    EXPECT_TRUE(std::isnan(found));
  else
    EXPECT_EQ(found, expected);
}

TEST(CurvesCsv, ReadsBackExactly) {
  const Curves curves = samples::curves(2);
  const auto rows = test::csv_rows(curves_csv(curves));
  std::size_t row = 0;
  for (const SiteCurves& site : curves.sites)
    for (const CurvePath& path : site.paths)
      for (const CurveSample& sample : path.samples) {
        ASSERT_LT(row, rows.size());
        const test::CsvRow& found = rows[row++];
        EXPECT_EQ(found.at("vertex"), std::to_string(site.vertex));
        EXPECT_EQ(found.at("kind"), path.kind == PathKind::Normal ? "normal" : "lateral");
        expect_same(number(found, "displacement_m"), sample.displacement);
        expect_same(number(found, "force_y_N"), sample.force[1]);
        expect_same(number(found, "direction_z"), path.direction[2]);
        expect_same(number(found, "tool_work_J"), sample.tool_work);
        expect_same(number(found, "force_scatter_N"), sample.force_scatter);
        expect_same(number(found, "tension_N"), sample.tension);
        expect_same(number(found, "facets_in_contact"), sample.facets_in_contact);
        expect_same(number(found, "mesh_difference_N"), sample.mesh_difference);
        expect_same(number(found, "mesh_error_N"), sample.mesh_error);
      }
  EXPECT_EQ(row, rows.size());
  EXPECT_GT(row, 100u);
}

TEST(RecordingCsv, HasEveryStep) {
  const samples::TemporaryFolder folder;
  const Recording recording = samples::recording(2);
  write_recording(folder / "recording.h5", recording);
  RecordingReader reader(folder / "recording.h5");
  write_recording_csv(reader, folder / "steps.csv");
  std::ostringstream text;
  text << std::ifstream(folder / "steps.csv").rdbuf();
  const auto rows = test::csv_rows(text.str());
  ASSERT_EQ(rows.size(), recording.steps.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RecordedStep& step = recording.steps[i];
    EXPECT_EQ(rows[i].at("time_ns"), std::to_string(step.time_ns));
    EXPECT_EQ(rows[i].at("status"), std::to_string(step.status));
    expect_same(number(rows[i], "position_x_m"), step.position[0]);
    expect_same(number(rows[i], "contact_z_m"), step.contact_point[2]);
    expect_same(number(rows[i], "absorbed_J"), step.absorbed);
  }
}

}  // namespace
}  // namespace palpate::app
