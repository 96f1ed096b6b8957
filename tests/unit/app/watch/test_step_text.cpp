// SPDX-License-Identifier: AGPL-3.0-or-later
// Steps that a program prints, as they come through a pipe.
#include "app/watch/step_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "format/error.hpp"
#include "format/step_columns.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

class StepTextTest : public testing::Test {
 protected:
  StepTextTest() {
    if (pipe(ends_.data()) != 0) throw std::runtime_error("no pipe");
    text_.emplace(ends_[0], RecordingHeading{});
  }
  ~StepTextTest() override {
    close(ends_[0]);
    hang_up();
  }
  void print(const std::string& text) const {
    EXPECT_EQ(write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void hang_up() {
    if (ends_[1] >= 0) close(std::exchange(ends_[1], -1));
  }
  std::string refused(const std::string& text) {
    print(text);
    try {
      text_->poll();
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }

  std::array<int, 2> ends_{-1, -1};
  std::optional<StepText> text_;
  const std::string columns_ = std::string(kStepColumns) + "\n";
  const std::string step_ = "5,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21";
};

TEST_F(StepTextTest, EachColumnIsItsOwnAndALineComesWhenItIsWhole) {
  EXPECT_FALSE(text_->poll().begun);  // and does not wait
  print(columns_ + step_.substr(0, 9));
  SessionNews news = text_->poll();
  ASSERT_TRUE(news.begun);
  EXPECT_TRUE(news.steps.empty());
  print(step_.substr(9) + "\r\n" + step_ + "\n");
  news = text_->poll();
  ASSERT_EQ(news.steps.size(), 2U);
  const RecordedStep& s = news.steps[0];
  EXPECT_EQ(s.time_ns, 5);
  EXPECT_EQ(s.position, (Vec3{1, 2, 3}));
  EXPECT_EQ(s.velocity, (Vec3{4, 5, 6}));
  EXPECT_EQ(s.force, (Vec3{7, 8, 9}));
  EXPECT_EQ(s.contact_point, (Vec3{10, 11, 12}));
  EXPECT_EQ(s.depth, 13);
  EXPECT_EQ(s.lateral, 14);
  EXPECT_EQ(s.offset, 15);
  EXPECT_EQ(s.energy, 16);
  EXPECT_EQ(s.tank, 17);
  EXPECT_EQ(s.absorbed, 18);
  EXPECT_EQ(s.element, 19);
  EXPECT_EQ(s.status, 20U);
  EXPECT_EQ(s.latency_ns, 21);
  hang_up();
  EXPECT_TRUE(text_->poll().ended);
  EXPECT_FALSE(text_->poll().ended);  // once
}

TEST_F(StepTextTest, WhatIsNoStepIsRefusedWithItsLine) {
  EXPECT_THAT(refused(columns_ + step_ + ",22\n"), HasSubstr("line 2 of the steps"));
}

TEST_F(StepTextTest, ALineThatIsTooShortIsRefused) {
  EXPECT_THAT(refused(columns_ + "1,2,3\n"), HasSubstr("22 columns"));
}

TEST_F(StepTextTest, AWordIsNoNumber) {
  EXPECT_THAT(refused(columns_ + "5,one" + step_.substr(3) + "\n"),
              HasSubstr("column 2 is no number: \"one\""));
}

TEST_F(StepTextTest, AnElementOutOfRangeIsRefused) {
  EXPECT_THAT(refused(columns_ + step_.substr(0, step_.size() - 8) + "1e12,20,21\n"),
              HasSubstr("out of range"));
}

TEST_F(StepTextTest, TheColumnsComeFirst) {
  EXPECT_THAT(refused(step_ + "\n"), HasSubstr("begin with the line \"time_ns,position_x_m"));
}

}  // namespace
}  // namespace palpate::app
