// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/site_journal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <set>

#include "format/error.hpp"
#include "format/site_record.hpp"
#include "tests/support/sample_artifacts.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kKey(64, 'a');

class SiteJournalTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("palpate-journal-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    path_ = folder_ / "curves.journal";
    take_sites();
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A few: every record is put on the disk by itself.
  void take_sites() {
    sites_ = samples::curves(3).sites;
    sites_.resize(3);
  }
  const std::vector<SiteCurves>& sites() const { return sites_; }

  /// Around every boundary of the file, and now and then between.
  static std::vector<std::uintmax_t> lengths_to_try(const std::vector<std::uintmax_t>& boundaries) {
    std::set<std::uintmax_t> lengths{0, 1, 17, 18, 19, 82, 83};
    for (const std::uintmax_t at : boundaries)
      for (std::uintmax_t length = at - 3; length <= at + 3; ++length)
        lengths.insert(std::min(length, boundaries.back()));
    for (std::uintmax_t length = 0; length < boundaries.back(); length += 397)
      lengths.insert(length);
    return {lengths.begin(), lengths.end()};
  }

  /// A journal with all sample sites, and the size of the file after each of them.
  std::vector<std::uintmax_t> write_all() {
    SiteJournal journal(path_, heading());
    std::vector<std::uintmax_t> sizes{fs::file_size(path_)};
    for (const SiteCurves& site : sites()) {
      journal.append(site);
      sizes.push_back(fs::file_size(path_));
    }
    return sizes;
  }
  JournalHeading heading() const { return {kKey, static_cast<std::int64_t>(sites().size())}; }

  fs::path folder_, path_;
  std::vector<SiteCurves> sites_;
};

TEST_F(SiteJournalTest, GivesBackTheBitsOfEverySite) {
  write_all();
  const SiteJournal again(path_, heading());
  ASSERT_EQ(again.found().size(), sites().size());
  for (std::size_t i = 0; i < sites().size(); ++i)
    EXPECT_EQ(site_bytes(again.found()[i]), site_bytes(sites()[i]));
  EXPECT_EQ(again.dropped_bytes(), 0U);
}

TEST_F(SiteJournalTest, CutAnywhereItKeepsTheWholeRecordsAndGoesOn) {
  const auto sizes = write_all();
  const fs::path cut = folder_ / "cut.journal";
  for (const std::uintmax_t length : lengths_to_try(sizes)) {
    fs::copy_file(path_, cut, fs::copy_options::overwrite_existing);
    fs::resize_file(cut, length);
    std::size_t whole = 0;
    while (whole + 1 < sizes.size() && sizes[whole + 1] <= length) ++whole;
    {
      SiteJournal journal(cut, heading());
      ASSERT_EQ(journal.found().size(), length < sizes[0] ? 0 : whole) << length;
      for (std::size_t i = journal.found().size(); i < sites().size(); ++i)
        journal.append(sites()[i]);
    }
    ASSERT_EQ(fs::file_size(cut), sizes.back()) << length;
    ASSERT_EQ(read_site_journal(cut).sites.size(), sites().size()) << length;
  }
}

TEST_F(SiteJournalTest, AChangedByteEndsWhatIsBelieved) {
  const auto sizes = write_all();
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(sizes[0] + 20));
  file.put('\x7f');
  file.close();
  const JournalContents contents = read_site_journal(path_);
  EXPECT_TRUE(contents.sites.empty());
  EXPECT_EQ(contents.broken_bytes, sizes.back() - sizes[0]);
}

TEST_F(SiteJournalTest, OneOfAnotherCampaignIsMovedAside) {
  write_all();
  const SiteJournal other(path_, {std::string(64, 'b'), 3});
  EXPECT_TRUE(other.moved_aside());
  EXPECT_TRUE(other.found().empty());
  EXPECT_EQ(read_site_journal(path_.string() + ".old").sites.size(), sites().size());
}

TEST_F(SiteJournalTest, RefusesASecondWriter) {
  const SiteJournal first(path_, heading());
  try {
    const SiteJournal second(path_, heading());
    FAIL() << "two writers";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_THAT(error.what(), HasSubstr("another palpate"));
  }
}

TEST_F(SiteJournalTest, ACampaignMayHaveNoSites) {
  { const SiteJournal journal(path_, {kKey, 0}); }
  EXPECT_EQ(read_site_journal(path_).heading.planned_sites, 0);
}

TEST_F(SiteJournalTest, RefusesAFileThatIsNoJournal) {
  std::ofstream(path_)
      << "a letter to a friend, of more than one line\nand much longer than a heading "
         "could be, so that nobody would think that a crash had cut it short\n\n";
  EXPECT_THROW(read_site_journal(path_), Error);
  EXPECT_THROW(SiteJournal(path_, heading()), Error);
  EXPECT_GT(fs::file_size(path_), 100U) << "a file of somebody else must stay";
}

TEST_F(SiteJournalTest, WhenTheDiskIsFullTheJournalIsAsBefore) {
  const auto sizes = write_all();
  SiteJournal journal(path_, heading());
  // A limit on the size of files stands for a full disk: the write stops in the middle of a record.
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{sizes.back() + 30, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &tight);
  EXPECT_THROW(journal.append(sites().front()), Error);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(fs::file_size(path_), sizes.back());
  journal.append(sites().front());
  EXPECT_EQ(read_site_journal(path_).sites.size(), sites().size() + 1);
}

TEST(ContentDigest, DependsOnResultsAndNotOnTimes) {
  const Curves curves = samples::curves(3);
  Curves other = curves;
  other.sites.front().cpu_seconds += 1;
  other.provenance.steps.clear();
  EXPECT_EQ(content_sha256(other), content_sha256(curves));
  double& force = other.sites.front().paths.front().samples.back().force[2];
  force = std::nextafter(force, 1.0);
  EXPECT_NE(content_sha256(other), content_sha256(curves));
}

}  // namespace
}  // namespace palpate
