// SPDX-License-Identifier: AGPL-3.0-or-later
// The parts that are copied from the artifacts: certificate and provenance.
#include <algorithm>
#include <sstream>

#include "app/report/embed.hpp"
#include "app/report/page_data.hpp"
#include "format/guarantee.hpp"

namespace palpate::report {

namespace {

using nlohmann::json;

bool same_run(const ProvenanceStep& a, const ProvenanceStep& b) {
  return a.stage == b.stage && a.utc == b.utc && a.git_revision == b.git_revision;
}

/// Steps of the library, then those that only another artifact has (the session).
std::vector<ProvenanceStep> joined_chain(const ReportInput& input) {
  std::vector<ProvenanceStep> chain;
  const auto add = [&](const Provenance& provenance) {
    for (const ProvenanceStep& step : provenance.steps) {
      const auto known = [&](const ProvenanceStep& other) { return same_run(step, other); };
      if (std::none_of(chain.begin(), chain.end(), known)) chain.push_back(step);
    }
  };
  add(input.body->provenance);
  add(input.curves->provenance);
  add(input.library->provenance);
  if (input.session != nullptr) add(input.session->heading().provenance);
  return chain;
}

}  // namespace

json certificate_data(const Library& library) {
  const Certificate& c = library.certificate;
  if (c.triangles.empty()) return {};
  std::vector<float> stick, slip, kappa, cos_theta;
  std::vector<std::uint8_t> sliding_passive;
  for (const TriangleCertificate& t : c.triangles) {
    stick.push_back(static_cast<float>(t.stick));
    slip.push_back(static_cast<float>(t.slip));
    kappa.push_back(static_cast<float>(t.kappa));
    cos_theta.push_back(static_cast<float>(t.cos_theta));
    sliding_passive.push_back(t.sliding_passive ? 1 : 0);
  }
  const char* by = guaranteed_by(c) == GuaranteedBy::Curves    ? "curves"
                   : guaranteed_by(c) == GuaranteedBy::Limiter ? "limiter"
                                                               : "nothing";
  json devices = json::array();
  for (const DeviceCertificate& d : c.devices) {
    devices.push_back({{"device", d.device},
                       {"verdict", verdict(c, d)},
                       {"damping", d.damping},
                       {"certified", is_certified(c, d)},
                       {"lowest_rate", d.lowest_rate},
                       {"published_rate", d.published_rate},
                       {"largest_position_step", d.largest_position_step},
                       {"linear_limit", d.linear_limit},
                       {"no_delay_limit", d.no_delay_limit}});
  }
  return {{"guarantee", guarantee_text(c)},
          {"guaranteed_by", by},
          {"friction", c.friction},
          {"depth", c.depth},
          {"stick", c.stick},
          {"slip", c.slip},
          {"min_lipschitz_bound", c.min_lipschitz_bound},
          {"lipschitz_bound", certified_lipschitz_bound(c)},
          {"worst_triangle", c.worst_triangle},
          {"limited_by", c.limited_by},
          {"basis", c.basis},
          {"holes", c.holes},
          {"interpolated", c.interpolated},
          {"devices", devices},
          {"triangle_stick", column(stick)},
          {"triangle_slip", column(slip)},
          {"triangle_kappa", column(kappa)},
          {"triangle_cos_theta", column(cos_theta)},
          {"triangle_sliding_passive", column(sliding_passive)}};
}

json provenance_data(const ReportInput& input) {
  return provenance_data(joined_chain(input));
}

json provenance_data(const std::vector<ProvenanceStep>& steps) {
  json chain = json::array();
  for (const ProvenanceStep& step : steps) {
    json inputs = json::array(), facts = json::array();
    for (const InputDigest& digest : step.inputs)
      inputs.push_back({{"name", digest.name}, {"sha256", digest.sha256}});
    for (const auto& [key, value] : step.facts) facts.push_back({key, value});
    chain.push_back({{"stage", step.stage},
                     {"version", step.version},
                     {"git_revision", step.git_revision},
                     {"utc", step.utc},
                     {"inputs", inputs},
                     {"facts", facts},
                     {"resolved_case", step.resolved_case},
                     {"materials", materials(step.resolved_case)}});
  }
  return chain;
}

json materials(const std::string& resolved_case) {
  std::istringstream lines(resolved_case);
  std::string line;
  json tables = json::array();
  bool inside = false;
  while (std::getline(lines, line)) {
    if (line.rfind('[', 0) == 0) {
      inside = line == "[[material]]";
      if (inside) tables.push_back(json::array());
      continue;
    }
    const std::size_t equals = line.find(" = ");
    if (!inside || equals == std::string::npos) continue;
    std::string value = line.substr(equals + 3);
    if (value.size() >= 2 && value.front() == '"' && value.back() == '"')
      value = value.substr(1, value.size() - 2);
    tables.back().push_back({line.substr(0, equals), value});
  }
  return tables;
}

}  // namespace palpate::report
