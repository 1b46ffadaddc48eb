// SPDX-License-Identifier: LGPL-2.1-or-later
// What the five stage elements have in common: threads, the result of the stage before, and
// attaching their own.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/pool.hpp"
#include "core/base/picture.hpp"
#include "core/base/stage.hpp"
#include "core/objects/objects.hpp"
#include "gst/meta/result_meta.hpp"
#include "gst/support/backend.hpp"
#include "gst/support/filter.hpp"
#include "gst/support/lost_results.hpp"
#include "gst/support/stage_stats.hpp"

#include <memory>
#include <string>

namespace rg {

struct StageSettings {
  int threads = 0;
  StageStats stats;
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
  [[nodiscard]] static Context makeContext(int threads, std::shared_ptr<Device> device) {
    return {std::make_shared<const Executor>(threads), std::move(device)};
  }

  /// The result that `producer` attaches. Missing on
  /// the first frame it is an error that names the element to add; going missing later gives one
  /// warning.
  template <class Payload>
  Upstream<Payload> require(const FilterFrame& frame, const char* producer) {
    Upstream<Payload> upstream{findResult<Payload>(frame.buffer)};
    if (!upstream.result) upstream.flow = reportMissing(frame, producer);
    return upstream;
  }

  /// The same for a stage, which can't work on what mrfmerge has packed for readers.
  template <class Payload>
  Upstream<Payload> requireUnpacked(const FilterFrame& frame, const char* producer) {
    auto upstream = require<Payload>(frame, producer);
    if (upstream.result && objects::isPacked(*upstream.result)) {
      upstream.result = nullptr;
      upstream.flow = postError(std::string("mrfmerge has packed the results of ") + producer +
                                " for their readers: put this stage before mrfmerge.");
    }
    return upstream;
  }

  /// Warns where a later stage has seen the frame before this one: what it said was of nothing, or
  /// of the whole frame.
  template <class... Later>
  void checkOrder(const FilterFrame& frame) {
    if (!frame.isFirst || hasCheckedOrder_) return;
    hasCheckedOrder_ = true;
    if ((findResult<Later>(frame.buffer) || ...))
      postWarning(
          "A later stage stands before this one, and did not see its results: put the "
          "stages in the order bgremove, hsvsegment, srg, prmmotion, mrfmerge.");
  }
  void forgetOrder() { hasCheckedOrder_ = false; }

  /// An error on the first frame, since what is missing there will never come; else one warning.
  GstFlowReturn reportMissing(const FilterFrame& frame, const std::string& producer) {
    if (frame.isFirst) return postError(whyMissing(GST_ELEMENT(element()), producer.c_str()));
    warnOnce("The results of " + producer + " stopped; frames without them are skipped.");
    return GST_FLOW_OK;
  }

  /// Attaches what the stage said, or an empty result marked as skipped where it failed.
  template <class Payload>
  void attach(const FilterFrame& frame, Result<std::shared_ptr<const Payload>> result) {
    attachResult<Payload>(frame.buffer, orSkipped(frame, std::move(result)));
  }

  template <class Payload>
  void attachSkipped(const FilterFrame& frame) {
    attachResult<Payload>(frame.buffer, skipped<Payload>(frame));
  }

  template <class Payload>
  [[nodiscard]] std::shared_ptr<const Payload> orSkipped(
      const FilterFrame& frame, Result<std::shared_ptr<const Payload>> result) {
    if (result) return *std::move(result);
    warnOnce("A frame was skipped: " + result.error().message + ".");
    return skipped<Payload>(frame);
  }

  /// Of the picture that is looked at.
  [[nodiscard]] virtual Size analysedSize(const FilterFrame& frame) const { return sizeOf(frame); }

  /// The result of a frame that there is none of.
  template <class Payload>
  [[nodiscard]] std::shared_ptr<const Payload> skipped(const FilterFrame& frame) {
    ++skippedFrames_;
    auto result = std::make_shared<Payload>();
    result->size = analysedSize(frame);
    return result;
  }

  void warnOnce(const std::string& text) {
    if (!std::exchange(hasWarned_, true)) postWarning(text);
  }
  /// Of a frame that there is no result of.
  void countSkipped() { ++skippedFrames_; }
  void forgetWarnings() { hasWarned_ = false; }
  /// Frames since this was asked that skipped() was asked for.
  [[nodiscard]] guint64 takeSkipped() { return std::exchange(skippedFrames_, 0); }

