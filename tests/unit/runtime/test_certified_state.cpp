// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/certified_state.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/unit/runtime/api_fixture.hpp"

namespace palpate::test {
namespace {

using runtime::why_not_certified;
using ::testing::HasSubstr;

constexpr DeviceConstants kBench{1, 0.1, 0, 10e-6, 1e-3};
constexpr double kRate = 1000;

std::string reason(const palpate_library& body, double friction, double bound,
                   const DeviceConstants& device = kBench, double rate = kRate) {
  return why_not_certified(palpate_state(body, {.friction = friction, .lipschitz_bound = bound}),
                           device, rate);
}

TEST(CertifiedState, NeedsTheFrictionOfTheCertificate) {
  for (const ResponseKind kind : {ResponseKind::Decoupled, ResponseKind::Coupled}) {
    const palpate_library body(plate_of_200(kind));
    EXPECT_EQ(reason(body, 0.3, 200), "");
    EXPECT_EQ(reason(body, 0.1, 200), "");
    EXPECT_THAT(reason(body, 0.6, 200), HasSubstr("is not covered by the certificate, which is "
                                                  "valid up to 0.3"));
  }
  Library library = plate_of_200();
  library.certificate.min_lipschitz_bound = kUnknown;
  const palpate_library without(library);
  EXPECT_EQ(reason(without, 0.3, 200), "");
  EXPECT_THAT(reason(without, 0.1, 200), HasSubstr("valid at 0.3"));
}

TEST(CertifiedState, NeedsABoundThatDampingAndDryFrictionPayFor) {
  const palpate_library body(plate_of_200());
  EXPECT_THAT(reason(body, 0.3, 170), HasSubstr("cannot enforce"));
  EXPECT_THAT(reason(body, 0.3, kInfinity), HasSubstr("cannot enforce"));
  const double lowest = 1.5 * 200;  // Hz, at 1 N s/m
  EXPECT_EQ(reason(body, 0.3, 200, kBench, 1.001 * lowest), "");
  EXPECT_THAT(reason(body, 0.3, 200, kBench, 0.999 * lowest), HasSubstr("the damping certifies"));
  EXPECT_EQ(reason(body, 0.3, 180, kBench, 0.999 * lowest), "");
  DeviceConstants coarse = kBench;
  coarse.position_resolution = 1e-3;
  EXPECT_THAT(reason(body, 0.3, 200, coarse), HasSubstr("the dry friction certifies"));
  EXPECT_THAT(reason(body, 0.3, 200, {}),
              HasSubstr("unknown of the device: damping, delay, dry friction"));
  palpate_library bare(plate(8, 0.08, uniform));
  EXPECT_THAT(reason(bare, 0.3, 200), HasSubstr("no certificate"));
}

TEST_F(PalpateApi, SaysWhetherAStateIsCertifiedAndWhyNot) {
  palpate_device_constants device;
  palpate_device_constants_default(&device);
  EXPECT_EQ(palpate_state_certified(state_, &device, kRate), 0);
  EXPECT_THAT(palpate_last_error(), HasSubstr("no certificate"));
  const palpate_library body(plate_of_200());
  palpate_state state(body, {.friction = 0.3, .lipschitz_bound = 200});
  EXPECT_EQ(palpate_state_certified(&state, &device, kRate), 0);
  EXPECT_THAT(palpate_last_error(), HasSubstr("unknown of the device: damping"));
  device = {device.size, 1, 0.1, 0, 10e-6, 1e-3};
  EXPECT_EQ(palpate_state_certified(&state, &device, kRate), 1);
  for (const double rate : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_EQ(palpate_state_certified(&state, &device, rate), PALPATE_ERROR_ARGUMENT);
  for (double palpate_device_constants::*constant :
       {&palpate_device_constants::damping, &palpate_device_constants::coulomb_friction,
        &palpate_device_constants::delay, &palpate_device_constants::position_resolution,
        &palpate_device_constants::force_resolution}) {
    for (const double wrong : {-5.0, std::numeric_limits<double>::infinity()}) {
      palpate_device_constants other = device;
      other.*constant = wrong;
      EXPECT_EQ(palpate_state_certified(&state, &other, kRate), PALPATE_ERROR_ARGUMENT);
      EXPECT_THAT(palpate_last_error(), HasSubstr("negative or infinite"));
    }
  }
  device.size = 0;
  EXPECT_EQ(palpate_state_certified(&state, &device, kRate), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_state_certified(nullptr, &device, kRate), PALPATE_ERROR_ARGUMENT);
}

}  // namespace
}  // namespace palpate::test
