// SPDX-License-Identifier: Apache-2.0
#include "runtime/device.hpp"

#include "format/error.hpp"

namespace palpate::runtime {

void Device::start_calls(std::function<bool()> /*call*/) {  // NOLINT: others keep it
  throw Error(ErrorKind::Internal, name(), "its driver has no thread of its own",
              "run the loop in a LoopThread");
}

}  // namespace palpate::runtime
