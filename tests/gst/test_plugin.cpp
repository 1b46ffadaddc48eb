// SPDX-License-Identifier: LGPL-2.1-or-later
// The plugin as a file: loaded, unloaded, scanned again, loaded in a child. In a process of its
// own, as other tests have the elements linked in.
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <dlfcn.h>
#include <filesystem>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace {

constexpr const char* kElements[] = {"bgremove",    "hsvsegment", "srg",        "prmmotion",
                                     "mrfmerge",    "haardetect", "regionmask", "regiontext",
                                     "regionwrite", "regiontrack"};

long threads() {
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  return std::distance(begin(tasks), end(tasks));
}

/// Runs a short stream through all elements; empty, or what went wrong.
std::string run() {
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(
      "videotestsrc pattern=ball num-buffers=15 ! video/x-raw,format=I420,width=96,height=64 ! "
      "regiontrack ! regionwrite location=/dev/null ! regionmask source=objects ! fakesink",
      &error);
  std::string text = error ? error->message : "";
  g_clear_error(&error);
  if (!text.empty()) return text;
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline);
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, 60 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS));
  if (!message || GST_MESSAGE_TYPE(message) != GST_MESSAGE_EOS) text = "no end of stream";
  if (message) gst_message_unref(message);
  gst_object_unref(bus);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
  return text;
}

/// Loads the plugin into the registry; false where that fails.
bool load() {
  GstPlugin* plugin = gst_plugin_load_file(PLUGIN_FILE, nullptr);
  if (!plugin) return false;
  gst_registry_add_plugin(gst_registry_get(), plugin);
  gst_object_unref(plugin);
  return true;
}

/// Says 0 where the body holds in a child that was forked before the plugin was loaded.
template <class Body>
int statusOfChild(Body body) {
  const pid_t child = fork();
  if (child == 0) _exit(body() ? 0 : 1);
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}

/// First of all: nothing of it may have run in this process before.
TEST(Plugin, LoadsInAChildOfAnInitialisedProcess) {
  EXPECT_EQ(statusOfChild([] { return load() && run().empty(); }), 0);
}

TEST(Plugin, StartsNoThreadWhenItIsLoaded) {
  const long before = threads();
  ASSERT_TRUE(load());
  EXPECT_EQ(threads(), before);
  for (const char* name : kElements) {
    GstElement* element = gst_element_factory_make(name, nullptr);
    ASSERT_TRUE(element) << name;
    gst_object_unref(element);
  }
  EXPECT_EQ(threads(), before);
  EXPECT_EQ(run(), "");
}

/// It stays in memory when nobody holds it: its types can't be taken back.
TEST(Plugin, IsClosedAndUsedAgain) {
  for (int round = 0; round < 20; ++round) {
    void* handle = dlopen(PLUGIN_FILE, RTLD_NOW | RTLD_LOCAL);
    ASSERT_TRUE(handle) << dlerror();
    EXPECT_TRUE(dlsym(handle, "gst_plugin_regiongraph_register"));
    EXPECT_EQ(dlclose(handle), 0);
    ASSERT_TRUE(load());
    if (round % 5 != 0) continue;
    EXPECT_EQ(run(), "");
  }
}

/// Found again on the path, and a second file of the same version beside it.
TEST(Plugin, IsFoundAgainAndTwice) {
  char name[] = "/tmp/regiongraph-plugin-XXXXXX";
  const std::filesystem::path folder = mkdtemp(name);
  std::filesystem::copy_file(PLUGIN_FILE, folder / "libgstregiongraph.so");
  const std::string here = std::filesystem::path(PLUGIN_FILE).parent_path();
  for (int round = 0; round < 3; ++round) {
    gst_registry_scan_path(gst_registry_get(), here.c_str());
    gst_registry_scan_path(gst_registry_get(), folder.c_str());
    EXPECT_EQ(run(), "");
  }
  std::filesystem::remove_all(folder);
}

}  // namespace

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  gst_init(&argc, &argv);
  g_log_set_always_fatal(static_cast<GLogLevelFlags>(G_LOG_LEVEL_CRITICAL | G_LOG_LEVEL_ERROR));
  const int status = RUN_ALL_TESTS();
  gst_deinit();
  return status;
}
