// SPDX-License-Identifier: AGPL-3.0-or-later
// Records of a synthetic testing machine, from files to curves.
#include "app/measured/import.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "format/error.hpp"
#include "format/sha256.hpp"
#include "tests/support/sample_artifacts.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/fitting/measurement/records/bench.hpp"

namespace palpate::app {
namespace {

using measured::Bench;
using testing::HasSubstr;

class Imports : public testing::Test {
 protected:
  /// The record of a machine that writes seconds, millimetres and newtons.
  void write_record(const std::string& name, const Bench& bench, unsigned seed) const {
    const measured::PressRecord record = measured::press_on(bench, seed);
    std::ofstream file(folder_ / name);
    file.precision(17);
    file << "t (s),x (mm),f (N)\n";
    for (std::size_t i = 0; i < record.time.size(); ++i)
      file << record.time[i] << ',' << 1e3 * record.displacement[i] << ',' << record.force[i]
           << '\n';
  }
  std::filesystem::path write_sidecar(const std::string& presses,
                                      const std::string& more = "") const {
    std::ofstream(folder_ / "bench.toml")
        << "name = \"bench\"\nspecimen = \"gel\"\nsource = \"synthetic\"\nlicence = \"CC0-1.0\"\n"
           "[tool]\nradius = \"5 mm\"\nfriction = \"frictionless\"\n[columns]\ntime = \"t\"\n"
           "displacement = \"x\"\nforce = \"f\"\n"
        << more << presses;
    return folder_ / "bench.toml";
  }
  static std::string press(const std::string& file, int vertex) {
    return "[[press]]\nfile = \"" + file + "\"\nvertex = " + std::to_string(vertex) + "\n";
  }
  std::string refusal(const std::filesystem::path& sidecar,
                      const std::filesystem::path& body = {}) const {
    try {
      import_measurement(sidecar, body);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      return error.what();
    }
    return "accepted";
  }

