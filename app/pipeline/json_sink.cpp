// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/json_sink.hpp"

#include <nlohmann/json.hpp>
#include <string>

#include "app/pipeline/describe_events.hpp"

namespace palpate::app {
namespace {

using Json = nlohmann::ordered_json;

class JsonVisitor {
 public:
  JsonVisitor() : json_(Json::object()) {}
  void event(std::string_view name, std::string_view) { json_["event"] = name; }
  template <class T>
  void field(std::string_view name, const T& value, std::string_view) {
    json_[std::string(name)] = value;  // dump() writes null for a number that is not finite
  }
  void field(std::string_view name, const fidelity::ErrorRow& row, std::string_view) {
    json_[std::string(name)] = {{"median", row.median}, {"p95", row.p95}, {"worst", row.worst}};
  }
  void field(std::string_view name, const FitErrors& errors, std::string_view) {
    json_[std::string(name)] = {
        {"median", errors.median}, {"worst", errors.worst}, {"vertex", errors.vertex}};
  }
  void field(std::string_view name,
             const std::vector<std::pair<std::string, std::string>>& verdicts, std::string_view) {
    Json& devices = json_[std::string(name)] = Json::object();
    for (const auto& [device, verdict] : verdicts) devices[device] = verdict;
  }
  std::string text() const { return json_.dump(); }

 private:
  Json json_;
};

}  // namespace

void JsonSink::operator()(const Event& event) const {
  const auto* progress = std::get_if<Progress>(&event);
  if (progress != nullptr && progress->between_sites) return;
  const auto* finer = std::get_if<FinerMeshProgress>(&event);
  if (finer != nullptr && finer->between_sites) return;
  JsonVisitor visitor;
  std::visit([&](const auto& e) { describe(visitor, e); }, event);
  print_line_(visitor.text());
}

}  // namespace palpate::app
