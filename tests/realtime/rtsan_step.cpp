// SPDX-License-Identifier: AGPL-3.0-or-later
// The force step under the RealtimeSanitizer, which ends the process at the first allocation, lock
// or blocking call between enter and exit.
//
//   rtsan_step             the ride; exit code 0
//   rtsan_step malloc|lock does what is forbidden; must be caught
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>

#include "tests/realtime/ride.hpp"

extern "C" {
void __rtsan_realtime_enter();
void __rtsan_realtime_exit();
}

namespace {

void do_forbidden(const char* what) {
  static std::mutex mutex;
  if (std::strcmp(what, "malloc") == 0) {
    void* volatile memory = std::malloc(16);
    std::free(memory);
  } else {
    const std::scoped_lock lock(mutex);
  }
}

}  // namespace

int main(int count, char** arguments) {
  palpate_state state(palpate::test::ride_body(),
                      {0.2, 0, palpate::runtime::EnergyBudget::Enforced, 400});
  std::uint32_t seen = palpate::test::ride_bits();
  __rtsan_realtime_enter();
  if (count > 1) {
    do_forbidden(arguments[1]);
  } else {
    seen = palpate::test::ride(state);
  }
  __rtsan_realtime_exit();
  std::printf("rtsan: nothing forbidden was done\n");
  return (seen & palpate::test::ride_bits()) == palpate::test::ride_bits() ? 0 : 1;
}
