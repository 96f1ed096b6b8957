// SPDX-License-Identifier: Apache-2.0
#include "PalpateForceFeedback.h"

#include <sofa/core/ObjectFactory.h>
#include <sofa/simulation/AnimateEndEvent.h>

namespace palpate_sofa {

namespace {

constexpr double kFirst = 1e-3;  // s, the time before the first step, which nobody measured

}  // namespace

PalpateForceFeedback::PalpateForceFeedback()
    : d_library(initData(&d_library, "library", "response library of palpate: .plib or .h5")),
      d_skin(initData(&d_skin, "skin", "deformation.pdef of the library; empty: no skin")),
      d_metresPerUnit(initData(&d_metresPerUnit, SReal(1), "metresPerUnit",
                               "length of a unit of the scene, m")),
      d_body(initData(&d_body, "body", "position and orientation of the library in the scene")),
      d_skinPosition(initData(&d_skinPosition, "skinPosition", "vertices of the skin as pressed")),
      d_skinTriangles(initData(&d_skinTriangles, "skinTriangles", "triangles of the skin")) {
  f_listening.setValue(true);
  d_skinPosition.setReadOnly(true);
  d_skinTriangles.setReadOnly(true);
}

void PalpateForceFeedback::init() {
  ForceFeedback::init();
  m_metres = d_metresPerUnit.getValue();
  m_body = d_body.getValue();
  d_componentState.setValue(sofa::core::objectmodel::ComponentState::Invalid);
  if (!load()) {
    msg_error() << palpate_last_error();
    return;
  }
  d_componentState.setValue(sofa::core::objectmodel::ComponentState::Valid);
  showTriangles();
  showSkin();
}

bool PalpateForceFeedback::load() {
  palpate_library* library = nullptr;
  palpate_state* state = nullptr;
  palpate_deformation* skin = nullptr;
  if (palpate_library_load(d_library.getFullPath().c_str(), &library) < 0) return false;
  m_library.reset(library);
  if (palpate_state_create(library, nullptr, &state) < 0) return false;
  m_state.reset(state);
  if (d_skin.getValue().empty()) return true;
  if (palpate_deformation_load(library, d_skin.getFullPath().c_str(), &skin) < 0) return false;
  m_skin.reset(skin);
  return true;
}

void PalpateForceFeedback::showTriangles() {
  if (!m_skin) return;
  palpate_deformation_info info{};
  info.size = sizeof info;
  palpate_deformation_describe(m_skin.get(), &info);
  m_positions.resize(3 * static_cast<std::size_t>(info.vertices));
  std::vector<std::int32_t> corners(3 * static_cast<std::size_t>(info.triangles));
  palpate_deformation_triangles(m_skin.get(), corners.data(), corners.size() / 3);
  auto triangles = sofa::helper::getWriteOnlyAccessor(d_skinTriangles);
  triangles.resize(corners.size() / 3);
  for (std::size_t m = 0; m < triangles.size(); ++m)
    for (sofa::Size k = 0; k < 3; ++k)
      triangles[m][k] = static_cast<sofa::Index>(corners[3 * m + k]);
}

void PalpateForceFeedback::showSkin() {
  if (!m_skin) return;
  if (palpate_deform(m_state.get(), m_skin.get(), m_positions.data(), m_positions.size() / 3) < 0) {
    msg_error() << palpate_last_error();
    return;
  }
  auto shown = sofa::helper::getWriteOnlyAccessor(d_skinPosition);
  shown.resize(m_positions.size() / 3);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const Vec3 x(m_positions[3 * i], m_positions[3 * i + 1], m_positions[3 * i + 2]);
    shown[i] = m_body.getCenter() + m_body.getOrientation().rotate(x / m_metres);
  }
}

void PalpateForceFeedback::handleEvent(sofa::core::objectmodel::Event* event) {
  if (m_state && sofa::simulation::AnimateEndEvent::checkEventType(event)) showSkin();
}

double PalpateForceFeedback::elapsed() {
  const auto now = std::chrono::steady_clock::now();
  const double dt = m_last ? std::chrono::duration<double>(now - *m_last).count() : kFirst;
  m_last = now;
  return dt > 0 ? dt : kFirst;
}

PalpateForceFeedback::Vec3 PalpateForceFeedback::touch(const Vec3& position, const Vec3& velocity,
                                                       double dt) {
  if (!m_state || !d_activate.getValue()) return {};
  const auto& turn = m_body.getOrientation();
  const Vec3 x = turn.inverseRotate(position - m_body.getCenter()) * m_metres;
  const Vec3 v = turn.inverseRotate(velocity) * m_metres;
  const double at[3] = {x[0], x[1], x[2]}, speed[3] = {v[0], v[1], v[2]};
  double force[3];
  palpate_step(m_state.get(), at, speed, dt, force);
  return turn.rotate(Vec3(force[0], force[1], force[2]));
}

void PalpateForceFeedback::computeForce(SReal x, SReal y, SReal z, SReal, SReal, SReal, SReal,
                                        SReal& fx, SReal& fy, SReal& fz) {
  const Vec3 position(x, y, z);
  const double dt = elapsed();
  const Vec3 velocity = m_lastPosition ? (position - *m_lastPosition) / dt : Vec3();
  m_lastPosition = position;
  const Vec3 force = touch(position, velocity, dt);
  fx = force[0];
  fy = force[1];
  fz = force[2];
}

void PalpateForceFeedback::computeWrench(const Transform& world_H_tool,
                                         const SpatialVector& V_tool_world,
                                         SpatialVector& W_tool_world) {
  W_tool_world.clear();
  W_tool_world.setForce(
      touch(world_H_tool.getOrigin(), V_tool_world.getLinearVelocity(), elapsed()));
}

}  // namespace palpate_sofa

// What SOFA asks of a plug-in.
extern "C" {
SOFA_EXPORT_DYNAMIC_LIBRARY void initExternalModule() {}
SOFA_EXPORT_DYNAMIC_LIBRARY const char* getModuleName() {
  return "PalpateSofa";
}
SOFA_EXPORT_DYNAMIC_LIBRARY const char* getModuleVersion() {
  return palpate_version();
}
SOFA_EXPORT_DYNAMIC_LIBRARY const char* getModuleLicense() {
  return "Apache-2.0";
}
SOFA_EXPORT_DYNAMIC_LIBRARY const char* getModuleDescription() {
  return "Forces of palpate libraries for haptic devices";
}
SOFA_EXPORT_DYNAMIC_LIBRARY void registerObjects(sofa::core::ObjectFactory* factory) {
  factory->registerObjects(
      sofa::core::ObjectRegistrationData("Force feedback of a palpate response library.")
          .add<palpate_sofa::PalpateForceFeedback>());
}
}
