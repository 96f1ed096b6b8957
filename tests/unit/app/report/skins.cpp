// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/unit/app/report/skins.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "fitting/deformation/coarsen.hpp"
#include "format/deformation.hpp"
#include "format/flat_library.hpp"
#include "format/skin_mesh.hpp"
#include "tests/support/dimpled_skin.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/app/report/synthetic.hpp"

namespace palpate::testing {
namespace {

void require(int result) {
  if (result != PALPATE_OK) throw std::runtime_error(palpate_last_error());
}

std::string bytes_of(const Deformation& deformation) {
  const samples::TemporaryFolder folder;
  const auto file = folder / "deformation.pdef";
  write_deformation(file, deformation);
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

std::string deformation_bytes(const Body& body, const Library& library) {
  return bytes_of(test::dimpled(library, skin_mesh(body), kDepth, library.tool_radius));
}

std::string surface_deformation_bytes(const Body& body, const Library& library) {
  const Deformation fine = test::dimpled(library, skin_mesh(body), kDepth, library.tool_radius);
  return bytes_of(fitting::coarsened(fine, body.response.triangles, fine.mode_count()));
}

TouchedSkin::TouchedSkin(const Body& body, const Library& library) {
  const std::string flat = flat_bytes(library, "lump"), file = deformation_bytes(body, library);
  require(palpate_library_load_memory(flat.data(), flat.size(), &library_));
  require(palpate_state_create(library_, nullptr, &state_));
  require(palpate_deformation_load_memory(library_, file.data(), file.size(), &skin_));
  vertices_ = skin_mesh(body).node.size();
}

TouchedSkin::~TouchedSkin() {
  palpate_deformation_destroy(skin_);
  palpate_state_destroy(state_);
  palpate_library_destroy(library_);
}

void TouchedSkin::step(const Vec3& position, double force[3]) {
  const double still[3] = {};
  palpate_step(state_, position.data(), still, 1e-3, force);
}

palpate_observation TouchedSkin::seen() const {
  palpate_observation seen{};
  seen.size = sizeof seen;
  require(palpate_observe(state_, &seen));
  return seen;
}

std::vector<Vec3> TouchedSkin::deformed() const {
  std::vector<Vec3> x(vertices_);
  require(palpate_deform(state_, skin_, x.front().data(), x.size()));
  return x;
}

Recording rendered(Recording recording, TouchedSkin& skin) {
  for (RecordedStep& step : recording.steps) {
    skin.step(step.position, step.force.data());
    const palpate_observation seen = skin.seen();
    std::copy(seen.contact_point, seen.contact_point + 3, step.contact_point.begin());
    step.depth = seen.depth;
    step.lateral = seen.lateral;
    step.offset = seen.offset;
    step.energy = seen.energy;
    step.tank = seen.tank;
    step.absorbed = seen.absorbed;
    step.element = seen.element;
    step.status = seen.status;
  }
  return recording;
}

}  // namespace palpate::testing
