// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate {

/// The columns of a step of a session as text, with their units.
inline constexpr const char* kStepColumns =
    "time_ns,position_x_m,position_y_m,position_z_m,velocity_x_m_s,velocity_y_m_s,velocity_z_m_s,"
    "force_x_N,force_y_N,force_z_N,contact_x_m,contact_y_m,contact_z_m,depth_m,lateral_m,offset_m,"
    "energy_J,tank_J,absorbed_J,element,status,latency_ns";

}  // namespace palpate
