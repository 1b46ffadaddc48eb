// SPDX-License-Identifier: LGPL-2.1-or-later
// Which processor does a stage's work on pixels.
#pragma once

#include "core/base/memory/device.hpp"
#include "core/base/result.hpp"
#include "gst/support/properties.hpp"

#include <gst/gst.h>

#include <concepts>
#include <cstdint>
#include <memory>
#include <string>

namespace rg {

enum class Backend : int { Auto, Cpu, Cuda };

struct BackendSettings {
  Backend backend = Backend::Cpu;
  int deviceId = 0;
  std::string activeBackend;  ///< Of the stage that runs; empty before the start.
};

[[nodiscard]] GType backendType();

template <class Settings>
constexpr Property backendProperty() {
  return enumProperty<Settings, &Settings::backend>(
      "backend",
      "What does the work on pixels; the results are the same bits. When a GPU fails, the CPU goes "
      "on with the same frame",
      backendType, Mutable::Ready);
}
template <class Settings>
constexpr Property deviceIdProperty() {
  return property<Settings, &Settings::deviceId>(
      "device-id", "Number of the CUDA device, as nvidia-smi lists them", 0, 255, Mutable::Ready);
}
template <class Settings>
constexpr Property activeBackendProperty() {
  return property<Settings, &Settings::activeBackend>(
      "active-backend", "What is at work: cpu, or cuda with the device's name; empty when stopped",
      0, 0, Mutable::Never);
}

/// The device that was asked for; null: the CPU. An error where only CUDA will do. Elements of one
/// pipeline share what lies on a device, by a GstContext.
[[nodiscard]] Result<std::shared_ptr<Device>> openBackend(GstElement* element,
                                                          const BackendSettings& settings);

/// What a stage whose settings are `Settings` runs on; the CPU for a stage without the properties.
template <class Settings>
inline constexpr bool kHasBackend = std::derived_from<Settings, BackendSettings>;

}  // namespace rg
