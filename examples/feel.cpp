// SPDX-License-Identifier: Apache-2.0
// find_package(palpate REQUIRED), target_link_libraries(... palpate::palpate)
#include <palpate.h>

#include <array>
#include <cstdio>
#include <memory>

int main(int argc, char** argv) {
  palpate_library* loaded = nullptr;
  palpate_state* created = nullptr;
  palpate_settings settings;
  palpate_settings_default(&settings);
  settings.friction = 0.3;
  if (argc < 2 || palpate_library_load(argv[1], &loaded) != PALPATE_OK) return 1;
  const std::unique_ptr<palpate_library, void (*)(palpate_library*)> library(
      loaded, palpate_library_destroy);
  if (palpate_state_create(loaded, &settings, &created) != PALPATE_OK) return 1;
  const std::unique_ptr<palpate_state, void (*)(palpate_state*)> state(created,
                                                                       palpate_state_destroy);
  std::array<double, 3> force{};
  const std::array<double, 3> velocity{0, 0, -0.1};
  for (int i = 0; i < 40; ++i) {  // your force loop
    const std::array<double, 3> position{0.031, 0.042, 0.0005 - 1e-4 * i};
    palpate_step(created, position.data(), velocity.data(), 1e-3, force.data());
  }
  std::printf("%.4f N at %.1f mm\n", force[2], 3.4);
}
