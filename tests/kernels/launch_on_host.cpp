// SPDX-License-Identifier: LGPL-2.1-or-later
// gst-launch-1.0 for pipelines whose elements have a device that is the host (kernels/shim).
//
// usage: launch-on-host PIPELINE...   Ends with the stream: 0, or 1 after an error or a warning.
#include "kernels/shim/block.hpp"
#include "kernels/shim/faults.hpp"
#include "tests/support/harness.hpp"

#include <gst/gst.h>

#include <cstdio>
#include <memory>

namespace rg::testing {
namespace {

/// Runs it to its end. False, with what happened on stderr, if it did not go well.
bool play(GstElement* pipeline) {
  const BusPtr bus(gst_element_get_bus(pipeline));
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  const MessagePtr message(gst_bus_timed_pop_filtered(
      bus.get(), GST_CLOCK_TIME_NONE,
      static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR | GST_MESSAGE_WARNING)));
  gst_element_set_state(pipeline, GST_STATE_NULL);
  if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_EOS) return true;
  GError* error = nullptr;
  if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_ERROR)
    gst_message_parse_error(message.get(), &error, nullptr);
  else
    gst_message_parse_warning(message.get(), &error, nullptr);
  std::fprintf(stderr, "launch-on-host: %s\n", error->message);
  g_error_free(error);
  return false;
}

int launch(char** words) {
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launchv(const_cast<const gchar**>(words), &error);
  if (error != nullptr) {
    std::fprintf(stderr, "launch-on-host: %s\n", error->message);
    g_error_free(error);
    if (pipeline != nullptr) gst_object_unref(pipeline);
    return 1;
  }
  gst_object_ref_sink(pipeline);
  const bool isFine = play(pipeline);
  gst_object_unref(pipeline);
  for (const std::string& finding : gpu::shim::findings())
    std::fprintf(stderr, "launch-on-host: %s\n", finding.c_str());
  return isFine && gpu::shim::findings().empty() ? 0 : 1;
}

}  // namespace
}  // namespace rg::testing

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  rg::testing::registerElements();
  rg::gpu::shim::begin({});
  rg::gpu::shim::plan({});
  return argc > 1 ? rg::testing::launch(argv + 1) : 1;
}
