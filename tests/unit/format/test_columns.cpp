// SPDX-License-Identifier: AGPL-3.0-or-later
// Records as columns on disk, on a record of every kind of member.
#include "format/columns.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/refusal.hpp"

namespace palpate {
namespace {

using samples::expect_refusal;

enum class Colour : std::uint8_t { Red, Green };

struct Bead {
  double mass = 0;
  Vec3 position{};
  Colour colour = Colour::Red;
  bool hollow = false;
  std::int32_t label = -1;
};

const auto kBead = std::make_tuple(
    column("mass", &Bead::mass, "kg", "Mass.", rules::kPositive),
    column("position", &Bead::position, "m", "Where it is.", rules::kFinite),
    column("colour", &Bead::colour, "1", "0 red, 1 green.", rules::up_to(1, "a colour")),
    column("hollow", &Bead::hollow, "1", "Whether it is hollow.", rules::kFlag),
    column("label", &Bead::label, "1", "Its number.", rules::kFinite, true));

std::vector<Bead> beads() {
  return {{0.1, {1, 2, 3}, Colour::Green, true, 7}, {0.2, {-1, 0, 1e-9}, Colour::Red, false, -8}};
}

class Columns : public testing::Test {
 protected:
  void write(const std::function<void(hdf5::Writer&)>& fill) const {
    hdf5::Writer writer(file_);
    writer.group("/bead", "Beads.");
    fill(writer);
    writer.commit();
  }
  std::vector<Bead> read(std::size_t rows = hdf5::kAnyRows) const {
    return read_columns(hdf5::Reader(file_, "make it again"), "/bead", kBead, rows);
  }
  const samples::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "beads.h5";
};

void expect_equal(const std::vector<Bead>& a, const std::vector<Bead>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].mass, b[i].mass);
    EXPECT_EQ(a[i].position, b[i].position);
    EXPECT_EQ(a[i].colour, b[i].colour);
    EXPECT_EQ(a[i].hollow, b[i].hollow);
    EXPECT_EQ(a[i].label, b[i].label);
  }
}

TEST_F(Columns, ComeBackAsTheRecordsThatWereWritten) {
  write([](hdf5::Writer& writer) { write_columns(writer, "/bead", beads(), kBead); });
  expect_equal(read(), beads());
  expect_equal(read(2), beads());
  EXPECT_THROW(read(3), Error);  // another number of rows than the file must have
}

TEST_F(Columns, MayBeAppendedAndReadInParts) {
  std::vector<Bead> many;
  for (int i = 0; i < 9000; ++i)
    many.push_back({1.0 + i, {0, 0, 1.0 * i}, Colour::Green, false, i});
  write([&](hdf5::Writer& writer) {
    begin_columns(writer, "/bead", many.size(), kBead);
    append_columns(writer, "/bead", {many.begin(), many.begin() + 5000}, kBead);
    append_columns(writer, "/bead", {many.begin() + 5000, many.end()}, kBead);
  });
  expect_equal(read(), many);
  const hdf5::Reader reader(file_, "make it again");
  const auto numbers =
      std::make_tuple(column("mass", &Bead::mass, "kg", "Mass.", rules::kPositive),
                      column("position", &Bead::position, "m", "Where.", rules::kFinite));
  EXPECT_EQ(rows_of_columns(reader, "/bead", numbers), many.size());
  const auto part = read_rows(reader, "/bead", numbers, 4990, 20);  // across two chunks
  for (std::size_t i = 0; i < part.size(); ++i)
    EXPECT_EQ(part[i].mass, 4991 + static_cast<double>(i));
}

TEST_F(Columns, RefuseAValueThatIsNoneOfTheEnumeration) {
  write([](hdf5::Writer& writer) {
    write_columns(writer, "/bead", beads(),
                  std::make_tuple(std::get<0>(kBead), std::get<1>(kBead), std::get<3>(kBead)));
    writer.dataset<std::uint8_t>("/bead/colour", {1, 2}, {"1", "0 red, 1 green."});
  });
  expect_refusal([&] { read(); }, ErrorKind::Configuration, "beads.h5:/bead/colour[1]",
                 "is not a colour");
}

TEST_F(Columns, KeepTheInitialValueOfAnOptionalMember) {
  write([](hdf5::Writer& writer) {
    write_columns(writer, "/bead", beads(),
                  std::make_tuple(std::get<0>(kBead), std::get<1>(kBead), std::get<2>(kBead),
                                  std::get<3>(kBead)));
  });
  const auto found = read();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].label, -1);
  EXPECT_EQ(found[0].mass, 0.1);
}

TEST_F(Columns, OfDifferentLengthsAreRefused) {
  write([](hdf5::Writer& writer) {
    write_columns(writer, "/bead", beads(), std::make_tuple(std::get<0>(kBead)));
    writer.dataset<Vec3>("/bead/position", {{0, 0, 0}}, {"m", "Where it is."});
  });
  expect_refusal([&] { read(); }, ErrorKind::Configuration, "/bead/position", "1");
}

TEST_F(Columns, AreCheckedBeforeTheyAreWritten) {
  auto wrong = beads();
  wrong[1].mass = 0;
  const Checks checks(file_);
  EXPECT_NO_THROW(check_columns(checks, "/bead", beads(), kBead));
  expect_refusal([&] { check_columns(checks, "/bead", wrong, kBead, 40); }, ErrorKind::Internal,
                 "/bead/mass[41]", "is not finite and above 0");
}

}  // namespace
}  // namespace palpate
