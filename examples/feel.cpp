// SPDX-License-Identifier: Apache-2.0
// find_package(palpate REQUIRED), target_link_libraries(... palpate::palpate)
//
//   feel library.h5 1 0 0
//
// A tip goes to the middle of the body from the side that is given, at 0.1 m/s, until it is 3 mm
// deep.
#include <palpate.h>

#include <cstdio>
#include <cstdlib>
#include <memory>

int main(int argc, char** argv) {
  palpate_library* library = nullptr;
  palpate_state* state = nullptr;
  const auto fail = [](const char* why) { return std::fprintf(stderr, "feel: %s\n", why), 1; };
  if (argc < 5) return fail("give LIBRARY X Y Z");
  if (palpate_library_load(argv[1], &library)) return fail(palpate_last_error());
  const std::unique_ptr<palpate_library, decltype(&palpate_library_destroy)> body(
      library, palpate_library_destroy);
  if (palpate_state_create(library, nullptr, &state)) return fail(palpate_last_error());
  const std::unique_ptr<palpate_state, decltype(&palpate_state_destroy)> tool(
      state, palpate_state_destroy);
  palpate_library_info box{sizeof box};
  palpate_observation seen{sizeof seen};
  palpate_library_describe(library, &box);
  double at[3], v[3], f[3];
  for (int k = 0; k < 3; ++k) v[k] = -0.1 * std::atof(argv[2 + k]);
  for (int i = -2000; i < 2000 && seen.depth < 0.003; ++i) {  // your force loop, 1 kHz
    for (int k = 0; k < 3; ++k) at[k] = (box.low[k] + box.high[k]) / 2 + 1e-3 * i * v[k];
    palpate_step(state, at, v, 1e-3, f);
    palpate_observe(state, &seen);
  }
  std::printf("(%.4f, %.4f, %.4f) N, %.3f mm deep\n", f[0], f[1], f[2], 1e3 * seen.depth);
}
