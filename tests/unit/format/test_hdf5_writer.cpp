// SPDX-License-Identifier: AGPL-3.0-or-later
// What the writer puts into a file, seen by HDF5's own C API.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <random>

#include "format/hdf5_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/refusal.hpp"

namespace palpate::hdf5 {
namespace {

using samples::TemporaryFolder;
using samples::text_of;

/// A dataset opened by HDF5 itself.
class Raw {
 public:
  Raw(const std::filesystem::path& file, const char* path)
      : file_(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)),
        dataset_(H5Dopen2(file_, path, H5P_DEFAULT)) {}
  ~Raw() {
    H5Dclose(dataset_);
    H5Fclose(file_);
  }
  Raw(const Raw&) = delete;
  Raw& operator=(const Raw&) = delete;

  std::vector<hsize_t> extent() const {
    const hid_t space = H5Dget_space(dataset_);
    std::vector<hsize_t> size(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, size.data(), nullptr);
    H5Sclose(space);
    return size;
  }
  bool is_stored_as(hid_t type) const {
    const hid_t stored = H5Dget_type(dataset_);
    const bool equal = H5Tequal(stored, type) > 0;
    H5Tclose(stored);
    return equal;
  }
  H5D_layout_t layout() const {
    const hid_t list = H5Dget_create_plist(dataset_);
    const H5D_layout_t layout = H5Pget_layout(list);
    H5Pclose(list);
    return layout;
  }
  std::vector<double> numbers(std::size_t count) const {
    std::vector<double> values(count);
    H5Dread(dataset_, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    return values;
  }

 private:
  hid_t file_, dataset_;
};

class Hdf5Writer : public testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "a.h5";
};

/// Little-endian numbers of fixed size, whatever the machine; a vector is a row.
TEST_F(Hdf5Writer, StoresPortableNumbersInRows) {
  Writer writer(file_);
  writer.dataset<std::array<double, 3>>("/vectors", {{1, 2, 3}, {4, 5, 6}}, {"m", "Vectors."});
  writer.dataset<std::int32_t>("/numbers", {-1}, {"1", "Numbers."});
  writer.dataset<float>("/none", {}, {"N", "None."});
  writer.commit();
  const Raw vectors(file_, "/vectors"), numbers(file_, "/numbers"), none(file_, "/none");
  EXPECT_EQ(vectors.extent(), (std::vector<hsize_t>{2, 3}));
  EXPECT_EQ(vectors.numbers(6), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_TRUE(vectors.is_stored_as(H5T_IEEE_F64LE));
  EXPECT_TRUE(numbers.is_stored_as(H5T_STD_I32LE));
  EXPECT_EQ(none.extent(), (std::vector<hsize_t>{0}));
}

TEST_F(Hdf5Writer, AppendsToALongDatasetInChunks) {
  const std::size_t rows = kChunkRows + 100;
  Writer writer(file_);
  writer.begin_dataset<double>("/long", rows, {"m", "Long."});
  std::vector<double> all(rows);
  for (std::size_t i = 0; i < rows; ++i) all[i] = 0.5 * static_cast<double>(i);
  for (std::size_t first = 0; first < rows; first += 700)
    writer.append<double>("/long",
                          {all.begin() + static_cast<std::ptrdiff_t>(first),
                           all.begin() + static_cast<std::ptrdiff_t>(std::min(first + 700, rows))});
  writer.commit();
  const Raw raw(file_, "/long");
  EXPECT_EQ(raw.layout(), H5D_CHUNKED);
  EXPECT_EQ(raw.numbers(rows), all);
}

TEST_F(Hdf5Writer, DeflatesWhatIsLong) {
  std::vector<double> rising(10000);
  for (std::size_t i = 0; i < rising.size(); ++i) rising[i] = static_cast<double>(i);
  Writer writer(file_);
  writer.dataset<double>("/long", rising, {"1", "Rising."});
  writer.dataset<double>("/short", {1, 2, 3}, {"1", "Short."});
  writer.commit();
  EXPECT_EQ(Raw(file_, "/long").layout(), H5D_CHUNKED);
  EXPECT_EQ(Raw(file_, "/long").numbers(rising.size()), rising);
  EXPECT_EQ(Raw(file_, "/short").layout(), H5D_CONTIGUOUS);
  EXPECT_LT(std::filesystem::file_size(file_), 4 * rising.size());
}

/// A library has some forty datasets: what HDF5 adds to each must not outweigh small ones.
TEST_F(Hdf5Writer, AddsLessThanAKilobyteToADataset) {
  std::mt19937_64 engine(1);
  std::vector<std::uint8_t> noise(2000);
  for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(engine());
  const auto size_of = [&](int datasets) {
    Writer writer(file_);
    for (int i = 0; i < datasets; ++i)
      writer.dataset<std::uint8_t>("/noise" + std::to_string(i), noise, {"1", "Noise."});
    writer.commit();
    return std::filesystem::file_size(file_);
  };
  EXPECT_LT(size_of(60) - size_of(20), 40 * (noise.size() + 1000));
}

/// Equal content gives equal bytes, in memory or on the disk.
TEST_F(Hdf5Writer, DoesNotDependOnWhereTheFileIsBuilt) {
  const auto fill = [](Writer& writer) {
    writer.group("/g", "Group.");
    writer.set_real("/g", "length", 0.25);
    writer.dataset<double>("/g/x", {1, 2, 3}, {"m", "x."});
    writer.commit();
  };
  Writer memory(file_), again(folder_ / "b.h5"), disk(folder_ / "c.h5", OnDisk{1 << 20});
  fill(memory), fill(again), fill(disk);
  EXPECT_EQ(text_of(file_), text_of(folder_ / "b.h5"));
  EXPECT_EQ(Raw(folder_ / "c.h5", "/g/x").numbers(3), (std::vector<double>{1, 2, 3}));
}

TEST_F(Hdf5Writer, LeavesNoFileWithoutCommit) {
  {
    Writer writer(file_);
    writer.dataset<double>("/x", {1}, {"m", "x."});
  }
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(Hdf5Writer, RefusesAPathTwice) {
  Writer writer(file_);
  writer.dataset<double>("/x", {1}, {"m", "x."});
  EXPECT_THROW(writer.dataset<double>("/x", {2}, {"m", "x."}), Error);
}

}  // namespace
}  // namespace palpate::hdf5
