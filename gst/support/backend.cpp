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

namespace {

using Shared = std::shared_ptr<Device>;

constexpr const char* kField = "device";

GType sharedType() {
  static const GType type = g_boxed_type_register_static(
      "GstRegionDevice",
      [](gpointer shared) -> gpointer { return new Shared(*static_cast<Shared*>(shared)); },
      [](gpointer shared) { delete static_cast<Shared*>(shared); });
  return type;
}

struct ContextUnref {
  void operator()(GstContext* context) const { gst_context_unref(context); }
};
using ContextPtr = std::unique_ptr<GstContext, ContextUnref>;

/// What a pipeline's elements have of one device.
std::string contextOf(int deviceId) {
  return "gst.regiongraph.Device." + std::to_string(deviceId);
}

/// Of an element of the same pipeline, or null.
Shared findShared(GstElement* element, const std::string& type) {
  ContextPtr context(gst_element_get_context(element, type.c_str()));
  if (!context) {
    gst_element_post_message(element,
                             gst_message_new_need_context(GST_OBJECT(element), type.c_str()));
    context.reset(gst_element_get_context(element, type.c_str()));
  }
  if (!context) return nullptr;
  const GValue* value = gst_structure_get_value(gst_context_get_structure(context.get()), kField);
  if (value == nullptr || !G_VALUE_HOLDS(value, sharedType())) return nullptr;
  return *static_cast<const Shared*>(g_value_get_boxed(value));
}

void share(GstElement* element, const std::string& type, const Shared& device) {
  const ContextPtr context(gst_context_new(type.c_str(), TRUE));
  gst_structure_set(gst_context_writable_structure(context.get()), kField, sharedType(), &device,
                    nullptr);
  gst_element_set_context(element, context.get());
  gst_element_post_message(
      element, gst_message_new_have_context(GST_OBJECT(element), gst_context_ref(context.get())));
}

Result<Shared> openShared(GstElement* element, int deviceId) {
  const std::string type = contextOf(deviceId);
  Shared shared = findShared(element, type);
  if (!shared) {
    auto opened = gpu::openDevice(deviceId);
    if (!opened) return opened;
    shared = *std::move(opened);
    share(element, type, shared);
  }
  return gpu::openDevice(deviceId, shared);
}

}  // namespace

Result<Shared> openBackend(GstElement* element, const BackendSettings& settings) {
  if (settings.backend == Backend::Cpu) return Shared();
  auto device = openShared(element, settings.deviceId);
  if (device || settings.backend == Backend::Cuda) return device;
  GST_INFO("backend=auto takes the CPU: %s", device.error().message.c_str());
  return Shared();
}

}  // namespace rg
