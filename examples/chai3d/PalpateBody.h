// SPDX-License-Identifier: Apache-2.0
// A soft body of palpate in a world of CHAI3D: a mesh that is its skin, and a haptic effect that is
// its force.
//
//   auto* body = new PalpateBody("library.plib", "deformation.pdef");
//   world->addChild(body);
//   // the haptic thread, as ever: updateFromDevice, computeInteractionForces, applyToDevice
//   // the graphics thread, before renderView: body->updateSkin();
//
// The world is in metres, and one tool touches the body. It has no collision detector: the finger
// proxy does not see it.
#pragma once

#include <palpate.h>
#include <world/CMesh.h>

#include <string>
#include <vector>

class PalpateBody : public chai3d::cMesh {
 public:
  /// skin: a deformation.pdef of the library; empty: the response surface, which stays as it is.
  /// Throws std::runtime_error where a file cannot be loaded.
  explicit PalpateBody(const std::string& library, const std::string& skin = {});
  ~PalpateBody() override;
  PalpateBody(const PalpateBody&) = delete;
  PalpateBody& operator=(const PalpateBody&) = delete;

  /// Time between two calls of the haptic thread, s; 0 (default): it is measured.
  void setTimeStep(double seconds);
  /// The vertices as the last force step left them. For the graphics thread; never delays the
  /// haptic thread.
  void updateSkin();
  /// The middle of the box around the library, in the frame of the body.
  chai3d::cVector3d middle() const;
  /// After the last force step. For the haptic thread.
  palpate_observation observation() const;

 private:
  class Touch;
  void makeSkin();

  palpate_library* library_ = nullptr;
  palpate_state* state_ = nullptr;
  palpate_deformation* skin_ = nullptr;
  Touch* touch_ = nullptr;  // of the list of effects
  std::vector<double> positions_;
};
