// SPDX-License-Identifier: AGPL-3.0-or-later
// The event table of docs/campaigns.md.
#include <fmt/format.h>

#include "app/pipeline/describe_events.hpp"

namespace palpate::app {
namespace {

class Documenter {
 public:
  void event(std::string_view name, std::string_view about) {
    out_ += fmt::format("\n`{}`: {}.\n\n| key | meaning |\n|---|---|\n", name, about);
  }
  template <class T>
  void field(std::string_view name, const T&, std::string_view about) {
    out_ += fmt::format("| `{}` | {} |\n", name, about);
  }
  const std::string& result() const { return out_; }

 private:
  std::string out_;
};

template <std::size_t I = 0>
void describe_all(Documenter& documenter) {
  if constexpr (I < std::variant_size_v<Event>) {
    describe(documenter, std::variant_alternative_t<I, Event>{});
    describe_all<I + 1>(documenter);
  }
}

}  // namespace

std::string event_reference() {
  Documenter documenter;
  describe_all(documenter);
  return documenter.result();
}

}  // namespace palpate::app