  const samples::TemporaryFolder folder_;
};

/// Frame, load cell and point of contact of the machine are taken out; what is left is the law of
/// the specimen.
TEST_F(Imports, GiveTheForceOfTheSpecimenAtItsDepth) {
  Bench bench;
  bench.compliance = 2e-4;
  write_record("a.csv", bench, 1);
  const Import result = import_measurement(
      write_sidecar(press("a.csv", 7), "[machine]\ncompliance = \"0.2 mm/N\"\n"), {});
  ASSERT_EQ(result.curves.sites.size(), 1u);
  const SiteCurves& site = result.curves.sites[0];
  EXPECT_EQ(site.vertex, 7);
  EXPECT_EQ(result.curves.body_sha256, "");
  ASSERT_EQ(site.paths.size(), 1u);  // no drag was recorded, and none was made up
  EXPECT_EQ(site.paths[0].direction, (Vec3{0, 0, -1}));
  const double deepest = measured::sneddon_force(bench.depth, bench.radius, bench.modulus);
  for (const CurveSample& sample : site.paths[0].samples)
    EXPECT_NEAR(-sample.force[2],
                measured::sneddon_force(sample.displacement, bench.radius, bench.modulus),
                0.02 * deepest);
  EXPECT_NEAR(result.curves.depth, bench.depth, 0.02 * bench.depth);
  const auto& record = result.account.at("records").at(0);
  EXPECT_NEAR(record.at("force_offset_N").get<double>(), bench.offset, 1e-3);
  EXPECT_NEAR(record.at("contact_m").get<double>(), bench.contact, 5e-5);
  EXPECT_NEAR(record.at("rate_m_per_s").get<double>(), bench.speed, 0.05 * bench.speed);
  EXPECT_NEAR(record.at("returned_fraction").get<double>(), bench.loss, 0.03);
  EXPECT_TRUE(result.account.at("warnings").empty());
}

/// A file in micrometres that is said to be in millimetres: the tool is a thousand times less deep.
TEST_F(Imports, SayWhereTheUnitsAreThoseOfNothingSoft) {
  Bench bench;
  bench.modulus *= 3e4;
  bench.noise *= 3e4;
  write_record("a.csv", bench, 1);
  const auto warnings =
      import_measurement(write_sidecar(press("a.csv", 7)), {}).account.at("warnings");
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings.at(0).get<std::string>(), HasSubstr("check the units of force"));
}

/// Three repeats have a smaller standard error than two, and a copy is no repeat.
TEST_F(Imports, RefuseACopyOfARecord) {
  write_record("a.csv", {}, 1);
  write_record("b.csv", {}, 2);
  std::filesystem::copy_file(folder_ / "a.csv", folder_ / "copy.csv");
  const auto refused = [&](const std::string& presses) {
    return import_measurement(write_sidecar(press("a.csv", 7) + presses), {}).account.at("refused");
  };
  EXPECT_TRUE(refused(press("b.csv", 7)).empty());
  EXPECT_TRUE(refused(press("copy.csv", 8)).empty());  // of another site
  ASSERT_EQ(refused(press("copy.csv", 7)).size(), 1U);
  EXPECT_THAT(refused(press("copy.csv", 7)).at(0).at("reason").get<std::string>(),
              HasSubstr("copy.csv: has the samples of another record"));
}

/// A machine that was told 20 mm and 80 mm^2, and divided by them.
TEST_F(Imports, UndoTheSizesByWhichAMachineMadeStrainAndStress) {
  const measured::PressRecord record = measured::press_on({}, 1);
  {
    std::ofstream file(folder_ / "a.csv"), converted(folder_ / "b.csv");
    file.precision(17);
    converted.precision(17);
    file << "t (s),x (mm),f (N)\n";
    converted << "t (s),strain (%),stress (kPa)\n";
    for (std::size_t i = 0; i < record.time.size(); ++i) {
      const double x = record.displacement[i], f = record.force[i];
      file << record.time[i] << ',' << 1e3 * x << ',' << f << '\n';
      converted << record.time[i] << ',' << -1e2 * x / 20e-3 << ',' << -1e-3 * f / 80e-6 << '\n';
    }
  }
  const Import plain = import_measurement(write_sidecar(press("a.csv", 0)), {});
  const auto write = [&](const std::string& columns, const std::string& machine) {
    std::ofstream(folder_ / "converted.toml")
        << "name = \"bench\"\nspecimen = \"gel\"\nsource = \"synthetic\"\nlicence = \"CC0-1.0\"\n"
           "[tool]\nradius = \"5 mm\"\nfriction = \"frictionless\"\n[columns]\ntime = \"t\"\n"
        << columns << "[machine]\n"
        << machine << press("b.csv", 0);
    return folder_ / "converted.toml";
  };
  const std::string columns = "strain = \"strain\"\nstress = \"stress\"\n";
  const std::string length = "gauge_length = \"20 mm\"\n", area = "area = \"80 mm^2\"\n";
  const Import result = import_measurement(write(columns, length + area), {});
  EXPECT_EQ(result.account.at("conversion"),
            "displacement = 'strain' x 20.0 mm, force = 'stress' x 80 mm^2");
  EXPECT_FALSE(plain.account.contains("conversion"));
  const auto &expected = plain.curves.sites[0].paths[0].samples,
             &found = result.curves.sites[0].paths[0].samples;
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].displacement, expected[i].displacement, 1e-9);
    EXPECT_NEAR(found[i].force[2], expected[i].force[2], 1e-7);
  }
  EXPECT_THAT(refusal(write(columns, length)), HasSubstr("needs the section of the specimen"));
  EXPECT_THAT(refusal(write(columns, area)), HasSubstr("a strain needs the length"));
  EXPECT_THAT(refusal(write("displacement = \"strain\"\nstress = \"stress\"\n", length + area)),
              HasSubstr("a gauge length is given, and no column is a strain"));
  EXPECT_THAT(refusal(write("strain = \"strain\"\nforce = \"stress\"\n", length + area)),
              HasSubstr("no column is a stress"));
  EXPECT_THAT(refusal(write(columns + "force = \"stress\"\n", length + area)),
              HasSubstr("both stress and force"));
  EXPECT_THAT(refusal(write(columns + "load = \"tension\"\n", length + area)),
              HasSubstr("palpate calibrate tests"));
}

