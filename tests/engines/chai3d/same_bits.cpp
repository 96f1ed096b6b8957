// SPDX-License-Identifier: AGPL-3.0-or-later
// same_bits LIBRARY SKIN: the tool of CHAI3D on a PalpateBody commands what palpate_step gives for
// the positions that its device reported, bit for bit, and the mesh is what palpate_deform gives.
// Ends with 0 where that holds.
#include <devices/CGenericHapticDevice.h>
#include <tools/CToolCursor.h>
#include <world/CWorld.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "examples/chai3d/PalpateBody.h"

namespace {

using chai3d::cVector3d;

void require(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}

/// Presses the plate at its middle to 3 mm, then strokes it, and keeps the last force.
class Stroke : public chai3d::cGenericHapticDevice {
 public:
  Stroke() { m_deviceAvailable = m_deviceReady = true; }
  bool open() override { return true; }
  bool close() override { return true; }
  bool getPosition(cVector3d& x) override {
    x = shift +
        cVector3d(0.04, 0.04 + 2e-5 * std::max(0, step - 400), 0.005 - 2e-5 * std::min(400, step));
    return true;
  }
  bool getLinearVelocity(cVector3d& v) override {
    v = cVector3d(0, step < 400 ? 0 : 0.02, step < 400 ? -0.02 : 0);
    return true;
  }
  bool setForceAndTorqueAndGripperForce(const cVector3d& f, const cVector3d&, double) override {
    force = f;
    return true;
  }
  int step = 0;
  cVector3d shift{0, 0, 0}, force{0, 0, 0};
};

/// The C interface by itself.
struct Reference {
  palpate_library* library = nullptr;
  palpate_state* state = nullptr;
  palpate_deformation* skin = nullptr;
  Reference(const char* file, const char* skin_file) {
    require(palpate_library_load(file, &library) == PALPATE_OK &&
                palpate_state_create(library, nullptr, &state) == PALPATE_OK &&
                palpate_deformation_load(library, skin_file, &skin) == PALPATE_OK,
            palpate_last_error());
  }
  ~Reference() {
    palpate_deformation_destroy(skin);
    palpate_state_destroy(state);
    palpate_library_destroy(library);
  }
  Reference(const Reference&) = delete;
  Reference& operator=(const Reference&) = delete;
};

double difference(const cVector3d& a, const double* b) {
  return std::max({std::abs(a.x() - b[0]), std::abs(a.y() - b[1]), std::abs(a.z() - b[2])});
}

/// @return the largest difference of a mesh from the skin of the reference.
double skin_difference(PalpateBody& body, const Reference& c, double& deepest) {
  body.updateSkin();
  std::vector<double> x(3 * body.getNumVertices());
  require(palpate_deform(c.state, c.skin, x.data(), x.size() / 3) == PALPATE_OK,
          palpate_last_error());
  double off = 0;
  for (unsigned i = 0; i < body.getNumVertices(); ++i) {
    const cVector3d at = body.m_vertices->getLocalPos(i);
    off = std::max(off, difference(at, &x[3 * i]));
    deepest = std::min(deepest, at.z());
  }
  return off;
}

/// The body lies at `shift`; the device strokes it there.
void stroke(const char* library, const char* skin, const cVector3d& shift, double error) {
  Reference c(library, skin);
  chai3d::cWorld world;
  auto* body = new PalpateBody(library, skin);
  world.addChild(body);
  body->setTimeStep(1e-3);
  body->setLocalPos(shift);
  const auto device = std::make_shared<Stroke>();
  device->shift = shift;
  auto* tool = new chai3d::cToolCursor(&world);
  world.addChild(tool);
  tool->setHapticDevice(device);
  require(tool->start(), "the tool does not start");
  double largest = 0, deepest = 0;
  for (; device->step < 600; ++device->step) {
    world.computeGlobalPositions(true);
    tool->updateFromDevice();
    tool->computeInteractionForces();
    tool->applyToDevice();
    cVector3d x, v;
    device->getPosition(x);
    device->getLinearVelocity(v);
    x -= shift;
    double force[3];
    const std::uint32_t status = palpate_step(c.state, &x(0), &v(0), 1e-3, force);
    require(difference(device->force, force) <= error,
            "a force differs at step " + std::to_string(device->step));
    require(tool->isInContact(body) == ((status & PALPATE_CONTACT) != 0),
            "the contact is not that of the tool");
    largest = std::max(largest, std::abs(force[2]));
  }
  const double depth = body->observation().depth;
  require(depth > 0.0029 && std::abs(largest - 17000 * depth * depth) < 1e-6,
          "the largest force is " + std::to_string(largest) + " N");
  require(skin_difference(*body, c, deepest) <= error, "the skin differs");
  require(deepest < -0.001 && deepest > -0.0031,
          "the skin goes to " + std::to_string(deepest) + " m");
  tool->stop();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    require(argc == 3, "give LIBRARY SKIN");
    stroke(argv[1], argv[2], {0, 0, 0}, 0);
    stroke(argv[1], argv[2], {1, -2, 3}, 1e-9);  // positions of the world are rounded there
    return 0;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "same_bits: %s\n", error.what()), 1;
  }
}
