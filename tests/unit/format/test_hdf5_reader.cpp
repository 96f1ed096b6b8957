// SPDX-License-Identifier: AGPL-3.0-or-later
// The reader on a small file; on whole artifacts it is tested by damage, rejection and attributes.
#include <gtest/gtest.h>

#include <fstream>

#include "format/hdf5_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/refusal.hpp"

namespace palpate::hdf5 {
namespace {

using samples::expect_refusal;

class Hdf5Reader : public testing::Test {
 protected:
  void SetUp() override {
    Writer writer(file_);
    writer.set_text("/", "artifact", "palpate.sample");
    writer.set_integer("/", "schema", 2);
    writer.group("/g", "Group.");
    writer.set_real("/g", "length", 0.25);
    writer.set_texts("/g", "names", {"a", "", "\xc3\xa9"});
    writer.dataset<double>("/g/x", {1, 2, 3, 4}, {"m", "x."});
    writer.dataset<std::array<float, 2>>("/g/pairs", {{1, 2}, {3, 4}}, {"N", "Pairs."});
    writer.texts("/g/words", {"one", "two"}, "Words.");
    writer.commit();
    reader_ = std::make_unique<Reader>(file_, "make it again");
  }
  void expect_refused(const std::function<void()>& action, const std::string& where,
                      const std::string& problem) const {
    expect_refusal(action, ErrorKind::Configuration, where, problem);
  }
  const samples::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "a.h5";
  std::unique_ptr<Reader> reader_;
};

TEST_F(Hdf5Reader, ReadsWhatWasWritten) {
  EXPECT_EQ(reader_->require_artifact("palpate.sample", {1, 2}), 2);
  EXPECT_EQ(reader_->dataset<double>("/g/x", "m"), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ((reader_->dataset<std::array<float, 2>>("/g/pairs", "N")[1]),
            (std::array<float, 2>{3, 4}));
  EXPECT_EQ(reader_->texts("/g/words"), (std::vector<std::string>{"one", "two"}));
  EXPECT_EQ(reader_->text_list("/g", "names"), (std::vector<std::string>{"a", "", "\xc3\xa9"}));
  EXPECT_EQ(reader_->real("/g", "length"), 0.25);
  EXPECT_EQ(reader_->children("/g"), (std::vector<std::string>{"pairs", "words", "x"}));
  EXPECT_TRUE(reader_->has("/g/x"));
  EXPECT_FALSE(reader_->has("/h/x"));
  EXPECT_FALSE(reader_->has_attribute("/g", "width"));
}

TEST_F(Hdf5Reader, ReadsPartsOfADataset) {
  EXPECT_EQ(reader_->rows_of<double>("/g/x", "m"), 4u);
  EXPECT_EQ(reader_->part<double>("/g/x", 1, 2), (std::vector<double>{2, 3}));
}

TEST_F(Hdf5Reader, RefusesAnotherTypeShapeLengthOrUnit) {
  expect_refused([&] { reader_->dataset<float>("/g/x", "m"); }, "a.h5:/g/x", "32-bit float");
  expect_refused([&] { reader_->dataset<std::int64_t>("/g/x", "m"); }, "/g/x", "64-bit signed");
  expect_refused([&] { reader_->dataset<std::array<double, 2>>("/g/x", "m"); }, "/g/x", "");
  expect_refused([&] { reader_->dataset<std::array<float, 3>>("/g/pairs", "N"); }, "/g/pairs", "");
  expect_refused([&] { reader_->dataset<double>("/g/x", "m", 5); }, "/g/x", "5");
  expect_refused([&] { reader_->dataset<double>("/g/x", "mm"); }, "/g/x@units", "'m'");
}

TEST_F(Hdf5Reader, RefusesAnotherArtifactAndAnUnknownSchema) {
  expect_refused([&] { reader_->require_artifact("palpate.body", {2}); }, "a.h5", "palpate.sample");
  expect_refused([&] { reader_->require_artifact("palpate.sample", {1}); }, "a.h5", "2");
  expect_refused([&] { reader_->require_artifact("palpate.sample", {3}); }, "a.h5", "2");
}

/// A case in the place of what is made from it: the remedy says which file to give.
TEST_F(Hdf5Reader, TellsACaseFromABrokenFile) {
  for (const char* name : {"case.toml", "case.h5"}) {
    const bool is_case = std::string(name) == "case.toml";
    const auto file = folder_ / name;
    std::ofstream(file) << "name = 'pad'\n";
    expect_refused([&] { Reader(file, "make it again"); }, file.string(),
                   is_case ? "is a case, not an HDF5 file" : "is not an HDF5 file");
  }
}

TEST_F(Hdf5Reader, RefusesWhatIsNotThere) {
  expect_refused([&] { reader_->dataset<double>("/g/y", "m"); }, "/g/y", "");
  expect_refused([&] { reader_->real("/g", "width"); }, "/g", "width");
  expect_refused([&] { Reader(folder_ / "b.h5", "make it again"); }, "b.h5", "");
}

}  // namespace
}  // namespace palpate::hdf5
