// SPDX-License-Identifier: AGPL-3.0-or-later
// write_sample_report <folder>: the reports that test_report_page.py opens in a browser.
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>

#include "app/report/report.hpp"
#include "synthetic.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_sample_report <folder>\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  auto all = palpate::testing::synthetic(3, 2);
  palpate::ReportInput input{&all.body,      &all.curves,          &all.library,
                             &all.recording, "Lump with a nodule", 356129};
  palpate::write_report(input, folder / "full.html");

  // A rim too sharp for the slide to be bounded: on one triangle, and so for the body.
  auto& certificate = all.library.certificate;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  certificate.slip = certificate.triangles[0].slip = kInfinity;
  certificate.worst_triangle = 0;
  for (auto& device : certificate.devices) {
    if (!std::isnan(device.damping)) device.lowest_rate = kInfinity;
  }
  palpate::write_report(input, folder / "unbounded.html");

  // Everything that may be missing is missing, and every name is hostile.
  const std::string hostile =
      "</script><script>document.title='owned'</script><img src=x onerror=boom()> & \"'";
  all.body.name = all.library.name = all.curves.tool.shape = hostile;
  all.library.certificate = {};
  all.library.provenance.steps[0].stage = all.library.provenance.steps[0].facts[0].second = hostile;
  all.curves.provenance = all.body.provenance = {};
  for (auto& site : all.curves.sites) site.cpu_seconds = 0;
  input.title = hostile;
  input.recording = nullptr;
  input.library_bytes = 0;
  palpate::write_report(input, folder / "bare.html");
}
