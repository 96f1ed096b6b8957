// SPDX-License-Identifier: AGPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <regex>

#include "app/pipeline/campaign_sites.hpp"
#include "app/pipeline/freshness.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/stage_input.hpp"
#include "app/pipeline/stages.hpp"
#include "fem/campaign/finer_mesh.hpp"
#include "fitting/response/mesh_error.hpp"
#include "format/body.hpp"
#include "format/number_text.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> parts_in(const fs::path& folder) {
  static const std::regex name(R"(curves\.\d+-of-\d+\.h5)");
  std::vector<fs::path> parts;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      if (std::regex_match(entry.path().filename().string(), name)) parts.push_back(entry.path());
  std::sort(parts.begin(), parts.end());
  if (parts.empty())
    throw Error(ErrorKind::Configuration, folder.string(), "contains no curves.I-of-N.h5",
                "run `palpate precompute CASE --shard I/N` for each I of 1..N first");
  return parts;
}

/// Refuses a part of another body, case or version of palpate.
Curves read_part(const Workspace& space, const std::string& body_sha256, const fs::path& part) {
  Curves curves = read_input(part, "precompute --shard I/N", read_curves);
  const std::string why = curves.body_sha256 != body_sha256
                              ? "it was computed on another body"
                              : stale_reason(space, Stage::Precompute, curves.provenance);
  if (!why.empty())
    throw Error(ErrorKind::Configuration, part.string(),
                "it does not belong to this campaign: " + why,
                "compute this shard again with the current case and body, or leave it out");
  return curves;
}

std::string listed(const std::vector<std::int32_t>& vertices) {
  constexpr std::size_t kMost = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, vertices.size()); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(vertices[i]);
  return vertices.size() > kMost ? text + ", ..." : text;
}

/// Sites by vertex, each from one part only.
class Collection {
 public:
  void add(Curves part, const fs::path& file) {
    for (SiteCurves& site : part.sites) {
      const auto [before, is_new] = file_of_.try_emplace(site.vertex, file);
      if (!is_new)
        throw Error(ErrorKind::Configuration, file.string(),
                    fmt::format("site {} is in {} as well", site.vertex, before->second.string()),
                    "give each part of one division of the sites once");
      sites_.push_back(std::move(site));
    }
  }

  /// @throws Error when a site of the body is in no part.
  std::vector<SiteCurves> complete_set(const Body& body, const fs::path& folder) {
    std::vector<std::int32_t> missing;
    for (const std::int32_t vertex : sites_of(body))
      if (!file_of_.contains(vertex)) missing.push_back(vertex);
    if (!missing.empty())
      throw Error(ErrorKind::Configuration, folder.string(),
                  fmt::format("{} in none of the parts: {}",
                              count_text(missing.size(), "site is", "sites are"), listed(missing)),
                  "compute the missing shards, then merge again");
    std::sort(sites_.begin(), sites_.end(),
              [](const SiteCurves& a, const SiteCurves& b) { return a.vertex < b.vertex; });
    return std::move(sites_);
  }

 private:
  std::map<std::int32_t, fs::path> file_of_;
  std::vector<SiteCurves> sites_;
};

double cpu_seconds(const std::vector<SiteCurves>& sites) {
  double sum = 0;
  for (const SiteCurves& site : sites) sum += site.cpu_seconds;
  return sum;
}

}  // namespace

SiteCounts run_merge(const Workspace& space, std::vector<fs::path> parts, const EventSink& emit) {
  const Body body = read_input(space.body(), "mesh", read_body);
  const std::string body_sha256 = sha256_of_file(space.body());
  if (parts.empty()) parts = parts_in(space.out);
  Curves merged;
  Collection collection;
  std::vector<std::pair<std::string, std::string>> facts;
  for (const fs::path& file : parts) {
    Curves part = read_part(space, body_sha256, file);
    facts.emplace_back("part " + file.filename().string(), sha256_of_file(file));
    merged.tool = part.tool;
    merged.depth = part.depth;
    merged.lateral_travel = part.lateral_travel;
    merged.relaxation = part.relaxation;
    collection.add(std::move(part), file);
  }
  merged.body_sha256 = body_sha256;
  merged.sites = collection.complete_set(body, space.out);
  fitting::bound_mesh_errors(merged, fem::at_sharp_edges(body, merged.tool, merged.depth));
  facts.emplace_back("cpu_seconds", fmt::format("{:.3f}", cpu_seconds(merged.sites)));
  append(merged.provenance, body.provenance,
         make_stage_step(space, Stage::Precompute, std::move(facts)));
  write_curves(space.curves(), merged);
  const SiteCounts counts = count_sites(merged);
  emit(MergeFinished{merged.sites.size(), parts.size(), counts, space.curves()});
  return counts;
}

}  // namespace palpate::app