/// A specimen that clings: the pull-off is stronger than the press, and is not taken for it.
TEST_F(Imports, TakeTheSignsThatAreStated) {
  const Bench bench;
  measured::PressRecord record = measured::press_on(bench, 1);
  const auto peak = static_cast<std::size_t>(
      std::max_element(record.force.begin(), record.force.end()) - record.force.begin());
  const double largest = record.force[peak];
  for (std::size_t i = 0; i < record.force.size(); ++i) {
    const double above = bench.contact - record.displacement[i];
    if (i > peak && above > 0 && above < 0.5e-3) record.force[i] -= 1.5 * largest;
  }
  {
    std::ofstream file(folder_ / "a.csv");
    file.precision(17);
    file << "t (s),x (mm),f (N)\n";
    for (std::size_t i = 0; i < record.time.size(); ++i)
      file << record.time[i] << ',' << 1e3 * record.displacement[i] << ',' << -record.force[i]
           << '\n';
  }
  const std::string threshold =
      "[contact]\nmethod = \"given\"\nposition = \"2.3 mm\"\nposition_uncertainty = \"10 um\"\n"
      "[baseline]\nmethod = \"zeroed\"\nuncertainty = \"200 mN\"\n";
  const Import result = import_measurement(
      write_sidecar(press("a.csv", 0),
                    "displacement_sign = \"as recorded\"\nforce_sign = \"reversed\"\n" + threshold),
      {});
  const CurveSample& end = result.curves.sites[0].paths[0].samples.back();
  EXPECT_NEAR(-end.force[2],
              measured::sneddon_force(end.displacement, bench.radius, bench.modulus) + bench.offset,
              0.02 * largest);
}

/// One record that is cut off does not take the others with it, and is named with its reason.
TEST_F(Imports, KeepTheRecordsThatAreGood) {
  write_record("a-1.csv", {}, 1);
  write_record("a-2.csv", {}, 2);
  write_record("a-3.csv", {}, 3);
  std::ofstream(folder_ / "a-2.csv") << "t (s),x (mm),f (N)\n0,0,0\n1,1,n/a\n";
  const auto sidecar = write_sidecar("[[press]]\nfiles = \"a-{n}.csv\"\nvertex_from = \"{n}\"\n");
  const Import result = import_measurement(sidecar, {});
  ASSERT_EQ(result.curves.sites.size(), 2u);
  EXPECT_EQ(result.curves.sites[1].vertex, 3);
  EXPECT_EQ(result.refused, 1);
  const auto& refused = result.account.at("refused").at(0);
  EXPECT_EQ(refused.at("file"), "a-2.csv");
  EXPECT_THAT(refused.at("reason").get<std::string>(), HasSubstr("a-2.csv"));
  const ProvenanceStep& step = result.curves.provenance.steps.back();
  EXPECT_EQ(step.inputs.size(), 3u);  // the sidecar and what was used
  // Only some of the records that it names, and one that it does not.
  std::ofstream(folder_ / "b.csv") << "t (s),x (mm),f (N)\n";
  const Import one = import_measurement(sidecar, {}, {folder_ / "a-3.csv", folder_ / "b.csv"});
  ASSERT_EQ(one.curves.sites.size(), 1u);
  EXPECT_EQ(one.curves.sites[0].vertex, 3);
  EXPECT_THAT(one.account.at("refused").at(0).at("reason").get<std::string>(),
              HasSubstr("does not name it"));
  // Where none is good the first reason is the error.
  std::ofstream(folder_ / "a-1.csv") << "";
  std::ofstream(folder_ / "a-3.csv") << "";
  EXPECT_THAT(refusal(sidecar), HasSubstr("a-1.csv: the file is empty"));
}

