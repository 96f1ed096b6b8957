// SPDX-License-Identifier: AGPL-3.0-or-later
// A serial chain with a known closed form.
#pragma once

#include "runtime/devices/serial_chain.hpp"

namespace palpate::test {

/// Two links of 0.2 m and 0.15 m in the plane, on a turntable.
inline runtime::SerialChain arm() {
  using runtime::JointKind;
  return runtime::SerialChain({{JointKind::Revolute, {0, 0, 1}, {0, 0, 0}},
                               {JointKind::Revolute, {0, 1, 0}, {0, 0, 0.1}},
                               {JointKind::Revolute, {0, 1, 0}, {0.2, 0, 0.1}}},
                              {0.35, 0, 0.1});
}

}  // namespace palpate::test
