// SPDX-License-Identifier: Apache-2.0
// The force of a palpate library for the haptic devices of SOFA. In a scene:
//
//   <PalpateForceFeedback name="touch" activate="true" library="gel.plib" skin="deformation.pdef"
//   metresPerUnit="0.001"/> <OglModel position="@touch.skinPosition"
//   triangles="@touch.skinTriangles"/>
#pragma once

#include <palpate.h>
#include <sofa/component/haptics/ForceFeedback.h>
#include <sofa/core/objectmodel/DataFileName.h>
#include <sofa/core/topology/BaseMeshTopology.h>
#include <sofa/defaulttype/RigidTypes.h>
#include <sofa/type/vector.h>

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

namespace palpate_sofa {

/// Steps a state of palpate in the haptic thread of the driver, and shows its skin in the thread of
/// the simulation. The body stays where `body` puts it, and one device touches it.
class PalpateForceFeedback : public sofa::component::haptics::ForceFeedback {
 public:
  SOFA_CLASS(PalpateForceFeedback, sofa::component::haptics::ForceFeedback);
  using Vec3 = sofa::type::Vec<3, SReal>;
  using Transform = sofa::type::Transform<SReal>;
  using SpatialVector = sofa::type::SpatialVector<SReal>;

  sofa::core::objectmodel::DataFileName d_library;  ///< a .plib, or a library.h5
  sofa::core::objectmodel::DataFileName d_skin;     ///< a deformation.pdef of the library, or none
  sofa::Data<SReal> d_metresPerUnit;                ///< 0.001 where the scene is in millimetres
  sofa::Data<sofa::defaulttype::RigidTypes::Coord> d_body;  ///< of the library in the scene
  sofa::Data<sofa::type::vector<Vec3>> d_skinPosition;      ///< in the scene
  sofa::Data<sofa::core::topology::BaseMeshTopology::SeqTriangles> d_skinTriangles;

  void init() override;
  /// For drivers that give a position alone: the velocity is that between two calls. Force in N.
  void computeForce(SReal x, SReal y, SReal z, SReal u, SReal v, SReal w, SReal q, SReal& fx,
                    SReal& fy, SReal& fz) override;
  /// For drivers that give a frame and a velocity. Force in N, no torque.
  void computeWrench(const Transform& world_H_tool, const SpatialVector& V_tool_world,
                     SpatialVector& W_tool_world) override;
  /// After each step of the simulation: the skin.
  void handleEvent(sofa::core::objectmodel::Event* event) override;

 protected:
  PalpateForceFeedback();

 private:
  template <class T, void (*destroy)(T*)>
  struct Destroy {
    void operator()(T* handle) const { destroy(handle); }
  };
  template <class T, void (*destroy)(T*)>
  using Handle = std::unique_ptr<T, Destroy<T, destroy>>;

  bool load();
  void showTriangles();
  void showSkin();
  double elapsed();
  Vec3 touch(const Vec3& position, const Vec3& velocity, double dt);

  Handle<palpate_library, palpate_library_destroy> m_library;
  Handle<palpate_state, palpate_state_destroy> m_state;
  Handle<palpate_deformation, palpate_deformation_destroy> m_skin;
  std::vector<double> m_positions;
  // Of the haptic thread, set before it starts.
  double m_metres = 1;
  sofa::defaulttype::RigidTypes::Coord m_body;
  std::optional<std::chrono::steady_clock::time_point> m_last;
  std::optional<Vec3> m_lastPosition;
};

}  // namespace palpate_sofa
