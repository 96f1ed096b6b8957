// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/devices/websocket.hpp"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(WebSocket, AcceptsAsTheStandardSays) {
  EXPECT_EQ(runtime::websocket_accept("dGhlIHNhbXBsZSBub25jZQ=="),
            "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");  // RFC 6455, 1.3
}

}  // namespace
}  // namespace palpate::test
