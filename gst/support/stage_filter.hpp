// SPDX-License-Identifier: LGPL-2.1-or-later
// What the five stage elements have in common: threads, the result of the stage before, and
// attaching their own.
#pragma once

#include "core/executor.hpp"
#include "core/picture.hpp"
#include "core/pool.hpp"
#include "core/stage.hpp"
#include "gst/meta/result_meta.hpp"
#include "gst/support/filter.hpp"

#include <memory>
#include <string>

namespace rg {

struct StageSettings {
  int threads = 0;
};

template <class Settings>
constexpr Property threadsProperty() {
  return property<Settings, &Settings::threads>(
      "threads", "Threads to work with; 0 = as many as there are cores, never more", 0, 1024,
      Mutable::Ready);
}

/// What the stage before said of a frame.
template <class Payload>
struct Upstream {
  std::shared_ptr<const Payload> result;  ///< Null: this frame can't be processed.
  GstFlowReturn flow = GST_FLOW_OK;       ///< An error where it never was there.
};

class StageFilter : public Filter {
 public:
  using Filter::Filter;

 protected:
  [[nodiscard]] Context makeContext(int threads) const {
    return {std::make_shared<const Executor>(threads), nullptr};
  }

  /// The result that `producer` attaches. Missing on the first frame it is an error that names the
  /// element to add; going missing later gives one warning.
  template <class Payload>
  Upstream<Payload> require(const FilterFrame& frame, const char* producer) {
    if (frame.isFirst) hasWarned_ = false;
    Upstream<Payload> upstream{findResult<Payload>(frame.buffer)};
    if (!upstream.result) upstream.flow = reportMissing(frame, producer);
    return upstream;
  }

  /// An error on the first frame, since what is missing there will never come; else one warning.
  GstFlowReturn reportMissing(const FilterFrame& frame, const std::string& producer) {
    if (frame.isFirst)
      return postError("No result of " + producer + " on the frames: add " + producer +
                       " to the pipeline before this element.");
    warnOnce("The results of " + producer + " stopped; frames without them are skipped.");
    return GST_FLOW_OK;
  }

  /// Attaches what the stage said, or an empty result marked as skipped where it failed.
  template <class Payload>
  void attach(const FilterFrame& frame, Result<std::shared_ptr<const Payload>> result) {
    if (result) return attachResult<Payload>(frame.buffer, *std::move(result));
    warnOnce("A frame was skipped: " + result.error().message + ".");
    attachSkipped<Payload>(frame);
  }

  template <class Payload>
  void attachSkipped(const FilterFrame& frame) {
    auto result = std::make_shared<Payload>();
    result->size = {GST_VIDEO_INFO_WIDTH(&frame.info), GST_VIDEO_INFO_HEIGHT(&frame.info)};
    attachResult<Payload>(frame.buffer, std::move(result));
  }

  void warnOnce(const std::string& text) {
    if (!std::exchange(hasWarned_, true)) postWarning(text);
  }

 private:
  bool hasWarned_ = false;  ///< Since the caps: a broken stream must not flood the bus.
};

/// A stage element whose whole input is the result of the stage before.
template <class Settings, class Stage, class In>
class ChainedFilter : public StageFilter {
 public:
  using Factory = std::unique_ptr<Stage> (*)(Context);

  ChainedFilter(GstBaseTransform* element, Factory makeStage, const char* producer)
      : StageFilter(element), makeStage_(makeStage), producer_(producer) {}

  void* settings() override { return &settings_; }

  bool start() override {
    stage_ = makeStage_(makeContext(snapshot(settings_).threads));
    return true;
  }
  void stop() override { stage_.reset(); }
  void reset(Reset what) override {
    if (stage_) stage_->reset(what);
  }

  GstFlowReturn process(const FilterFrame& frame) final {
    auto upstream = require<In>(frame, producer_);
    if (upstream.flow != GST_FLOW_OK) return upstream.flow;
    handle(frame, std::move(upstream.result), snapshot(settings_));
    return GST_FLOW_OK;
  }

 protected:
  /// `input` is null for frames to skip.
  virtual void handle(const FilterFrame& frame, std::shared_ptr<const In> input,
                      const Settings& settings) = 0;

  [[nodiscard]] Stage& stage() { return *stage_; }

 private:
  const Factory makeStage_;
  const char* const producer_;
  Settings settings_;
  std::unique_ptr<Stage> stage_;
};

}  // namespace rg