 private:
  bool hasWarned_ = false;        ///< In this stream: a broken stream must not flood the bus.
  bool hasCheckedOrder_ = false;  ///< Since the start.
  guint64 skippedFrames_ = 0;
};

/// A stage element: its settings and the stage that is made when it starts.
template <class Settings, class Stage>
class StageOwner : public StageFilter {
 public:
  using Factory = std::unique_ptr<Stage> (*)(Context);

  StageOwner(GstBaseTransform* element, Factory makeStage)
      : StageFilter(element), makeStage_(makeStage) {}

  void* settings() override { return &settings_; }

  bool start() override {
    this->forgetOrder();
    (void)this->takeSkipped();
    progress_.restart();
    forgetStats();
    if (!openDevice()) return false;
    const Context context = makeContext(currentSettings().threads, device_);
    executor_ = context.cpu;
    stage_ = makeStage_(context);
    return true;
  }
  void stop() override {
    stage_.reset();
    device_.reset();
    tellBackend({});
  }
  void finish(const FilterFrame& frame, GstClockTime took) override {
    followDevice();
    StageStats stats;
    {
      const std::lock_guard lock(settingsMutex());
      settings_.stats.add(took);
      settings_.stats.dropped += takeSkipped();
      stats = settings_.stats;
    }
    if (ProgressLog::isOn(category()))
      progress_.tell(GST_ELEMENT(element()), category(), describe(frame),
                     GST_BUFFER_PTS(frame.buffer), stats);
  }
  void reset(Reset what) override {
    if (what == Reset::Stream) forgetWarnings();
    if (stage_) stage_->reset(what);
  }

 protected:
  /// What was found in a frame, in words.
  [[nodiscard]] virtual Progress describe(const FilterFrame& frame) = 0;

  [[nodiscard]] Settings currentSettings() { return snapshot(settings_); }
  [[nodiscard]] Stage& stage() { return *stage_; }
  [[nodiscard]] const Executor& executor() const { return *executor_; }
  /// While it works; null: the CPU.
  [[nodiscard]] Device* device() const {
    return device_ && device_->isUp() ? device_.get() : nullptr;
  }
  /// What the end of a device has cost, for the warning.
  [[nodiscard]] virtual const char* lossOfDevice() const { return " where it was."; }

  Settings settings_;

 private:
  bool openDevice() {
    if constexpr (kHasBackend<Settings>) {
      auto device = openBackend(GST_ELEMENT(element()), currentSettings());
      if (!device) {
        postError("backend=cuda: " + device.error().message +
                  ". With backend=auto the CPU does it");
        return false;
      }
      device_ = *std::move(device);
      hasToldFailure_ = false;
      tellBackend(nameOfBackend());
    }
    return true;
  }
  [[nodiscard]] std::string nameOfBackend() const {
    return device_ && device_->isUp() ? "cuda: " + device_->name() : "cpu";
  }
  void tellBackend(std::string name) {
    if constexpr (kHasBackend<Settings>) {
      const std::lock_guard lock(settingsMutex());
      settings_.activeBackend = std::move(name);
    }
  }
  void followDevice() {
    if (!device_) return;
    tellBackend(nameOfBackend());
    const DeviceError* error = device_->error();
    if (error == nullptr || std::exchange(hasToldFailure_, true)) return;
    postWarning("The CUDA device failed: " + std::string(error->what()) + ". The CPU goes on" +
                (error->isLost() ? lossOfDevice() : " where it was."));
  }

  void forgetStats() {
    const std::lock_guard lock(settingsMutex());
    settings_.stats = {};
  }

  ProgressLog progress_;
  const Factory makeStage_;
  std::shared_ptr<const Executor> executor_;
  std::shared_ptr<Device> device_;  ///< None: the CPU.
  bool hasToldFailure_ = false;
  std::unique_ptr<Stage> stage_;
};

/// A stage element whose whole input is the result of the stage before.
template <class Settings, class Stage, class In>
class ChainedFilter : public StageOwner<Settings, Stage> {
 public:
  using Base = StageOwner<Settings, Stage>;

  ChainedFilter(GstBaseTransform* element, typename Base::Factory makeStage, const char* producer)
      : Base(element, makeStage), producer_(producer) {}

  GstFlowReturn process(const FilterFrame& frame) final {
    auto upstream = this->template requireUnpacked<In>(frame, producer_);
    if (upstream.flow != GST_FLOW_OK) return upstream.flow;
    handle(frame, std::move(upstream.result), this->currentSettings());
    return GST_FLOW_OK;
  }

 protected:
  /// `input` is null for frames to skip.
  virtual void handle(const FilterFrame& frame, std::shared_ptr<const In> input,
                      const Settings& settings) = 0;

 private:
  const char* const producer_;
};

}  // namespace rg
