// SPDX-License-Identifier: LGPL-2.1-or-later
// Folders and files for tests of what writes lines, and waiting for what other threads do.
#pragma once

#include "tests/support/harness.hpp"
#include "tests/support/results.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace rg::testing {

/// A folder of the test's own, which goes with it.
class WrittenLines : public ::testing::Test {
 protected:
  void SetUp() override {
    auto pattern = (std::filesystem::temp_directory_path() / "regionwrite-XXXXXX").string();
    ASSERT_TRUE(mkdtemp(pattern.data()));
    folder_ = pattern;
    path_ = (folder_ / "out").string();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] static std::string contentOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  [[nodiscard]] std::string written() const { return contentOf(path_); }

  std::filesystem::path folder_;
  std::string path_;
};

/// The lines of a text; what stands behind the last line feed is none.
inline std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  size_t begin = 0;
  for (size_t end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
    lines.push_back(text.substr(begin, end - begin));
  return lines;
}

/// A frame with so many objects.
inline BufferPtr frameWith(int index, int count, const Caps& caps = {}) {
  std::vector<objects::Object> list;
  for (int i = 0; i < count; ++i)
    list.push_back(object(static_cast<uint64_t>(i) + 1, {i % 50, 20, 8, 4}));
  BufferPtr buffer = paint(caps, index, square(1, 1, 5));
  attachResult<objects::Objects>(buffer.get(), objects({caps.width, caps.height}, std::move(list)));
  return buffer;
}

/// Plays a pipeline to its end, which is told: an end of stream or an error.
inline GstMessageType playToEnd(GstElement* pipeline) {
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline);
  const MessagePtr message(gst_bus_timed_pop_filtered(
      bus, GST_CLOCK_TIME_NONE, static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS)));
  gst_object_unref(bus);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  return GST_MESSAGE_TYPE(message.get());
}

/// Waits as long as it takes: a test that hangs has failed.
inline void await(const std::function<bool()>& isReached) {
  while (!isReached()) g_usleep(1000);
}

}  // namespace rg::testing
