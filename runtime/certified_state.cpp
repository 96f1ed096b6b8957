// SPDX-License-Identifier: Apache-2.0
#include "runtime/certified_state.hpp"

#include "format/guarantee.hpp"
#include "format/number_text.hpp"

namespace palpate::runtime {
namespace {

std::string fault_of(const palpate_state& state) {
  const CertifiedRange& range = state.certified_range;
  if (range.low_friction > range.high_friction) return "the library has no certificate";
  if (!range.covers(state.friction)) {
    return "the friction of the state, " + number_text(state.friction) +
           ", is not covered by the certificate, which is valid " +
           (range.low_friction < range.high_friction ? "up to " : "at ") +
           number_text(range.high_friction);
  }
  if (!range.enforces(state.lipschitz_bound))
    return "the runtime cannot enforce the Lipschitz bound of the state";
  return "";
}

}  // namespace

std::string why_not_certified(const palpate_state& state, const DeviceConstants& device,
                              double rate) {
  if (std::string fault = fault_of(state); !fault.empty()) return fault;
  const double relaxation_rate = state.certified_range.relaxation_rate;
  const PassivityVerdict verdict =
      judge_passivity(device, {state.lipschitz_bound, relaxation_rate}, rate);
  if (!verdict.unknown.empty()) return "unknown of the device: " + list_in_words(verdict.unknown);
  const std::string bound = lipschitz_bound_text(state.lipschitz_bound);
  if (!verdict.by_damping) {
    return "the damping certifies a Lipschitz bound of " +
           number_text(certifiable_stiffness(device, rate, relaxation_rate), 4) +
           " N/m at this rate, not of " + bound;
  }
  if (!verdict.by_friction) {
    return "the dry friction certifies a Lipschitz bound of " +
           number_text(certifiable_stiffness_by_friction(device), 4) + " N/m, not of " + bound;
  }
  return "";
}

}  // namespace palpate::runtime
