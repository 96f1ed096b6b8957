// SPDX-License-Identifier: AGPL-3.0-or-later
// The C interface from a file to a force: load, collide, press, slide, account, and every refusal.
#include "runtime/palpate.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "format/flat_library.hpp"
#include "tests/unit/runtime/api_fixture.hpp"

namespace palpate::test {
namespace {

TEST_F(PalpateApi, DescribesTheLibrary) {
  palpate_library_info info{};
  info.size = sizeof info;
  ASSERT_EQ(palpate_library_describe(library_, &info), PALPATE_OK);
  EXPECT_EQ(info.vertices, 81);
  EXPECT_EQ(info.triangles, 128);
  EXPECT_NEAR(info.depth, 0.02, 1e-8);
  EXPECT_NEAR(info.high[0], 0.08, 1e-12);
  EXPECT_EQ(info.low[2], 0.0);
  EXPECT_STRNE(palpate_version(), "");
}

TEST_F(PalpateApi, GeometryIsThatOfTheLibraryFile) {
  const Library file = read_library(path_);
  const std::size_t vertices = file.positions.size(), triangles = file.triangles.size();
  std::vector<Vec3> positions(vertices), normals(vertices);
  std::vector<Triangle> rows(triangles);
  std::vector<std::uint8_t> statuses(vertices, 9);
  ASSERT_EQ(palpate_library_vertices(library_, positions[0].data(), vertices), PALPATE_OK);
  ASSERT_EQ(palpate_library_normals(library_, normals[0].data(), vertices), PALPATE_OK);
  ASSERT_EQ(palpate_library_triangles(library_, rows[0].data(), triangles), PALPATE_OK);
  ASSERT_EQ(palpate_library_vertex_statuses(library_, statuses.data(), vertices), PALPATE_OK);
  EXPECT_EQ(positions, file.positions);
  EXPECT_EQ(normals, file.inward);
  EXPECT_EQ(rows, file.triangles);
  for (std::size_t v = 0; v < vertices; ++v)
    EXPECT_EQ(statuses[v], static_cast<std::uint8_t>(file.responses[v].status));
}

TEST_F(PalpateApi, ThePointOfContactIsInTheActiveTriangleOfTheGeometry) {
  std::vector<Vec3> positions(81);
  std::vector<Triangle> rows(128);
  ASSERT_EQ(palpate_library_vertices(library_, positions[0].data(), 81), PALPATE_OK);
  ASSERT_EQ(palpate_library_triangles(library_, rows[0].data(), 128), PALPATE_OK);
  step({0.031, 0.046, 0.0004});
  step({0.031, 0.046, -0.002});
  const palpate_observation seen = observe();
  ASSERT_GE(seen.element, 0);
  Vec3 point{};
  for (std::size_t l = 0; l < 3; ++l)
    point =
        point +
        seen.natural[l] *
            positions[static_cast<std::size_t>(rows[static_cast<std::size_t>(seen.element)][l])];
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(point[i], seen.contact_point[i], 1e-15);
}

TEST_F(PalpateApi, ArraysOfTheGeometryAreNeverOverrun) {
  std::vector<double> positions(std::size_t{3} * 81, -1);
  EXPECT_EQ(palpate_library_vertices(library_, positions.data(), 80), PALPATE_ERROR_ARGUMENT);
  EXPECT_NE(std::strstr(palpate_last_error(), "capacity is 80, and there are 81"), nullptr);
  EXPECT_EQ(std::count(positions.begin(), positions.end(), -1.0), 3 * 81);
  std::vector<std::int32_t> rows(std::size_t{3} * 128);
  EXPECT_EQ(palpate_library_triangles(library_, rows.data(), 127), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_library_normals(nullptr, positions.data(), 81), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_library_vertex_statuses(library_, nullptr, 81), PALPATE_ERROR_ARGUMENT);
}

TEST_F(PalpateApi, PressSlideReleaseOnAPlate) {
  // Free, then inside by 0.1 mm in one step: activated without force.
  EXPECT_EQ(step({0.030, 0.033, 0.0004}), 0U);
  EXPECT_EQ(step({0.030, 0.033, -0.0001}), PALPATE_CONTACT | PALPATE_ACTIVATED);
  EXPECT_EQ(norm(force_), 0.0);
  EXPECT_NEAR(observe().offset, 0.0001, 1e-15);

  // Press to 6 mm: the wall law of the node, shifted by the offset, pushing the tool out (+z).
  for (int i = 1; i <= 60; ++i) step({0.030, 0.033, -0.0001 * i});
  const double z = 0.006 - 0.0001;
  const double g = kStiffness * (z - 0.0025);
  EXPECT_NEAR(force_[2], g, 1e-6);
  EXPECT_NEAR(force_[0], 0, 1e-12);
  // Work of a frictionless press: the antiderivative of the wall law.
  const double pressed =
      kStiffness * (0.005 * 0.005 * 0.005 * 100 / 3 + (z * z - 2.5e-5) / 2 - 0.0025 * (z - 0.005));
  EXPECT_NEAR(observe().absorbed, pressed, 1e-9);
  EXPECT_NEAR(observe().energy, pressed, 1e-9);

  // Slide 20 mm along x: presliding first, then the lateral force saturates at mu g.
  std::uint32_t seen = 0;
  for (int i = 1; i <= 400; ++i) seen = step({0.030 + 5e-5 * i, 0.033, -0.006});
  EXPECT_TRUE(seen & PALPATE_SLIDING);
  EXPECT_NEAR(force_[0], -0.3 * g, 1e-6);  // resists the motion
  EXPECT_NEAR(force_[2], g, 1e-6);
  EXPECT_NEAR(observe().contact_point[0], 0.050 - 0.3 * g / 120, 1e-7);

  // Release: the energy that friction dissipated stays absorbed.
  for (int i = 1; i <= 70; ++i) seen = step({0.050, 0.033, -0.006 + 1e-4 * i});
  EXPECT_EQ(seen, 0U);
  EXPECT_EQ(norm(force_), 0.0);
  EXPECT_EQ(observe().element, -1);
  // Closed cycle: the normal work is returned, the lateral spring is loaded to mu g and then lost.
  // While slipping, each step of 50 um first stretches that spring beyond mu g, then lets c follow.
  const double friction_force = 0.3 * g;
  const double stretch = friction_force / 120;
  const double lost = friction_force * (0.020 - stretch / 2) + 120 * 5e-5 / 2 * (0.020 - stretch);
  EXPECT_NEAR(observe().absorbed, lost, 1e-3 * lost);
}

TEST_F(PalpateApi, BadInputGivesAFiniteZeroForceAndDropsTheContact) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Vec3 inside{0.03, 0.033, -0.004};
  for (const Vec3& bad : {Vec3{nan, 0, 0}, Vec3{0, infinity, 0}, Vec3{1e300, -1e300, 1e300},
                          Vec3{0.03, 0.033, -1.0}}) {
    palpate_state_reset(state_);
    step({0.03, 0.033, 0.001});
    step({0.03, 0.033, -0.0001});
    step(inside);
    ASSERT_GT(force_[2], 0.1);
    const std::uint32_t status = step(bad);
    EXPECT_EQ(status, PALPATE_BAD_INPUT | PALPATE_DROPPED);
    EXPECT_EQ(norm(force_), 0.0);
    // The discarded energy must not come back: no force until the surface is crossed anew.
    step(inside);
    step(inside);
    EXPECT_EQ(norm(force_), 0.0);
  }
}

TEST_F(PalpateApi, RefusesATimeStepThatIsNotPositive) {
  const double x[3] = {0.03, 0.033, 0.001};
  const double v[3] = {0, 0, 0};
  double f[3] = {1, 1, 1};
  for (const double dt : {0.0, -1e-3, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(palpate_step(state_, x, v, dt, f), PALPATE_BAD_INPUT);
    EXPECT_EQ(f[0], 0.0);
  }
  EXPECT_EQ(palpate_step(nullptr, x, v, kDt, f), PALPATE_BAD_INPUT);
  EXPECT_EQ(palpate_step(state_, nullptr, v, kDt, f), PALPATE_BAD_INPUT);
  EXPECT_EQ(palpate_step(state_, x, v, kDt, nullptr), PALPATE_BAD_INPUT);
  palpate_observation seen{};
  seen.size = sizeof seen;
  EXPECT_EQ(palpate_observe(nullptr, &seen), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_observe(state_, nullptr), PALPATE_ERROR_ARGUMENT);
}

TEST_F(PalpateApi, RefusesAFileWithTheReason) {
  palpate_library* none = nullptr;
  EXPECT_EQ(palpate_library_load((folder_ / "absent.h5").c_str(), &none), PALPATE_ERROR_FILE);
  EXPECT_NE(std::strstr(palpate_last_error(), "absent.h5"), nullptr);
  EXPECT_EQ(none, nullptr);

  const auto text = folder_ / "text.h5";
  std::ofstream(text) << "this is no library";
  EXPECT_EQ(palpate_library_load(text.c_str(), &none), PALPATE_ERROR_FORMAT);
  EXPECT_EQ(none, nullptr);
  EXPECT_EQ(palpate_library_load(nullptr, &none), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_library_load(path_.c_str(), nullptr), PALPATE_ERROR_ARGUMENT);
}

TEST_F(PalpateApi, RefusesWhatIsNoRegularFileWithoutWaitingForIt) {
  // Whoever opens a FIFO without a writer waits for ever.
  const auto fifo = folder_ / "fifo.h5";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  palpate_library* none = nullptr;
  EXPECT_EQ(palpate_library_load(fifo.c_str(), &none), PALPATE_ERROR_FILE);
  EXPECT_NE(std::strstr(palpate_last_error(), "a FIFO"), nullptr);
  EXPECT_EQ(palpate_library_load("/dev/zero", &none), PALPATE_ERROR_FILE);
  EXPECT_NE(std::strstr(palpate_last_error(), "a device"), nullptr);
  EXPECT_EQ(none, nullptr);
}

TEST_F(PalpateApi, RefusesSettingsOutOfRange) {
  palpate_state* none = nullptr;
  palpate_settings bad = settings_;
  bad.size = 4;
  EXPECT_EQ(palpate_state_create(library_, &bad, &none), PALPATE_ERROR_ARGUMENT);
  bad = settings_;
  bad.tank_cap = -1;
  EXPECT_EQ(palpate_state_create(library_, &bad, &none), PALPATE_ERROR_ARGUMENT);
  bad = settings_;
  bad.friction = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(palpate_state_create(library_, &bad, &none), PALPATE_ERROR_ARGUMENT);
  bad = settings_;
  bad.lipschitz_bound = -1;
  EXPECT_EQ(palpate_state_create(library_, &bad, &none), PALPATE_ERROR_ARGUMENT);
  bad.lipschitz_bound = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(palpate_state_create(library_, &bad, &none), PALPATE_ERROR_ARGUMENT);
  // This library was never certified, so it has no friction of its own to fall back to.
  EXPECT_EQ(palpate_state_create(library_, nullptr, &none), PALPATE_ERROR_ARGUMENT);
  EXPECT_NE(std::strstr(palpate_last_error(), "friction"), nullptr);
  EXPECT_EQ(none, nullptr);
}

TEST_F(PalpateApi, LoadsFromMemory) {
  std::ifstream file(path_, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  palpate_library* copy = nullptr;
  ASSERT_EQ(palpate_library_load_memory(bytes.data(), bytes.size(), &copy), PALPATE_OK)
      << palpate_last_error();
  palpate_library_info info{};
  info.size = sizeof info;
  EXPECT_EQ(palpate_library_describe(copy, &info), PALPATE_OK);
  EXPECT_EQ(info.triangles, 128);
  palpate_library_destroy(copy);
  EXPECT_EQ(palpate_library_load_memory(bytes.data(), bytes.size() / 2, &copy),
            PALPATE_ERROR_FORMAT);
  EXPECT_EQ(std::string(palpate_last_error()).rfind("library in memory: ", 0), 0U)
      << palpate_last_error();
  EXPECT_EQ(palpate_library_load_memory("no library", 10, &copy), PALPATE_ERROR_FORMAT);
  EXPECT_STREQ(palpate_last_error(),
               "library in memory: is not an HDF5 file; make it again with 'palpate fit'");
  EXPECT_EQ(palpate_library_load_memory(bytes.data(), 0, &copy), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_library_load_memory(nullptr, 10, &copy), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_library_load("", &copy), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(copy, nullptr);
}

/// The same library as a flat file, from disk and from memory: the same forces, bit for bit.
TEST_F(PalpateApi, LoadsAFlatLibraryWithTheSameForces) {
  const std::string flat = (folder_ / "library.plib").string();
  write_flat_library(flat, read_library(path_));
  std::ifstream file(flat, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  std::array<palpate_library*, 2> libraries{};
  ASSERT_EQ(palpate_library_load(flat.c_str(), &libraries[0]), PALPATE_OK) << palpate_last_error();
  ASSERT_EQ(palpate_library_load_memory(bytes.data(), bytes.size(), &libraries[1]), PALPATE_OK);
  for (palpate_library* library : libraries) {
    palpate_state_reset(state_);
    palpate_state* other = nullptr;
    ASSERT_EQ(palpate_state_create(library, &settings_, &other), PALPATE_OK);
    const double velocity[3] = {0, 0, 0};
    double largest = 0;
    for (int i = 0; i < 600; ++i) {
      const double depth = 0.006 * std::sin(0.01 * i) - 0.001;
      const Vec3 x{0.02 + 6e-5 * i, 0.03 + 0.01 * std::cos(0.02 * i), -depth};
      Vec3 force{};
      palpate_step(other, x.data(), velocity, kDt, force.data());
      step(x);
      ASSERT_EQ(force, force_) << i;
      largest = std::max(largest, norm(force));
    }
    EXPECT_GT(largest, 0.1);  // N
    palpate_state_destroy(other);
    palpate_library_destroy(library);
  }
  palpate_library* damaged = nullptr;
  EXPECT_EQ(palpate_library_load_memory(bytes.data(), bytes.size() - 1, &damaged),
            PALPATE_ERROR_FORMAT);
  EXPECT_EQ(std::string(palpate_last_error()).rfind("library in memory: has ", 0), 0U);
}

TEST_F(PalpateApi, AMovedBodyGivesTheMovedForces) {
  // The plate turned by 120 degrees about (1, 1, 1) and shifted: x -> y -> z -> x.
  const double rotation[9] = {0, 0, 1, 1, 0, 0, 0, 1, 0};
  const double shift[3] = {0.5, -0.2, 0.1};
  const auto in_world = [&](const Vec3& v, double w) {
    return Vec3{v[2] + w * shift[0], v[0] + w * shift[1], v[1] + w * shift[2]};
  };
  palpate_state* turned = nullptr;
  ASSERT_EQ(palpate_state_create(library_, &settings_, &turned), PALPATE_OK);
  ASSERT_EQ(palpate_state_set_pose(turned, shift, rotation), PALPATE_OK);
  const double velocity[3] = {0, 0, 0};
  for (int i = 0; i < 300; ++i) {
    const Vec3 x{0.03 + 5e-5 * i, 0.033, 0.0005 - 2e-5 * std::min(i, 200)};
    step(x);
    Vec3 force{};
    palpate_step(turned, in_world(x, 1).data(), velocity, kDt, force.data());
    ASSERT_NEAR(norm(force - in_world(force_, 0)), 0, 1e-9);
  }
  ASSERT_GT(norm(force_), 0.05);
  palpate_observation there{};
  there.size = sizeof there;
  ASSERT_EQ(palpate_observe(turned, &there), PALPATE_OK);
  const palpate_observation here = observe();
  const auto vec = [](const double* v) { return Vec3{v[0], v[1], v[2]}; };
  EXPECT_NEAR(norm(vec(there.contact_point) - in_world(vec(here.contact_point), 1)), 0, 1e-12);
  EXPECT_NEAR(norm(vec(there.normal) - in_world(vec(here.normal), 0)), 0, 1e-12);
  EXPECT_NEAR(norm(vec(there.force_on_body) - in_world(vec(here.force_on_body), 0)), 0, 1e-9);
  palpate_state_destroy(turned);
}

TEST_F(PalpateApi, RefusesAPoseThatIsNotRigid) {
  const double origin[3] = {0, 0, 0};
  const double good[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double mirror[9] = {1, 0, 0, 0, 1, 0, 0, 0, -1};
  const double stretched[9] = {1.001, 0, 0, 0, 1, 0, 0, 0, 1};
  const double nowhere[3] = {0, std::numeric_limits<double>::quiet_NaN(), 0};
  EXPECT_EQ(palpate_state_set_pose(state_, origin, mirror), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_state_set_pose(state_, origin, stretched), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_state_set_pose(state_, nowhere, good), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_state_set_pose(nullptr, origin, good), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_state_set_pose(state_, origin, good), PALPATE_OK);
}

TEST_F(PalpateApi, AProgramWithANewerHeaderGetsTheFieldsOfThisLibrary) {
  struct Newer {
    palpate_observation known;
    double added;
  } newer{};
  newer.added = 42;
  newer.known.size = sizeof newer;
  step({0.03, 0.033, 0.001});
  EXPECT_EQ(palpate_observe(state_, &newer.known), PALPATE_OK);
  EXPECT_EQ(newer.added, 42);  // unchanged
  EXPECT_EQ(newer.known.element, -1);
  newer.known.size = 8;
  EXPECT_EQ(palpate_observe(state_, &newer.known), PALPATE_ERROR_ARGUMENT);
}

TEST_F(PalpateApi, AProgramWithAnOlderHeaderGetsItsOwnFields) {
  palpate_observation seen{};
  seen.size = offsetof(palpate_observation, lateral_offset);
  seen.lateral_offset[0] = 42;
  step({0.03, 0.033, 0.001});
  EXPECT_EQ(palpate_observe(state_, &seen), PALPATE_OK);
  EXPECT_EQ(seen.lateral_offset[0], 42);
  EXPECT_EQ(seen.size, offsetof(palpate_observation, lateral_offset));
}

TEST_F(PalpateApi, RefusesALipschitzBoundThatTheLibraryCannotEnforce) {
  Library library = read_library(path_);
  Certificate& c = library.certificate;
  c.triangles.assign(library.triangles.size(), {200, 900, 0, 1, 1});
  c.stick = 200;
  c.slip = 900;
  c.min_lipschitz_bound = 250.25;
  c.friction = 0.3;
  const std::string certified = (folder_ / "certified.h5").string();
  write_library(certified, library);
  palpate_library* limited = nullptr;
  ASSERT_EQ(palpate_library_load(certified.c_str(), &limited), PALPATE_OK) << palpate_last_error();

  palpate_library_info info{};
  info.size =
      offsetof(palpate_library_info, min_lipschitz_bound);  // a program with an older header
  info.min_lipschitz_bound = 42;
  ASSERT_EQ(palpate_library_describe(limited, &info), PALPATE_OK);
  EXPECT_EQ(info.min_lipschitz_bound, 42);
  info.size = sizeof info;
  ASSERT_EQ(palpate_library_describe(limited, &info), PALPATE_OK);
  EXPECT_EQ(info.min_lipschitz_bound, 250.25);
  EXPECT_EQ(info.lipschitz_bound, 800);  // 4 L_stick, where slides would need 900

  palpate_state* state = nullptr;
  palpate_settings settings = settings_;
  settings.lipschitz_bound = 250.2;
  EXPECT_EQ(palpate_state_create(limited, &settings, &state), PALPATE_ERROR_ARGUMENT);
  EXPECT_NE(std::strstr(palpate_last_error(), "250.3 N/m"), nullptr) << palpate_last_error();
  settings.lipschitz_bound = 250.3;
  EXPECT_EQ(palpate_state_create(limited, &settings, &state), PALPATE_OK) << palpate_last_error();
  palpate_state_destroy(state);
  palpate_library_destroy(limited);
}

TEST_F(PalpateApi, AStateWithoutFrictionFeelsNoneOfALibraryCertifiedWithSome) {
  const std::string certified = (folder_ / "certified.h5").string();
  write_library(certified, plate_of_200());
  for (const double friction : {0.0, -1.0}) {  // -1: that of the certificate, 0.3
    palpate_library* library = nullptr;
    ASSERT_EQ(palpate_library_load(certified.c_str(), &library), PALPATE_OK);
    palpate_settings settings = settings_;
    settings.friction = friction;
    palpate_state* state = nullptr;
    ASSERT_EQ(palpate_state_create(library, &settings, &state), PALPATE_OK) << palpate_last_error();
    const double velocity[3] = {0, 0, 0};
    for (int i = 0; i <= 20; ++i) {
      const Vec3 x{0.04, 0.04, 0.0005 - 1e-4 * i};
      palpate_step(state, x.data(), velocity, kDt, force_.data());
    }
    for (int i = 1; i <= 20; ++i) {
      const Vec3 x{0.04 + 1e-4 * i, 0.04, -0.0015};
      palpate_step(state, x.data(), velocity, kDt, force_.data());
    }
    EXPECT_GT(std::abs(force_[2]), 0.03);
    EXPECT_NEAR(std::abs(force_[0]), friction == 0 ? 0 : 0.3 * std::abs(force_[2]), 1e-9);
    palpate_state_destroy(state);
    palpate_library_destroy(library);
  }
}

TEST_F(PalpateApi, ObservesTheLateralOffsetAtABorder) {
  // The observation is consistent: x = c + (z + d0) n + s + q, |q| = rho.
  step({0.07, 0.05, 0.0001});
  for (int i = 1; i <= 30; ++i) step({0.07, 0.05, -1e-4 * i});
  for (int i = 1; i <= 250; ++i) step({0.07 + 1e-4 * i, 0.05, -0.003});
  const palpate_observation seen = observe();
  const auto vec = [](const double v[3]) { return Vec3{v[0], v[1], v[2]}; };
  ASSERT_TRUE(seen.status & PALPATE_AT_BORDER);
  EXPECT_GT(norm(vec(seen.lateral_offset)), 0.005);
  const Vec3 q = Vec3{0.095, 0.05, -0.003} - vec(seen.contact_point) -
                 (seen.depth + seen.offset) * vec(seen.normal) - vec(seen.lateral_offset);
  EXPECT_NEAR(norm(q), seen.lateral, 1e-15);
  EXPECT_NEAR(dot(vec(seen.lateral_offset), vec(seen.normal)), 0, 1e-15);
}

TEST_F(PalpateApi, ThreadsMayShareALibrary) {
  // Four tools on one library at once get the forces of one tool alone, bit for bit.
  const auto press_and_slide = [&](Vec3& sum) {
    palpate_state* own = nullptr;
    ASSERT_EQ(palpate_state_create(library_, &settings_, &own), PALPATE_OK);
    const double velocity[3] = {0, 0, 0};
    sum = {0, 0, 0};
    for (int i = 0; i < 4000; ++i) {
      const double x[3] = {0.03 + 0.02 * std::sin(1e-3 * i), 0.033,
                           0.0005 - 0.005 * std::sin(3e-3 * i)};
      Vec3 f{};
      palpate_step(own, x, velocity, kDt, f.data());
      sum = sum + f;
    }
    palpate_state_destroy(own);
  };
  Vec3 alone{};
  press_and_slide(alone);
  ASSERT_GT(norm(alone), 1);
  std::array<Vec3, 4> together{};
  std::vector<std::thread> threads;
  for (Vec3& sum : together) threads.emplace_back([&] { press_and_slide(sum); });
  for (std::thread& t : threads) t.join();
  for (const Vec3& sum : together) EXPECT_EQ(sum, alone);
}

}  // namespace
}  // namespace palpate::test