/// One path with the scatter between the presses: of two, their difference over sqrt 2.
TEST_F(Imports, MakeOnePathOfTheRepeatsOfASite) {
  Bench soft, stiff;
  stiff.modulus = 1.1 * soft.modulus;
  write_record("a.csv", soft, 1);
  write_record("b.csv", stiff, 2);
  write_record("c.csv", soft, 3);
  const Import result = import_measurement(
      write_sidecar(press("a.csv", 2) + press("b.csv", 2) + press("c.csv", 1)), {});
  ASSERT_EQ(result.curves.sites.size(), 2u);
  EXPECT_EQ(result.curves.sites[0].vertex, 1);
  const CurveSample& end = result.curves.sites[1].paths[0].samples.back();
  const double force = measured::sneddon_force(end.displacement, soft.radius, soft.modulus);
  EXPECT_NEAR(-end.force[2], 1.05 * force, 0.02 * force);
  EXPECT_NEAR(end.force_scatter, 0.1 * force / std::sqrt(2.0), 0.02 * force);
  EXPECT_TRUE(std::isnan(result.curves.sites[0].paths[0].samples.back().force_scatter));
}

TEST_F(Imports, CarryTheDigestsOfSidecarAndRecords) {
  write_record("a.csv", {}, 1);
  const auto sidecar = write_sidecar(press("a.csv", 0) + press("a.csv", 1));
  const Import result = import_measurement(sidecar, {});
  const ProvenanceStep& step = result.curves.provenance.steps.back();
  EXPECT_EQ(step.stage, "import");
  ASSERT_EQ(step.inputs.size(), 2u);  // a record that serves twice is one input
  EXPECT_EQ(step.inputs[0].sha256, sha256_of_file(sidecar));
  EXPECT_EQ(step.inputs[1].sha256, sha256_of_file(folder_ / "a.csv"));
}

TEST_F(Imports, AreRefusedWithTheRecordThatIsWrong) {
  write_record("a.csv", {}, 1);
  const auto body_file = folder_ / "body.h5";
  const Body body = samples::body(1);
  write_body(body_file, body);
  const auto vertices = static_cast<int>(body.response.node.size());
  EXPECT_THAT(refusal(write_sidecar(press("a.csv", vertices)), body_file),
              HasSubstr("vertex " + std::to_string(vertices) + " is not a site of the body"));
  EXPECT_THAT(refusal(write_sidecar(press("none.csv", 0))), HasSubstr("none.csv"));
  EXPECT_THAT(refusal(write_sidecar("[[press]]\nfile = \"a.csv\"\nsite = [\"1 mm\", \"1 mm\", "
                                    "\"1 mm\"]\n")),
              HasSubstr("add --body body.h5"));
}

/// A record that begins where the tool touches, the force set to zero there; the machine counts
/// downwards.
TEST_F(Imports, TakeTheContactPointAndTheZeroThatAreGiven) {
  Bench bench;
  bench.contact = bench.offset = 0;
  measured::PressRecord record = measured::press_on(bench, 4);
  {
    std::ofstream file(folder_ / "a.csv");
    file << "t (s),x (mm),f (N)\n";
    for (std::size_t i = 0; i < record.time.size(); ++i)
      file << record.time[i] << ',' << 12.5 - 1e3 * record.displacement[i] << ',' << record.force[i]
           << '\n';
  }
  EXPECT_THAT(refusal(write_sidecar(press("a.csv", 0),
                                    "[baseline]\nmethod = \"fit\"\n"
                                    "[contact]\nmethod = \"given\"\n"
                                    "position = \"12.5 mm\"\n")),
              HasSubstr("baseline.method = \"zeroed\""));
  const Import result = import_measurement(
      write_sidecar(press("a.csv", 0) + "contact = \"12.5 mm\"\n",
                    "[baseline]\nmethod = \"zeroed\"\nuncertainty = \"0.2 mN\"\n"
                    "[contact]\nmethod = \"given\"\nposition_uncertainty = \"5 um\"\n"),
      {});
  const CurvePath& path = result.curves.sites[0].paths[0];
  for (const CurveSample& sample : path.samples) {
    const double force = measured::sneddon_force(sample.displacement, bench.radius, bench.modulus);
    EXPECT_NEAR(-sample.force[2], force, 3.5 * sample.force_uncertainty + 1e-4);
  }
  EXPECT_DOUBLE_EQ(path.contact_uncertainty, 5e-6);
  EXPECT_EQ(result.account.at("records").at(0).at("force_offset_N"), 0.0);
}

