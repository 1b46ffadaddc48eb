// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/backend.hpp"

#include "kernels/backend/open_device.hpp"

namespace rg {

GType backendType() {
  static const GEnumValue values[] = {
      {static_cast<int>(Backend::Auto), "CUDA where there is a device, else the CPU", "auto"},
      {static_cast<int>(Backend::Cpu), "The CPU", "cpu"},
      {static_cast<int>(Backend::Cuda), "A CUDA device; without one it is an error to start",
       "cuda"},
      {0, nullptr, nullptr}};
  static const GType type = registerEnum("GstRegionBackend", values);
  return type;
}

Result<std::shared_ptr<Device>> openBackend(const BackendSettings& settings) {
  if (settings.backend == Backend::Cpu) return std::shared_ptr<Device>();
  auto device = gpu::openDevice(settings.deviceId);
  if (device || settings.backend == Backend::Cuda) return device;
  GST_INFO("backend=auto takes the CPU: %s", device.error().message.c_str());
  return std::shared_ptr<Device>();
}

}  // namespace rg
