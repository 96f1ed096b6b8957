// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/image/label_image.hpp"

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>

#include "mesher/read/file/file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;
using test::mesh_file;

/// Counts and places as nibabel states them (make_images.py).
void expect_ball(const LabelImage& image) {
  EXPECT_EQ(image.size, (std::array<std::size_t, 3>{14, 12, 10}));
  EXPECT_EQ(std::count(image.labels.begin(), image.labels.end(), 1), 246);
  EXPECT_EQ(std::count(image.labels.begin(), image.labels.end(), 5), 17);
  EXPECT_EQ(image.at(6, 5, 4), 5);
  EXPECT_NEAR(norm(image.point({6, 5, 4}) - Vec3{14.3953653e-3, -7.28462529e-3, 20e-3}), 0, 1e-9);
  EXPECT_NEAR(norm(image.point({13, 0, 9}) - Vec3{27.96068871e-3, -12.40634269e-3, 7.5e-3}), 0,
              2e-9);
}

TEST(LabelImage, VoxelsLieWhereNibabelSays) {
  expect_ball(read_label_image(mesh_file("images/ball_sform.nii.gz"), 0));
  expect_ball(read_label_image(mesh_file("images/ball_qform.nii"), 0));
}

TEST(LabelImage, ReadsEveryEncodingOfTeem) {
  for (const char* name :
       {"images/ball_gzip.nrrd", "images/ball_ascii.nrrd", "images/ball_raw.nhdr"}) {
    SCOPED_TRACE(name);
    expect_ball(read_label_image(mesh_file(name), 1e-3));
    expect_refusal([&] { read_label_image(mesh_file(name), 0); }, name, "does not state the unit",
                   "[image]");
  }
}

TEST(LabelImage, TheUnitOfTheCaseReplacesThatOfTheHeader) {
  const LabelImage image = read_label_image(mesh_file("images/ball_sform.nii.gz"), 1e-2);
  EXPECT_NEAR(norm(image.origin - Vec3{0.1, -0.2, 0.3}), 0, 1e-8);
}

TEST(LabelImage, ALeftHandedSpaceIsMirrored) {
  const std::string header =
      "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-anterior-superior\nsizes: 1 1 2\n"
      "space directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (1,0,0)\n"
      "space units: \"cm\" \"cm\" \"cm\"\nkinds: domain domain domain\nkey:=value\n"
      "encoding: text\n\n0 3";
  const LabelImage image = read_nrrd(header, 0, "a.nrrd");
  EXPECT_NEAR(image.origin[0], -0.01, 1e-15);
  EXPECT_NEAR(image.step[0][0], -0.02, 1e-15);
  EXPECT_EQ(image.at(0, 0, 1), 3);
}

