// SPDX-License-Identifier: LGPL-2.1-or-later
// A stage that is made anew where it must forget everything: scratch memory and pools of another
// frame size go with it, and so does whatever an exception left half done.
#pragma once

#include "core/base/stage.hpp"

#include <memory>
#include <utility>

namespace rg {

/// What outlives a stage: nothing, unless it has a `bequeath() noexcept` whose value its successor
/// takes by `inherit()`.
struct NoLegacy {};

template <class Stage>
[[nodiscard]] auto legacyOf(Stage& stage) noexcept {
  if constexpr (requires { stage.bequeath(); })
    return stage.bequeath();
  else
    return NoLegacy{};
}

/// Interface's process() by a Stage that is made from a Context, and that is asked to reset() for
/// less than Reset::Stream only. Nothing is allocated on the way out of a failed frame: the
/// successor is made when the next frame comes. Where a device was lost with what the stage knew,
/// the successor gets the very same frame; it runs on the CPU.
template <class Interface, class Stage, class Process = decltype(&Interface::process)>
class RenewedStage;

template <class Interface, class Stage, class Outcome, class... Inputs>
class RenewedStage<Interface, Stage, Outcome (Interface::*)(Inputs...)> final : public Interface {
 public:
  explicit RenewedStage(Context context)
      : context_(std::move(context)), stage_(std::make_unique<Stage>(context_)) {}

  Outcome process(Inputs... inputs) override {
    if (!stage_) succeed();
    try {
      return stage_->process(std::as_const(inputs)...);
    } catch (const DeviceError& error) {
      drop();
      if (!error.isLost()) throw;
    } catch (...) {
      drop();
      throw;
    }
    return process(std::forward<Inputs>(inputs)...);
  }

  void reset(Reset what) override {
    if (what == Reset::Stream)
      drop();
    else if (stage_)
      stage_->reset(what);
  }

 private:
  using Legacy = decltype(legacyOf(std::declval<Stage&>()));

  void succeed() {
    auto successor = std::make_unique<Stage>(context_);
    if constexpr (requires { successor->inherit(std::move(legacy_)); })
      successor->inherit(std::move(legacy_));
    stage_ = std::move(successor);
  }

  void drop() noexcept {
    if (!stage_) return;
    legacy_ = legacyOf(*stage_);
    stage_.reset();
  }

  Context context_;
  std::unique_ptr<Stage> stage_;  ///< None: the next frame makes one.
  Legacy legacy_{};
};

}  // namespace rg
