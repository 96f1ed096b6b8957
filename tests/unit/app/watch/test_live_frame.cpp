// SPDX-License-Identifier: AGPL-3.0-or-later
// Any frame of a running session alone says what there is to say.
#include "app/watch/live_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "runtime/palpate.h"

namespace palpate::app {
namespace {

using nlohmann::json;

RecordedStep step(int i, double force) {
  RecordedStep s;
  s.time_ns = std::int64_t{1'000'000} * i;
  s.position = {0.001 * i, 2, 3};
  s.contact_point = {1, 2, 3};
  s.force = {0, 0, force};
  s.energy = 1e-3;
  s.absorbed = 2e-3;
  s.element = 7;
  s.status = PALPATE_CONTACT;
  return s;
}

SessionNews begun() {
  SessionNews news;
  news.begun.emplace();
  news.begun->device = "a <hand>";
  news.begun->rate = 1000;
  news.begun->friction = 0.3;
  news.begun->library_sha256 = "abc";
  news.begun->settings.body_position = {0.5, 1, 2};
  return news;
}

TEST(LiveFrames, AreCompleteBeforeDuringAndAfterASession) {
  LiveFrames frames("abc");
  json frame = json::parse(frames.next());
  EXPECT_EQ(frame["session"], 0);
  EXPECT_TRUE(frame["last"].is_null());
  EXPECT_FALSE(frames.see({}));

  SessionNews news = begun();
  news.steps = {step(1, 0.5), step(2, 0.25)};
  news.steps[0].status |= PALPATE_LOOP_LATE;
  EXPECT_TRUE(frames.see(news));
  frame = json::parse(frames.next());
  EXPECT_EQ(frame["session"], 1);
  EXPECT_TRUE(frame["running"].get<bool>() && frame["same_library"].get<bool>());
  EXPECT_EQ(frame["device"], "a <hand>");
  EXPECT_EQ(frame["counts"]["steps"], 2);
  EXPECT_EQ(frame["counts"]["late"], 1);
  EXPECT_EQ(frame["counts"]["largest_force"], 0.5);
  // In the frame of the body.
  EXPECT_EQ(frame["last"]["position"], json({0.002 - 0.5, 1.0, 1.0}));
  EXPECT_EQ(frame["last"]["contact"], json({0.5, 1.0, 1.0}));
  EXPECT_EQ(frame["last"]["force"], json({0.0, 0.0, 0.25}));

  SessionNews end;
  end.ended = true;
  EXPECT_TRUE(frames.see(end));
  frame = json::parse(frames.next());
  EXPECT_FALSE(frame["running"].get<bool>());
  EXPECT_EQ(frame["counts"]["steps"], 2);  // what there was stays to be read
  EXPECT_EQ(frame["last"]["time"], 0.002);
  EXPECT_TRUE(frame["recent"]["time"].empty());

  EXPECT_TRUE(frames.see(begun()));
  frame = json::parse(frames.next());
  EXPECT_EQ(frame["session"], 2);
  EXPECT_EQ(frame["counts"]["steps"], 0);
  EXPECT_TRUE(frame["last"].is_null());
}

TEST(LiveFrames, TheThinnedStepsKeepTheExtremes) {
  LiveFrames frames("abc");
  SessionNews news = begun();
  for (int i = 0; i < 5000; ++i) news.steps.push_back(step(i, i == 1234 ? 9 : 1 + 1e-4 * (i % 7)));
  frames.see(news);
  const json recent = json::parse(frames.next())["recent"];
  const auto time = recent["time"].get<std::vector<double>>();
  const auto force = recent["force"].get<std::vector<double>>();
  EXPECT_LE(time.size(), 16U);
  EXPECT_TRUE(std::is_sorted(time.begin(), time.end()));
  const auto peak = std::max_element(force.begin(), force.end());
  EXPECT_EQ(*peak, 9);
  EXPECT_EQ(time[static_cast<std::size_t>(peak - force.begin())], 1.234);
  EXPECT_EQ(recent["absorbed"].size(), time.size());
}

TEST(LiveFrames, AViolatedAccountIsKept) {
  LiveFrames frames("other");
  SessionNews news = begun();
  news.steps = {step(1, 1), step(2, 1)};
  news.steps[0].absorbed = 0;
  frames.see(news);
  const json frame = json::parse(frames.next());
  EXPECT_DOUBLE_EQ(frame["counts"]["least_margin"].get<double>(), -1e-3);
  EXPECT_FALSE(frame["same_library"].get<bool>());
}

}  // namespace
}  // namespace palpate::app
