// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/object_delay.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

constexpr int64_t kStepNs = 40'000'000;

objects::Object objectAt(uint64_t id, objects::ObjectState state, int x, uint32_t areaPx = 100) {
  objects::Object object;
  object.id = id;
  object.state = state;
  object.box = {x, 20, 10, 10};
  object.centroidX = x * objects::kPositionUnit + 80;
  object.centroidY = 25 * objects::kPositionUnit;
  object.areaPx = areaPx;
  return object;
}

std::shared_ptr<objects::Objects> frameOf(std::vector<objects::Object> objects,
                                          std::vector<objects::Event> events = {}) {
  auto frame = std::make_shared<objects::Objects>();
  frame->size = {64, 48};
  frame->status = Status::Ok;
  frame->slots.resize(frame->size);
  frame->slots.fill(0);
  frame->objects = std::move(objects);
  frame->events = std::move(events);
  return frame;
}

/// Frames 40 ms apart through a delay of `delayFrames`; everything that comes out.
std::vector<std::shared_ptr<const objects::Objects>> delayed(
    const std::vector<std::shared_ptr<objects::Objects>>& frames, int delayFrames) {
  objects::ObjectDelay delay;
  std::vector<std::shared_ptr<const objects::Objects>> out;
  for (size_t i = 0; i < frames.size(); ++i) {
    delay.push(frames[i], static_cast<int64_t>(i) * kStepNs);
    while (auto frame = delay.pop(delayFrames * kStepNs)) out.push_back(std::move(frame));
  }
  EXPECT_EQ(out.size() + static_cast<size_t>(delayFrames), frames.size());
  while (auto frame = delay.popAny()) out.push_back(std::move(frame));
  return out;
}

TEST(ObjectDelay, EveryFrameComesOutOnceAndInOrder) {
  std::vector<std::shared_ptr<objects::Objects>> frames;
  for (int i = 0; i < 6; ++i)
    frames.push_back(frameOf({objectAt(1, objects::ObjectState::Tracked, 3 * i)}));
  const auto out = delayed(frames, 2);
  ASSERT_EQ(out.size(), 6u);
  for (size_t i = 0; i < out.size(); ++i) {
    EXPECT_EQ(out[i]->objects[0].box, frames[i]->objects[0].box);
    EXPECT_EQ(out[i]->size, frames[i]->size);
  }
}

TEST(ObjectDelay, AnObjectIsToldFromWhenItWasFirstSeen) {
  const auto out = delayed({frameOf({objectAt(7, objects::ObjectState::New, 1)}),
                            frameOf({objectAt(7, objects::ObjectState::New, 2)}),
                            frameOf({objectAt(7, objects::ObjectState::Tracked, 3)},
                                    {{objects::EventKind::ObjectNew, {7}}}),
                            frameOf({objectAt(7, objects::ObjectState::Tracked, 4)})},
                           2);
  int told = 0;
  for (const auto& frame : out) {
    EXPECT_EQ(frame->objects[0].state, objects::ObjectState::Tracked);
    told += static_cast<int>(frame->events.size());
  }
  EXPECT_EQ(told, 1);
  ASSERT_EQ(out[0]->events.size(), 1u);
  EXPECT_EQ(out[0]->events[0].kind, objects::EventKind::ObjectNew);
}

TEST(ObjectDelay, WhatIsConfirmedTooLateStaysNewUntilThen) {
  std::vector<std::shared_ptr<objects::Objects>> frames;
  for (int i = 0; i < 4; ++i)
    frames.push_back(frameOf({objectAt(7, objects::ObjectState::New, i)}));
  frames.push_back(frameOf({objectAt(7, objects::ObjectState::Tracked, 4)},
                           {{objects::EventKind::ObjectNew, {7}}}));
  const auto out = delayed(frames, 1);
  EXPECT_EQ(out[2]->objects[0].state, objects::ObjectState::New);
  EXPECT_TRUE(out[2]->events.empty());
  EXPECT_EQ(out[3]->objects[0].state, objects::ObjectState::Tracked);
  EXPECT_EQ(out[3]->events.size(), 1u);
  EXPECT_TRUE(out[4]->events.empty());
}

