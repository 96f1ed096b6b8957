// SPDX-License-Identifier: AGPL-3.0-or-later
// touch_forces: reads positions of a tip, m, three numbers a line, and writes the forces on the
// tool that the C interface gives for them on the library of skin.html, one step of 1 ms each; then
// a line "skin" and the vertices of the skin after the last step.
// touch_forces session STEP: the same for the first STEP steps of the session of skin.html.
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

#include "tests/unit/app/report/skins.hpp"
#include "tests/unit/app/report/synthetic.hpp"

namespace {

void print(const palpate::Vec3& x) {
  std::printf("%.17g %.17g %.17g\n", x[0], x[1], x[2]);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace palpate;
  const testing::Synthetic all = testing::synthetic(3, 1);
  testing::TouchedSkin skin(all.body, all.library);
  Vec3 x, force;
  if (argc == 3) {
    const auto steps = static_cast<std::size_t>(std::atol(argv[2]));
    for (std::size_t i = 0; i < steps; ++i)
      skin.step(all.recording.steps.at(i).position, force.data());
  }
  while (argc < 3 && std::cin >> x[0] >> x[1] >> x[2]) {
    skin.step(x, force.data());
    print(force);
  }
  std::puts("skin");
  for (const Vec3& vertex : skin.deformed()) print(vertex);
  return 0;
}