ImageLabels field(std::array<std::size_t, 3> size,
                  const std::function<std::int32_t(const Vec3&)>& label) {
  LabelImage image{size, {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, {}, {}};
  for (std::size_t k = 0; k < size[2]; ++k)
    for (std::size_t j = 0; j < size[1]; ++j)
      for (std::size_t i = 0; i < size[0]; ++i)
        image.labels.push_back(
            label({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}));
  return {std::move(image), "a.nii"};
}

TEST(ImageLabels, IsTheLabelOfTheVoxelAtItsCentreAndOutsideBeyondTheImage) {
  const ImageLabels corner = field({2, 2, 2}, [](const Vec3& x) { return x[0] > 0 ? 7 : 2; });
  EXPECT_EQ(corner.label({0, 0, 0}), 2);
  EXPECT_EQ(corner.label({1, 1, 0}), 7);
  EXPECT_EQ(corner.label({0.49, 0.5, 0.5}), 2);
  EXPECT_EQ(corner.label({0.51, 0.5, 0.5}), 7);
  EXPECT_EQ(corner.label({0.5, 0.5, 0.5}), 2);  // of equal memberships the smaller label
  EXPECT_EQ(corner.label({1, 1.4, 1}), 7);      // half a voxel beyond the last centre
  EXPECT_EQ(corner.label({1, 1.6, 1}), 0);
  EXPECT_EQ(corner.label({1e9, 0, 0}), 0);
  EXPECT_EQ(corner.label({std::nan(""), 0, 0}), 0);
}

/// The largest distance of a change of label along rays from the centre, from the true ball.
double roughness(const std::function<bool(const Vec3&)>& inside, const Vec3& centre,
                 double radius) {
  double worst = 0;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (int ray = 0; ray < 500; ++ray) {
    Vec3 direction{normal(random), normal(random), normal(random)};
    direction = (1 / norm(direction)) * direction;
    double r = 0;
    while (inside(centre + r * direction)) r += 0.01;
    worst = std::max(worst, std::abs(r - radius));
  }
  return worst;
}

TEST(ImageLabels, SmoothsTheSteps) {
  const Vec3 centre{10, 10, 10};
  const double radius = 7.3;
  const ImageLabels ball =
      field({21, 21, 21}, [&](const Vec3& x) { return norm(x - centre) < radius ? 1 : 0; });
  const double steps = roughness(
      [&](const Vec3& x) {
        return ball.image().at(static_cast<std::size_t>(std::lround(x[0])),
                               static_cast<std::size_t>(std::lround(x[1])),
                               static_cast<std::size_t>(std::lround(x[2]))) == 1;
      },
      centre, radius);
  const double smooth =
      roughness([&](const Vec3& x) { return ball.label(x) == 1; }, centre, radius);
  EXPECT_GT(steps, 0.7);
  EXPECT_LT(smooth, 0.75 * steps);
}

TEST(LabelImage, RefusesWhatIsNoSegmentation) {
  const std::string nrrd =
      "NRRD0004\ntype: float\ndimension: 3\nsizes: 1 1 2\n"
      "space directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (1,0,0)\nencoding: text\n\n";
  const auto refused = [](const std::string& bytes, const std::string& problem) {
    expect_refusal([&] { read_nrrd(bytes, 1e-3, "a.nrrd"); }, "a.nrrd", problem);
  };
  refused(nrrd + "0 1.5", "voxel 1 has the value 1.5, which is no label");
  refused(nrrd + "0", "the file ends");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = nrrd + "0 1";
    return text.replace(text.find(from), from.size(), to);
  };
  refused("once", "NRRD000");
  refused(with("dimension: 3", "dimension: 4"), "dimension is '4'");
  refused(with("sizes: 1 1 2", "sizes: 1 1 0"), "axis of 0");
  refused(with("sizes: 1 1 2", "sizes: 1 1"), "the line ends");
  refused(with("(0,3,0)", "none"), "where a vector is expected");
  refused(with("space origin: (1,0,0)\n", ""), "no space directions and origin");
  refused(with("encoding: text", "encoding: bzip2"), "encoding 'bzip2'");
  refused(with("encoding: text", "encoding: raw"), "3 of 8 bytes");
  expect_refusal(
      [] {
        ImageLabels({{1, 1, 1}, {Vec3{1, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 1}}, {}, {1}}, "a.nii");
      },
      "a.nii", "one plane");
  expect_refusal([] { read_label_image(mesh_file("README.md"), 1); }, "README.md", "kind of image");
}

TEST(LabelImage, RefusesDamageOfNifti) {
  const std::string bytes = read_bytes(mesh_file("images/ball_qform.nii"));
  const auto refused = [&](std::size_t at, const std::string& change, const std::string& problem) {
    std::string damaged = bytes;
    damaged.replace(at, change.size(), change);
    expect_refusal([&] { read_nifti(damaged, 0, "a.nii"); }, "a.nii", problem);
  };
  refused(0, std::string(4, '\0'), "not of NIfTI-1");
  refused(344, "ni1", "two files");
  refused(41, "\2", "2 dimensions");
  refused(42, "\x7f\xff", "bytes");
  refused(42, std::string(2, '\0'), "axis of 0");
  refused(70, std::string(2, '\0'), "voxels of type 0");
  refused(252, std::string(4, '\0'), "no orientation");
  refused(123, std::string(1, '\0'), "does not state the unit");
  expect_refusal([&] { read_nifti(bytes.substr(0, 300), 0, "a.nii"); }, "a.nii", "shorter");
  expect_refusal([&] { read_nifti(bytes.substr(0, 1000), 0, "a.nii"); }, "a.nii", "1000 of");
}

TEST(LabelImage, ChangedBytesGiveAnImageOrARefusal) {
  const samples::TemporaryFolder folder;
  std::mt19937_64 random(3);
  for (const char* name :
       {"ball_sform.nii.gz", "ball_qform.nii", "ball_gzip.nrrd", "ball_ascii.nrrd"}) {
    const std::string bytes = read_bytes(mesh_file(std::string("images/") + name));
    for (int run = 0; run < 300; ++run) {
      std::string damaged = bytes;
      if (run % 3 == 0) damaged.resize(random() % bytes.size());
      if (run % 3 != 0)
        damaged[random() % std::min<std::size_t>(bytes.size(), 420)] = static_cast<char>(random());
      std::ofstream(folder / name, std::ios::binary) << damaged;
      try {
        const LabelImage image = read_label_image(folder / name, 1e-3);
        EXPECT_EQ(image.labels.size(), image.size[0] * image.size[1] * image.size[2]);
      } catch (const Error& error) {
        EXPECT_NE(error.kind(), ErrorKind::Internal) << error.what();
        EXPECT_THAT(error.where(), testing::HasSubstr(name)) << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace palpate::mesher
