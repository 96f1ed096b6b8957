// SPDX-License-Identifier: Apache-2.0
// find_package(palpate REQUIRED), target_link_libraries(... palpate::palpate); feel library.h5 1 0
// 0 A tip goes to the middle of the body from the side that is given, at 0.1 m/s, until it is 3 mm
// deep.
#include <palpate.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>

int main(int argc, char** argv) {
  palpate_library* loaded = nullptr;
  palpate_state* created = nullptr;
  palpate_settings settings;
  palpate_settings_default(&settings);
  settings.friction = 0.3;
  if (argc < 5 || palpate_library_load(argv[1], &loaded) != PALPATE_OK) return 1;
  const std::unique_ptr<palpate_library, void (*)(palpate_library*)> library(
      loaded, palpate_library_destroy);
  if (palpate_state_create(loaded, &settings, &created) != PALPATE_OK) return 1;
  const std::unique_ptr<palpate_state, void (*)(palpate_state*)> state(created,
                                                                       palpate_state_destroy);
  palpate_library_info info{};
  palpate_observation seen{};
  info.size = sizeof info, seen.size = sizeof seen;
  palpate_library_describe(loaded, &info);
  std::array<double, 3> force{}, position{}, velocity{};
  for (int i = 0; i < 5000 && seen.depth < 0.003; ++i) {  // your force loop, 1 kHz
    for (std::size_t k = 0; k < 3; ++k) {
      velocity[k] = -0.1 * std::atof(argv[2 + k]);
      position[k] = (info.low[k] + info.high[k]) / 2 + (1e-3 * i - 2) * velocity[k];
    }
    palpate_step(created, position.data(), velocity.data(), 1e-3, force.data());
    palpate_observe(created, &seen);
  }
  std::printf("(%.4f, %.4f, %.4f) N, %.3f mm deep\n", force[0], force[1], force[2],
              1e3 * seen.depth);
}
