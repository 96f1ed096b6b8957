// SPDX-License-Identifier: AGPL-3.0-or-later
// write_steps: JSON lines, one a library: the flat library, the positions of a tip, and the bits
// that the C interface of this machine gives for each step and for the skin as it is pressed, for
// the runtime in a browser to repeat.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "format/base64.hpp"
#include "format/deformation.hpp"
#include "format/flat_library.hpp"
#include "format/skin_mesh.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"
#include "tests/support/dimpled_skin.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/app/report/synthetic.hpp"

namespace {

using palpate::Vec3;
using palpate::operator+;
using palpate::operator-;
using palpate::operator*;

constexpr double kDt = 1e-3;

void append(std::string& bytes, const double* values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(double));
}

/// The bits of all that a step says: status, element, and every number of the observation.
void append(std::string& bytes, const double force[3], const palpate_observation& o) {
  const double whole[2] = {static_cast<double>(o.status), static_cast<double>(o.element)};
  append(bytes, whole, 2);
  append(bytes, force, 3);
  append(bytes, o.contact_point, 3);
  append(bytes, o.natural, 3);
  append(bytes, o.normal, 3);
  const double numbers[6] = {o.depth, o.lateral, o.offset, o.energy, o.tank, o.absorbed};
  append(bytes, numbers, 6);
  append(bytes, o.force_on_body, 3);
  append(bytes, o.lateral_offset, 3);
}

/// The vertex nearest to the mean of all: the middle of a plate.
std::size_t middle(const palpate::Library& library) {
  Vec3 mean{};
  for (const Vec3& x : library.positions)
    mean = mean + (1.0 / static_cast<double>(library.positions.size())) * x;
  const auto nearer = [&](const Vec3& a, const Vec3& b) {
    return palpate::norm(a - mean) < palpate::norm(b - mean);
  };
  const auto& all = library.positions;
  return static_cast<std::size_t>(std::min_element(all.begin(), all.end(), nearer) - all.begin());
}

/// A tip that circles over the body with a trembling hand, in and out of it.
Vec3 tip(const palpate::Library& library, std::size_t start, int i, std::mt19937& random) {
  const Vec3& x = library.positions[start];
  const Vec3& n = library.inward[start];
  const double t = i * kDt, wander = 0.003 * t;
  const double depth = 0.003 * std::sin(2.1 * t) + 0.0015;
  const auto tremble = [&] { return 2e-5 * (static_cast<double>(random()) / 4294967296.0 - 0.5); };
  return {x[0] + depth * n[0] + wander * std::cos(1.3 * t) + tremble(),
          x[1] + depth * n[1] + wander * std::sin(1.7 * t) + tremble(),
          x[2] + depth * n[2] + tremble()};
}

/// What a picture of every kBetweenPictures-th step shows: the bits of all vertices.
constexpr int kBetweenPictures = 75;

class Skin {
 public:
  Skin(const palpate_library* library, const palpate::SkinMesh& mesh,
       const palpate::Library& content, const std::filesystem::path& folder)
      : positions_(mesh.positions.size()) {
    const std::filesystem::path file = folder / "deformation.pdef";
    palpate::write_deformation(file, palpate::test::dimpled(content, mesh, 0.004, 0.005));
    std::ifstream stream(file, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(stream), {});
    if (palpate_deformation_load_memory(library, bytes_.data(), bytes_.size(), &skin_) !=
        PALPATE_OK)
      throw std::runtime_error(palpate_last_error());
  }
  Skin(const Skin&) = delete;
  Skin& operator=(const Skin&) = delete;
  ~Skin() { palpate_deformation_destroy(skin_); }

  const std::string& bytes() const { return bytes_; }

  void append_to(std::string& out, const palpate_state* state) {
    if (palpate_deform(state, skin_, positions_.front().data(), positions_.size()) != PALPATE_OK)
      throw std::runtime_error(palpate_last_error());
    for (const Vec3& x : positions_) append(out, x.data(), 3);
  }

 private:
  std::string bytes_;
  std::vector<Vec3> positions_;
  palpate_deformation* skin_ = nullptr;
};

nlohmann::json played(const std::string& name, const palpate::Library& library,
                      const palpate::SkinMesh& mesh, double friction, int steps) {
  const std::string flat = palpate::flat_bytes(library, name);
  palpate_library* handle = nullptr;
  if (palpate_library_load_memory(flat.data(), flat.size(), &handle) != PALPATE_OK)
    throw std::runtime_error(palpate_last_error());
  palpate_settings settings{};
  palpate_settings_default(&settings);
  settings.friction = friction;
  palpate_state* state = nullptr;
  if (palpate_state_create(handle, &settings, &state) != PALPATE_OK)
    throw std::runtime_error(palpate_last_error());
  const palpate::samples::TemporaryFolder folder;
  Skin skin(handle, mesh, library, folder.path());
  const std::size_t start = middle(library);
  std::mt19937 random(7);
  std::string positions, expected, deformed;
  const double still[3] = {};
  for (int i = 0; i < steps; ++i) {
    const Vec3 x = tip(library, start, i, random);
    double force[3];
    palpate_step(state, x.data(), still, kDt, force);
    palpate_observation seen{};
    seen.size = sizeof seen;
    palpate_observe(state, &seen);
    append(positions, x.data(), 3);
    append(expected, force, seen);
    if (i % kBetweenPictures == 0) skin.append_to(deformed, state);
  }
  palpate_state_destroy(state);
  palpate_library_destroy(handle);
  return {{"name", name},
          {"friction", friction},
          {"dt", kDt},
          {"library", palpate::base64(flat)},
          {"positions", palpate::base64(positions)},
          {"expected", palpate::base64(expected)},
          {"skin", palpate::base64(skin.bytes())},
          {"between_pictures", kBetweenPictures},
          {"deformed", palpate::base64(deformed)}};
}

}  // namespace

int main() {
  using namespace palpate;
  const testing::Synthetic lump = testing::synthetic(3, 1);
  constexpr int kSteps = 6000;
  const auto on_its_surface = [](const char* name, const Library& library, double friction) {
    return played(name, library, test::skin_of(library), friction, kSteps);
  };
  std::cout << on_its_surface("plate", test::plate_of_200(), -1) << '\n'
            << on_its_surface("coupled plate", test::plate_of_200(ResponseKind::Coupled), 0.2)
            << '\n'
            << played("lump", lump.library, skin_mesh(lump.body), 0.4, kSteps) << '\n'
            << on_its_surface("relaxing plate",
                              test::relaxing(test::plate_of_200(), {0.01, 0.1, 1}, false), 0.2)
            << '\n';
  return 0;
}