/// What is given and not said how well it is known counts as exact, and a warning names it.
TEST_F(Imports, WarnOfUncertaintiesThatAreNotStated) {
  Bench bench;
  bench.contact = bench.offset = 0;
  write_record("a.csv", bench, 4);
  const auto warnings = [&](const std::string& position, const std::string& zero) {
    const Import result = import_measurement(
        write_sidecar(press("a.csv", 0), "[contact]\nmethod = \"given\"\nposition = \"0 mm\"\n" +
                                             position + "[baseline]\nmethod = \"zeroed\"\n" + zero),
        {});
    return result.account.at("warnings").get<std::vector<std::string>>();
  };
  EXPECT_THAT(
      warnings("", ""),
      testing::Contains(HasSubstr("give contact.position_uncertainty, baseline.uncertainty")));
  EXPECT_THAT(warnings("position_uncertainty = \"0 mm\"\n", "uncertainty = \"0 N\"\n"),
              testing::Not(testing::Contains(HasSubstr("not stated"))));
}

/// An approach of 1.5 s before 80 s of loading says nothing of drift.
TEST_F(Imports, WarnOfADriftThatTheRecordDoesNotExclude) {
  Bench bench;
  bench.noise = 0.005;
  bench.contact = 0.3e-3;
  bench.speed = 0.1e-3;
  bench.rate = 20;
  const measured::PressRecord whole = measured::press_on(bench, 1);
  std::ofstream file(folder_ / "a.csv");
  file << "t (s),x (mm),f (N)\n";
  for (std::size_t i = 0; i < whole.time.size() / 2; ++i)
    file << whole.time[i] << ',' << 1e3 * whole.displacement[i] << ',' << whole.force[i] << '\n';
  file.close();
  const Import result = import_measurement(write_sidecar(press("a.csv", 0)), {});
  const auto& record = result.account.at("records").at(0);
  EXPECT_EQ(record.at("drift"), "not determined");
  EXPECT_EQ(record.at("drift_N_per_s"), 0.0);
  ASSERT_EQ(result.account.at("warnings").size(), 1u);
  EXPECT_THAT(result.account.at("warnings").at(0).get<std::string>(),
              HasSubstr("do not exclude a drift of"));
}

