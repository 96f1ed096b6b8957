// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "app/pipeline/events.hpp"

namespace palpate::app {

/// The sink, and while a campaign runs a line on the standard error when SIGINT, SIGTERM or SIGHUP
/// ends the process: how many sites are kept, and how to go on. The journal has every finished site
/// at any moment, so nothing else is to be done then. One such sink a process.
EventSink with_interruption_note(EventSink sink);

}  // namespace palpate::app
