// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/histories.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/json_number.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"

namespace palpate::app {

using Json = nlohmann::ordered_json;

namespace {

constexpr int kSchema = 1;

Json record_json(const SiteHistory& site) {
  const measured::History& h = site.history;
  Json phases = Json::array();
  for (const measured::Phase& phase : h.phases)
    phases.push_back({{"kind", phase_name(phase.kind)},
                      {"begin", phase.begin},
                      {"end", phase.end},
                      {"from_s", h.time[phase.begin]},
                      {"to_s", h.time[phase.end - 1]}});
  return {{"file", h.name},
          {"vertex", site.vertex < 0 ? Json(nullptr) : Json(site.vertex)},
          {"held", h.control == measured::Control::Travel ? "travel" : "force"},
          {"contact_m", h.contact.displacement},
          {"contact_uncertainty_m", json_number(h.contact.uncertainty)},
          {"force_offset_N", h.baseline.offset},
          {"drift_N_per_s", h.baseline.drift},
          {"noise_N", h.baseline.noise},
          {"phases", phases},
          {"time_s", h.time},
          {"travel_m", h.travel},
          {"force_N", h.force}};
}

[[noreturn]] void refuse_file(const std::string& where, const std::string& problem) {
  refuse(where, problem, "write it again with `palpate import`");
}

SiteHistory record_of(const Json& json, const std::string& file) {
  SiteHistory site;
  measured::History& h = site.history;
  h.name = json.at("file").get<std::string>();
  const std::string where = file + ", " + h.name;
  if (!json.at("vertex").is_null()) site.vertex = json.at("vertex").get<std::int32_t>();
  h.control = json.at("held") == "travel" ? measured::Control::Travel : measured::Control::Force;
  json.at("time_s").get_to(h.time);
  json.at("travel_m").get_to(h.travel);
  json.at("force_N").get_to(h.force);
  h.contact.displacement = json.at("contact_m").get<double>();
  h.baseline.offset = json.at("force_offset_N").get<double>();
  h.baseline.drift = json.at("drift_N_per_s").get<double>();
  h.baseline.noise = json.at("noise_N").get<double>();
  if (h.time.empty() || h.travel.size() != h.time.size() || h.force.size() != h.time.size())
    refuse_file(where, "its arrays have different lengths");
  for (std::size_t i = 1; i < h.time.size(); ++i)
    if (!(h.time[i] > h.time[i - 1])) refuse_file(where, "its time does not increase");
  for (const Json& phase : json.at("phases")) {
    const auto kind = measured::phase_of_name(phase.at("kind").get<std::string>());
    const auto begin = phase.at("begin").get<std::size_t>(),
               end = phase.at("end").get<std::size_t>();
    if (!kind || begin >= end || end > h.time.size())
      refuse_file(where, "a phase is not one of the record");
    h.phases.push_back({*kind, begin, end});
  }
  return site;
}

}  // namespace

Json histories_json(const Histories& histories) {
  Json records = Json::array();
  for (const SiteHistory& site : histories.records) records.push_back(record_json(site));
  return {{"artifact", "palpate.histories"},
          {"schema", kSchema},
          {"name", histories.name},
          {"specimen", histories.specimen},
          {"source", histories.source},
          {"licence", histories.licence},
          {"body_sha256", histories.body_sha256},
          {"tool",
           {{"shape", histories.tool.shape},
            {"radius_m", histories.tool.radius},
            {"friction", histories.tool.friction}}},
          {"records", records}};
}

Histories read_histories(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream)
    refuse(file.string(), "it cannot be read", "give histories.json of `palpate import`");
  const Json json = Json::parse(stream, nullptr, false);
  if (json.is_discarded() || !json.is_object() ||
      json.value("artifact", "") != "palpate.histories" || json.value("schema", 0) != kSchema)
    refuse(file.string(), "it is no histories.json that this version reads",
           "give the file that `palpate import` writes for [[history]] records");
  try {
    Histories out;
    out.name = json.at("name").get<std::string>();
    out.specimen = json.at("specimen").get<std::string>();
    out.source = json.at("source").get<std::string>();
    out.licence = json.at("licence").get<std::string>();
    out.body_sha256 = json.at("body_sha256").get<std::string>();
    const Json& tool = json.at("tool");
    out.tool.shape = tool.at("shape").get<std::string>();
    out.tool.radius = tool.at("radius_m").get<double>();
    out.tool.friction = tool.at("friction").get<std::string>();
    for (const Json& record : json.at("records"))
      out.records.push_back(record_of(record, file.string()));
    return out;
  } catch (const nlohmann::json::exception& error) {
    refuse_file(file.string(), error.what());
  }
}

Histories histories_with_sites(const std::filesystem::path& file) {
  Histories histories = read_histories(file);
  for (const SiteHistory& site : histories.records) {
    if (site.vertex >= 0) continue;
    refuse(file.string() + ", " + site.history.name, "the record has no site on a body",
           "give its vertex or site in the sidecar, and import it with --body");
  }
  return histories;
}

void require_same_tool(const Histories& histories, const std::string& shape, double radius,
                       const std::string& where) {
  constexpr double kAlike = 0.01;
  const ToolDescription& tool = histories.tool;
  if (tool.shape == shape && std::abs(tool.radius - radius) <= kAlike * radius) return;
  refuse(where,
         fmt::format("its tool is a {} of {}, that of the records a {} of {}", shape,
                     length_text(radius), tool.shape, length_text(tool.radius)),
         "compare with a library of the tool of the records");
}

}  // namespace palpate::app
