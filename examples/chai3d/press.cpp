// SPDX-License-Identifier: Apache-2.0
// press LIBRARY X Y Z [SKIN]: a tool of CHAI3D goes to the middle of the body from the side that is
// given, at 0.1 m/s, until it is 3 mm deep. The device is simulated: put that of a
// cHapticDeviceHandler in its place to feel the body.
#include <devices/CGenericHapticDevice.h>
#include <tools/CToolCursor.h>
#include <world/CWorld.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>

#include "PalpateBody.h"

namespace {

/// A hand that is at `middle` after 2 s, whatever the force; each force is a millisecond.
class SteadyHand : public chai3d::cGenericHapticDevice {
 public:
  SteadyHand(const chai3d::cVector3d& middle, const chai3d::cVector3d& velocity)
      : middle_(middle), velocity_(velocity) {
    m_deviceAvailable = true;
  }
  bool open() override { return m_deviceReady = true; }
  bool close() override { return true; }
  bool getPosition(chai3d::cVector3d& position) override {
    position = middle_ + 1e-3 * step_ * velocity_;
    return true;
  }
  bool getLinearVelocity(chai3d::cVector3d& velocity) override {
    velocity = velocity_;
    return true;
  }
  bool setForceAndTorqueAndGripperForce(const chai3d::cVector3d& force, const chai3d::cVector3d&,
                                        double) override {
    force_ = force;
    ++step_;
    return true;
  }
  const chai3d::cVector3d& force() const { return force_; }

 private:
  chai3d::cVector3d middle_, velocity_, force_{0, 0, 0};
  int step_ = -2000;
};

void press(char** words, const char* skin) {
  chai3d::cWorld world;
  auto* body = new PalpateBody(words[0], skin);  // the world owns it
  world.addChild(body);
  body->setTimeStep(1e-3);
  const chai3d::cVector3d velocity(-0.1 * std::atof(words[1]), -0.1 * std::atof(words[2]),
                                   -0.1 * std::atof(words[3]));
  const auto hand = std::make_shared<SteadyHand>(body->middle(), velocity);
  auto* tool = new chai3d::cToolCursor(&world);
  world.addChild(tool);
  tool->setHapticDevice(hand);
  tool->start();
  for (int i = 0; i < 4000 && body->observation().depth < 0.003; ++i) {  // the haptic thread
    world.computeGlobalPositions(true);
    tool->updateFromDevice();
    tool->computeInteractionForces();
    tool->applyToDevice();
  }
  body->updateSkin();  // the graphics thread
  std::printf("(%.4f, %.4f, %.4f) N, %.3f mm deep\n", hand->force().x(), hand->force().y(),
              hand->force().z(), 1e3 * body->observation().depth);
  tool->stop();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return std::fprintf(stderr, "press: give LIBRARY X Y Z [SKIN]\n"), 1;
  try {
    press(argv + 1, argc > 5 ? argv[5] : "");
    return 0;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "press: %s\n", error.what()), 1;
  }
}
