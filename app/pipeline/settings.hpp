// SPDX-License-Identifier: AGPL-3.0-or-later
// The settings of each stage: those of the case, with what follows from several of its keys.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/pipeline/workspace.hpp"
#include "app/remaining_time.hpp"
#include "fem/campaign/campaign.hpp"
#include "fitting/certificate/certify.hpp"
#include "fitting/response/fit_settings.hpp"
#include "mesher/mesher.hpp"

namespace palpate::app {

enum class Stage { Mesh, Precompute, Fit, Certify };

/// "mesh", "precompute", "fit", "certify": in commands and in the provenance.
std::string stage_name(Stage stage);

/// Whether sites are chosen adaptively and all other responses interpolated.
bool is_adaptive(const Workspace& space);

/// Whether surface and responses are measured, so that nothing is meshed or solved.
bool is_measured(const Workspace& space);
std::filesystem::path records_of(const Workspace& space);  ///< the sidecar of a measured body

mesher::Settings mesh_settings(const Workspace& space);
fem::CampaignSettings campaign_settings(const Workspace& space);
/// How the sites of a campaign disturb each other.
SiteSharing sharing_of(const fem::CampaignSettings& settings);
fitting::FitSettings fit_settings(const Workspace& space);

/// Reads the device profiles. @throws Error(Configuration).
fitting::CertifySettings certify_settings(const Workspace& space);

/// Reads the files that stages up to `last` need beside the artifacts, fibres and device profiles:
/// a fault of theirs is to end a campaign of hours before it begins. @throws Error(Configuration).
void check_inputs(const Workspace& space, Stage last);

/// The files that a stage reads, in the order of its provenance.
std::vector<std::filesystem::path> stage_inputs(const Workspace& space, Stage stage);

/// The part of the resolved case on which the result of a stage depends.
std::string stage_case(const Workspace& space, Stage stage);

}  // namespace palpate::app