TEST(ObjectDelay, AFlickerIsNeverTold) {
  for (const auto& frame : delayed({frameOf({objectAt(7, objects::ObjectState::New, 1)}),
                                    frameOf({}), frameOf({}), frameOf({})},
                                   2))
    for (const objects::Object& object : frame->objects)
      EXPECT_EQ(object.state, objects::ObjectState::New);
}

TEST(ObjectDelay, AHiddenObjectLiesOnTheWayToWhereItComesBack) {
  const auto out = delayed({frameOf({objectAt(7, objects::ObjectState::Tracked, 0)}),
                            frameOf({objectAt(7, objects::ObjectState::Occluded, 40, 0)}),
                            frameOf({objectAt(7, objects::ObjectState::Lost, 50, 0)}),
                            frameOf({objectAt(7, objects::ObjectState::Tracked, 30)})},
                           3);
  EXPECT_EQ(out[1]->objects[0].state, objects::ObjectState::Occluded);
  EXPECT_EQ(out[1]->objects[0].box, (Box{10, 20, 10, 10}));
  EXPECT_EQ(out[1]->objects[0].centroidX, 15 * objects::kPositionUnit);
  EXPECT_EQ(out[2]->objects[0].state, objects::ObjectState::Occluded);
  EXPECT_EQ(out[2]->objects[0].box, (Box{20, 20, 10, 10}));
}

TEST(ObjectDelay, WhatDoesNotComeBackInTimeIsAsItWasPredicted) {
  const auto out =
      delayed({frameOf({objectAt(7, objects::ObjectState::Tracked, 0)}),
               frameOf({objectAt(7, objects::ObjectState::Lost, 40, 0)}), frameOf({}), frameOf({})},
              1);
  EXPECT_EQ(out[1]->objects[0].state, objects::ObjectState::Lost);
  EXPECT_EQ(out[1]->objects[0].box.x, 40);
}

TEST(ObjectDelay, ATimeThatStandsStillHoldsNothingForEver) {
  for (const int64_t time : {int64_t{0}, INT64_MAX, INT64_MIN}) {
    objects::ObjectDelay delay;
    for (int i = 0; i < 100; ++i) {
      delay.push(frameOf({objectAt(1, objects::ObjectState::Tracked, i)}), time);
      while (delay.pop(5 * kStepNs)) {
      }
      EXPECT_LE(delay.count(), 5u);
    }
    EXPECT_EQ(delay.count(), 5u);
  }
}

TEST(ObjectDelay, AJumpOverAllOfTimeReleasesWhatWasHeldBeforeIt) {
  objects::ObjectDelay delay;
  for (const int64_t time : {INT64_MIN, INT64_MIN + kStepNs, INT64_MAX})
    delay.push(frameOf({}), time);
  EXPECT_TRUE(delay.pop(2 * kStepNs));
  EXPECT_TRUE(delay.pop(2 * kStepNs));
  EXPECT_FALSE(delay.pop(2 * kStepNs));
  delay.push(frameOf({}), INT64_MIN);
  EXPECT_FALSE(delay.pop(2 * kStepNs));
  EXPECT_EQ(delay.count(), 2u);
}

TEST(ObjectDelay, AHiddenObjectLiesOnTheWayHoweverLongThatTakes) {
  objects::ObjectDelay delay;
  delay.push(frameOf({objectAt(7, objects::ObjectState::Tracked, 0)}), INT64_MIN);
  delay.push(frameOf({objectAt(7, objects::ObjectState::Lost, 9, 0)}), 0);
  delay.push(frameOf({objectAt(7, objects::ObjectState::Tracked, 1000)}), INT64_MAX);
  ASSERT_TRUE(delay.popAny());
  const auto hidden = delay.popAny();
  EXPECT_EQ(hidden->objects[0].state, objects::ObjectState::Occluded);
  // The time between is more than can be told: half of it has passed at the end of what can.
  EXPECT_GE(hidden->objects[0].box.x, 500);
  EXPECT_LE(hidden->objects[0].box.x, 1000);
}

TEST(ObjectDelay, SourcesStayAsTheyWere) {
  const auto first = frameOf({objectAt(7, objects::ObjectState::New, 1)});
  delayed({first, frameOf({objectAt(7, objects::ObjectState::Tracked, 2)},
                          {{objects::EventKind::ObjectNew, {7}}})},
          1);
  EXPECT_EQ(first->objects[0].state, objects::ObjectState::New);
  EXPECT_TRUE(first->events.empty());
}

}  // namespace
}  // namespace rg
