// SPDX-License-Identifier: AGPL-3.0-or-later
// Writes one artifact of each kind into a folder, with its content as text beside it, for
// file_format_test.py to read with other software.
#include <cstdio>
#include <filesystem>

#include "format/crash_safe_file.hpp"
#include "tests/support/sample_artifacts.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s <folder>\n", argv[0]);
    return 2;
  }
  namespace samples = palpate::samples;
  const std::filesystem::path folder = argv[1];
  try {
    std::filesystem::create_directories(folder);
    palpate::write_body(folder / "body.h5", samples::body(1));
    palpate::write_body(folder / "sprung.h5", samples::sprung_body(1));
    palpate::write_body(folder / "curved.h5", samples::curved_body(1));
    palpate::write_curves(folder / "curves.h5", samples::curves(1));
    palpate::write_library(folder / "library.h5", samples::library(1));
    palpate::write_library(folder / "coupled.h5", samples::coupled_library(1));
    palpate::write_library(folder / "relaxing.h5", samples::relaxing_library(1));
    palpate::write_library(folder / "leaning.h5", samples::leaning_library(0));
    palpate::write_library(folder / "soft.h5", samples::soft_library(3));
    palpate::write_curves(folder / "relaxing_curves.h5", samples::relaxing_curves(1));
    palpate::write_recording(folder / "recording.h5", samples::recording(1));
    palpate::write_file_crash_safely(folder / "body.txt", samples::dump(samples::body(1)));
    palpate::write_file_crash_safely(folder / "sprung.txt", samples::dump(samples::sprung_body(1)));
    palpate::write_file_crash_safely(folder / "curved.txt", samples::dump(samples::curved_body(1)));
    palpate::write_file_crash_safely(folder / "curves.txt", samples::dump(samples::curves(1)));
    palpate::write_file_crash_safely(folder / "library.txt", samples::dump(samples::library(1)));
    palpate::write_file_crash_safely(folder / "coupled.txt",
                                     samples::dump(samples::coupled_library(1)));
    palpate::write_file_crash_safely(folder / "relaxing.txt",
                                     samples::dump(samples::relaxing_library(1)));
    palpate::write_file_crash_safely(folder / "leaning.txt",
                                     samples::dump(samples::leaning_library(0)));
    palpate::write_file_crash_safely(folder / "soft.txt", samples::dump(samples::soft_library(3)));
    palpate::write_file_crash_safely(folder / "recording.txt",
                                     samples::dump(samples::recording(1)));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
