// SPDX-License-Identifier: AGPL-3.0-or-later
// The installed interface from C++: two tools on one library, a body that lies elsewhere, a library
// from memory.
#include <palpate.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

namespace {

int complain(const char* what) {
  std::fprintf(stderr, "consumer: %s (%s)\n", what, palpate_last_error());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return complain("usage: consumer LIBRARY");
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  palpate_library* library = nullptr;
  if (palpate_library_load_memory(bytes.data(), bytes.size(), &library) != PALPATE_OK) {
    return complain("cannot load from memory");
  }
  palpate_settings settings;
  palpate_settings_default(&settings);
  settings.friction = 0.3;
  palpate_state* tools[2] = {nullptr, nullptr};
  for (palpate_state*& tool : tools) {
    if (palpate_state_create(library, &settings, &tool) != PALPATE_OK) return complain("no state");
  }
  const double shift[3] = {1, 2, 3};
  const double rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (palpate_state_set_pose(tools[1], shift, rotation) != PALPATE_OK) return complain("no pose");
  const double velocity[3] = {0, 0, 0};
  double force[2][3] = {};
  for (int i = -1; i <= 40; ++i) {
    const double here[3] = {0.031, 0.042, -1e-4 * i};
    const double there[3] = {1.051, 2.022, 3 - 0.5e-4 * i};
    palpate_step(tools[0], here, velocity, 1e-3, force[0]);
    palpate_step(tools[1], there, velocity, 1e-3, force[1]);
  }
  // f = 100 k d^2, k = 170 N/m; the first tool went in by 4 mm, the second by 2 mm.
  const double expected[2] = {100 * 170 * 0.004 * 0.004, 100 * 170 * 0.002 * 0.002};
  for (int t = 0; t < 2; ++t) {
    palpate_observation seen{};
    seen.size = sizeof seen;
    palpate_observe(tools[t], &seen);
    const double reach = std::sqrt(expected[t] / 17000) - seen.offset;
    if (std::fabs(force[t][2] - 17000 * reach * reach) > 1e-6) return complain("wrong force");
    palpate_state_destroy(tools[t]);
  }
  palpate_library_destroy(library);
  std::printf("palpate %s from C++: two tools, %.4f N and %.4f N\n", palpate_version(), force[0][2],
              force[1][2]);
}
