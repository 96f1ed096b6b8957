// SPDX-License-Identifier: AGPL-3.0-or-later
// A case, a body and curves on disk, without a mesher: what later stages read.
#pragma once

#include <fstream>
#include <utility>
#include <vector>

#include "app/pipeline/freshness.hpp"
#include "format/sha256.hpp"
#include "tests/support/sample_artifacts.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {

struct StageWorkspace {
  StageWorkspace() {
    std::ofstream(folder / "block.toml") << R"([surface]
file = "block.off"
unit = "mm"
[mesh]
patch_spacing = "10 mm"
[indentation]
depth = "6 mm"
[[support]]
shape = "sphere"
centre = ["0 mm", "0 mm", "0 mm"]
radius = "1 mm"
[[material]]
young = "10 kPa"
poisson = 0.45
)";
    std::ofstream(folder / "block.off") << "OFF";
    space = make_workspace(folder / "block.toml", folder.path().string(), 1);
    body = samples::body(3);
    body.provenance.steps = {make_stage_step(space, Stage::Mesh, {})};
    write_body(space.body(), body);
  }

  /// Curves of these sites as precompute would write them, each failed.
  Curves failed_curves(const std::vector<std::int32_t>& vertices) const {
    Curves curves;
    curves.tool = {"sphere", 0.005, "frictionless"};
    curves.depth = 0.006;
    curves.lateral_travel = 0.003;
    curves.body_sha256 = sha256_of_file(space.body());
    for (const std::int32_t vertex : vertices)
      curves.sites.push_back({vertex, SiteStatus::Failed, "touch was not found", 0.5, {}});
    curves.provenance = body.provenance;
    curves.provenance.steps.push_back(make_stage_step(space, Stage::Precompute, {}));
    return curves;
  }

  samples::TemporaryFolder folder;
  Workspace space;
  Body body;
};

}  // namespace palpate::app
