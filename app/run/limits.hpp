// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "app/run/live_session.hpp"

namespace palpate::app {

/// Refuses settings of a session that no device or body is made for, before a device is opened or a
/// file is written. @throws Error(Configuration) that names the option of `palpate run`, its value
/// and its range.
void require_within_limits(const LiveSettings& live);

}  // namespace palpate::app
