// SPDX-License-Identifier: AGPL-3.0-or-later
// In the place of libFuzzer, for compilers without it: random_inputs RUNS, the same inputs each
// time.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);
extern "C" int inputs_felt();

int main(int count, char** arguments) {
  const int runs = count > 1 ? std::atoi(arguments[1]) : 1000;
  std::mt19937_64 random(1);
  for (int run = 0; run < runs; ++run) {
    std::vector<std::uint8_t> bytes(13 * (1 + random() % 4) + random() % 2);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%d inputs, of which %d made a library that was felt\n", runs, inputs_felt());
  return inputs_felt() > 0 && inputs_felt() < runs ? 0 : 1;
}