/// A load cell of half the range: the curve is that of the whole record as far as it goes, and the
/// warning says where it ends and why.
TEST_F(Imports, EndAPressWhereTheLoadCellReachesItsLimit) {
  const Bench bench;
  write_record("whole.csv", bench, 1);
  const measured::PressRecord record = measured::press_on(bench, 1);
  const double limit = 0.5 * *std::max_element(record.force.begin(), record.force.end());
  double reached = 0;
  {
    std::ofstream file(folder_ / "clipped.csv");
    file.precision(17);
    file << "t (s),x (mm),f (N)\n";
    for (std::size_t i = 0; i < record.time.size(); ++i) {
      if (reached == 0 && record.force[i] >= limit) reached = record.time[i];
      file << record.time[i] << ',' << 1e3 * record.displacement[i] << ','
           << std::min(record.force[i], limit) << '\n';
    }
  }
  const Import whole = import_measurement(write_sidecar(press("whole.csv", 7)), {});
  EXPECT_TRUE(whole.account.at("records").at(0).at("saturation").is_null());
  const Import clipped = import_measurement(write_sidecar(press("clipped.csv", 7)), {});
  const auto& record_account = clipped.account.at("records").at(0);
  EXPECT_NEAR(record_account.at("saturation").at("from_s").get<double>(), reached, 1e-9);
  EXPECT_NEAR(record_account.at("saturation").at("reading_N").get<double>(), limit, 1e-9);
  EXPECT_TRUE(record_account.at("returned_fraction").is_null());
  ASSERT_EQ(clipped.account.at("warnings").size(), 1U);
  const auto warning = clipped.account.at("warnings").at(0).get<std::string>();
  for (const char* words : {"clipped.csv: from ", " s (samples ", "the force stays at exactly",
                            "the load cell is at its limit", "the curve ends before"})
    EXPECT_THAT(warning, HasSubstr(words));
  const auto& samples = clipped.curves.sites[0].paths[0].samples;
  const double depth = samples.back().displacement;
  EXPECT_LT(depth, 0.8 * whole.curves.depth);
  for (const CurveSample& sample : samples)
    EXPECT_NEAR(-sample.force[2],
                measured::sneddon_force(sample.displacement, bench.radius, bench.modulus), 0.01);
}

/// Metres that were written as millimetres: 4 m of depth for a tool of 5 mm.
TEST_F(Imports, WarnOfADepthThatLooksLikeAWrongUnit) {
  Bench bench;
  bench.radius = 5;
  bench.contact = 2.3, bench.depth = 4, bench.speed = 1;
  bench.modulus = 30e-3;
  write_record("a.csv", bench, 1);
  const Import result = import_measurement(write_sidecar(press("a.csv", 0)), {});
  ASSERT_EQ(result.account.at("warnings").size(), 1u);
  EXPECT_THAT(result.account.at("warnings").at(0).get<std::string>(),
              HasSubstr("its radius is 5.00 mm: check the units"));
}

/// The whole record beside its loading branch, which is the same with and without it.
TEST_F(Imports, KeepRecordsOverTimeBesideTheirLoadingBranch) {
  Bench bench;
  bench.hold = 12;
  write_record("a.csv", bench, 1);
  const Import alone = import_measurement(write_sidecar(press("a.csv", 7)), {});
  const Import both = import_measurement(
      write_sidecar(press("a.csv", 7) + "[[history]]\nfile = \"a.csv\"\nvertex = 7\n"), {});
  ASSERT_EQ(both.histories.records.size(), 1u);
  EXPECT_EQ(both.histories.records[0].vertex, 7);
  EXPECT_EQ(both.histories.specimen, "gel");
  EXPECT_EQ(both.histories.tool.radius, 5e-3);
  const measured::History& history = both.histories.records[0].history;
  EXPECT_EQ(history.time.size(), measured::press_on(bench, 1).time.size());
  EXPECT_TRUE(alone.histories.records.empty());
  const auto &a = alone.curves.sites[0].paths[0].samples,
             &b = both.curves.sites[0].paths[0].samples;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].displacement, b[i].displacement);
    EXPECT_EQ(a[i].force, b[i].force);
  }
  // A history alone makes no curve.
  EXPECT_TRUE(import_measurement(write_sidecar("[[history]]\nfile = \"a.csv\"\n"), {})
                  .curves.sites.empty());
}

/// A specimen between grips: the pull is the history of the press with both signs turned.
TEST_F(Imports, TakeHistoriesOfSpecimensInTension) {
  Bench bench;
  bench.hold = 12;
  write_record("a.csv", bench, 1);
  measured::PressRecord pulled = measured::press_on(bench, 1);
  std::ofstream file(folder_ / "b.csv");
  file.precision(17);
  file << "t (s),x (mm),f (N)\n";
  for (std::size_t i = 0; i < pulled.time.size(); ++i)
    file << pulled.time[i] << ',' << -1e3 * pulled.displacement[i] << ',' << -pulled.force[i]
         << '\n';
  file.close();
  const auto imported = [&](const std::string& record, const std::string& load) {
    std::ofstream(folder_ / "grips.toml")
        << "name = \"grips\"\nspecimen = \"gel\"\nsource = \"synthetic\"\n"
           "licence = \"CC0-1.0\"\n[tool]\nshape = \"plates\"\n[columns]\ntime = \"t\"\n"
           "displacement = \"x\"\nforce = \"f\"\nload = \""
        << load << "\"\n[[history]]\nfile = \"" << record << "\"\n";
    return import_measurement(folder_ / "grips.toml", {}).histories.records.at(0).history;
  };
  const measured::History press = imported("a.csv", "compression"),
                          pull = imported("b.csv", "tension");
  ASSERT_EQ(pull.time.size(), press.time.size());
  EXPECT_GT(*std::max_element(pull.force.begin(), pull.force.end()), 0);
  for (std::size_t i = 0; i < pull.time.size(); ++i) {
    EXPECT_NEAR(pull.travel[i], press.travel[i], 1e-12);
    EXPECT_NEAR(pull.force[i], press.force[i], 1e-12);
  }
}

/// A series needs no site: the records of a sidecar are read without the body.
TEST_F(Imports, ReadRecordsOverTimeWithoutTheirSites) {
  Bench bench;
  bench.hold = 12;
  write_record("a.csv", bench, 1);
  const auto sidecar =
      write_sidecar("[[history]]\nfile = \"a.csv\"\nsite = [\"0 mm\", \"0 mm\", \"0 mm\"]\n");
  EXPECT_THAT(refusal(sidecar), HasSubstr("needs a body"));
  const Histories histories = import_histories(sidecar);
  ASSERT_EQ(histories.records.size(), 1u);
  EXPECT_EQ(histories.records[0].vertex, -1);
}

TEST_F(Imports, TakeTheDeclaredPhasesOfARecordOverTime) {
  Bench bench;
  bench.hold = 12;
  write_record("a.csv", bench, 1);
  const std::string history =
      "[[history]]\nfile = \"a.csv\"\nheld = \"travel\"\nphases = [{ kind = \"ramp\", from = "
      "\"2.3 s\", to = \"6.3 s\" }, { kind = \"hold\", from = \"6.3 s\", to = \"18 s\" }]\n";
  const Import import = import_measurement(write_sidecar(history), {});
  ASSERT_EQ(import.histories.records[0].history.phases.size(), 2u);
  EXPECT_EQ(import.histories.records[0].vertex, -1);
  EXPECT_THAT(refusal(write_sidecar("[[history]]\nfile = \"a.csv\"\nphases = [{ kind = \"pause\", "
                                    "from = \"1 s\", to = \"2 s\" }]\n")),
              HasSubstr("pause"));
}

TEST_F(Imports, RefuseRecordsOverTimeWithATimeThatStandsStill) {
  Bench bench;
  bench.hold = 12;
  write_record("a.csv", bench, 1);
  std::ofstream(folder_ / "b.csv") << "t (s),x (mm),f (N)\n0,0,0\n0.1,0.1,0\n0.1,0.2,0.1\n0.2,0.3,"
                                      "0.2\n0.3,0.4,0.3\n";
  EXPECT_THAT(refusal(write_sidecar("[[history]]\nfile = \"b.csv\"\n")),
              HasSubstr("does not increase at sample 3"));
  EXPECT_THAT(refusal(write_sidecar("[[history]]\nfile = \"a.csv\"\nvertex = 1\nsite = [\"0 mm\", "
                                    "\"0 mm\", \"0 mm\"]\n")),
              HasSubstr("both vertex and site"));
}

}  // namespace
}  // namespace palpate::app
