// SPDX-License-Identifier: LGPL-2.1-or-later
// Every property of every element with every extreme, at any time, from any thread, with objects in
// view.
#include "tests/support/busy_scene.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

namespace rg {
namespace {

using testing::beginStream;
using testing::BufferPtr;
using testing::busyFrame;
using testing::campaign;
using testing::Caps;
using testing::Chain;
using testing::Chance;
using testing::showObjects;
using testing::Watchdog;

const Caps kSmall{"I420", 96, 64};
constexpr const char* kElements[] = {"bgremove", "hsvsegment", "srg", "prmmotion", "mrfmerge"};
constexpr const char* kTexts[] = {nullptr,
                                  "",
                                  "-",
                                  "auto",
                                  "80-160",
                                  "350-10",
                                  "0,0 1,0 1,1 0,1",
                                  "exclude 0,0 1,0 1,1 0,1",
                                  "0,0.001 0.001,0 0.002,0.003",
                                  "nan,nan inf,-inf 1e308,1e-308 0,0",
                                  ";;;;exclude;exclude",
                                  "%s%n%d",
                                  "\xff\xfe\x80",
                                  "/dev/null",
                                  "/nowhere/mask.png"};

/// GLib tells each value out of range; here that is meant.
class OutOfRangeIsMeant {
 public:
  OutOfRangeIsMeant()
      : handler_(g_log_set_handler(
            "GLib-GObject", G_LOG_LEVEL_WARNING,
            [](const gchar*, GLogLevelFlags, const gchar*, gpointer) {}, nullptr)) {}
  ~OutOfRangeIsMeant() { g_log_remove_handler("GLib-GObject", handler_); }
  OutOfRangeIsMeant(const OutOfRangeIsMeant&) = delete;
  OutOfRangeIsMeant& operator=(const OutOfRangeIsMeant&) = delete;

 private:
  guint handler_;
};

/// A property that may be set now, and would not write where it should not.
bool isSettable(const GParamSpec* spec, bool isRunning) {
  const std::string name = spec->name;
  if (!(spec->flags & G_PARAM_WRITABLE) || (spec->flags & G_PARAM_CONSTRUCT_ONLY)) return false;
  if (name == "name" || name == "parent" || name == "message-forward" || name == "async-handling")
    return false;
  const bool isOurs = spec->owner_type != GST_TYPE_BIN && spec->owner_type != GST_TYPE_ELEMENT;
  return isOurs && (!isRunning || (spec->flags & GST_PARAM_MUTABLE_PLAYING));
}

template <class T>
T someOf(Chance& chance, T least, T most, T usual) {
  const T values[] = {least, most, usual, static_cast<T>(least / 2 + most / 2)};
  return chance.pick(values);
}

/// An extreme, the default or something between; doubles may also be no number at all.
void setSome(GObject* object, GParamSpec* spec, Chance& chance) {
  GValue value = G_VALUE_INIT;
  g_value_init(&value, spec->value_type);
  if (G_IS_PARAM_SPEC_INT(spec)) {
    const auto* s = G_PARAM_SPEC_INT(spec);
    g_value_set_int(&value, someOf(chance, s->minimum, s->maximum, s->default_value));
  } else if (G_IS_PARAM_SPEC_DOUBLE(spec)) {
    const auto* s = G_PARAM_SPEC_DOUBLE(spec);
    g_value_set_double(&value, chance.isOneIn(6)
                                   ? (chance.isOneIn(2) ? NAN : INFINITY)
                                   : someOf(chance, s->minimum, s->maximum, s->default_value));
  } else if (G_IS_PARAM_SPEC_BOOLEAN(spec)) {
    g_value_set_boolean(&value, chance.isOneIn(2));
  } else if (G_IS_PARAM_SPEC_ENUM(spec)) {
    const auto* values = G_PARAM_SPEC_ENUM(spec)->enum_class;
    g_value_set_enum(&value,
                     values->values[chance.below(static_cast<int>(values->n_values))].value);
  } else if (G_IS_PARAM_SPEC_STRING(spec)) {
    g_value_set_string(&value, chance.isOneIn(3) ? chance.pick(kTexts) : "");
  } else {
    g_param_value_set_default(spec, &value);
  }
  g_object_set_property(object, spec->name, &value);
  g_object_get_property(object, spec->name, &value);
  g_value_unset(&value);
}

void setEverything(GObject* object, bool isRunning, Chance& chance) {
  guint count = 0;
  GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(object), &count);
  for (guint i = 0; i < count; ++i)
    if (isSettable(specs[i], isRunning) && std::string(specs[i]->name) != "location" &&
        chance.isOneIn(2))
      setSome(object, specs[i], chance);
  g_free(specs);
}

void setDefaults(GObject* object) {
  guint count = 0;
  GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(object), &count);
  for (guint i = 0; i < count; ++i) {
    if (!isSettable(specs[i], false) || std::string(specs[i]->name) == "location") continue;
    GValue value = G_VALUE_INIT;
    g_value_init(&value, specs[i]->value_type);
    g_param_value_set_default(specs[i], &value);
    g_object_set_property(object, specs[i]->name, &value);
    g_value_unset(&value);
  }
  g_free(specs);
}

void drain(Chain& chain) {
  while (GstBuffer* out = gst_harness_try_pull(chain.harness())) gst_buffer_unref(out);
  while (GstMessage* message = chain.message(GST_MESSAGE_ANY).release()) gst_message_unref(message);
}

std::string everything() {
  const bool hasOverlay = gst_element_factory_find("regionoverlay") != nullptr;
  return std::string(testing::kQuickStages) + " ! regionwrite location=/dev/null" +
         (hasOverlay ? " ! regionoverlay" : "");
}

std::vector<GstElement*> elementsOf(const Chain& chain) {
  std::vector<GstElement*> elements;
  GstIterator* all = gst_bin_iterate_elements(GST_BIN(chain.harness()->element));
  GValue item = G_VALUE_INIT;
  while (gst_iterator_next(all, &item) == GST_ITERATOR_OK) {
    elements.push_back(GST_ELEMENT(g_value_get_object(&item)));
    g_value_reset(&item);
  }
  g_value_unset(&item);
  gst_iterator_free(all);
  return elements;
}

/// In each state, also in those where a value is taken only by the next start.
TEST(Properties, TakeEveryExtremeInEveryState) {
  const OutOfRangeIsMeant quiet;
  Chance chance;
  Chain chain(everything(), kSmall);
  const auto elements = elementsOf(chain);
  constexpr GstState kStates[] = {GST_STATE_NULL, GST_STATE_READY, GST_STATE_PAUSED,
                                  GST_STATE_PLAYING};
  int index = 0;
  ASSERT_TRUE(showObjects(chain, index));
  for (int round = campaign(250); round > 0; --round) {
    const GstState state = chance.pick(kStates);
    const auto reached = gst_element_set_state(chain.harness()->element, state);
    const bool isRunning = state >= GST_STATE_PAUSED && reached != GST_STATE_CHANGE_FAILURE;
    if (isRunning) beginStream(chain);
    for (int i = isRunning ? chance.below(12) : 0; i > 0; --i)
      (void)chain.push(busyFrame(kSmall, index++));
    for (GstElement* element : elements)
      setEverything(G_OBJECT(element), state >= GST_STATE_PAUSED, chance);
    for (int i = isRunning ? chance.below(4) : 0; i > 0; --i)
      (void)chain.push(busyFrame(kSmall, index++));
    drain(chain);
  }
  gst_element_set_state(chain.harness()->element, GST_STATE_NULL);
  for (GstElement* element : elements) setDefaults(G_OBJECT(element));
  ASSERT_EQ(gst_element_set_state(chain.harness()->element, GST_STATE_PLAYING),
            GST_STATE_CHANGE_SUCCESS);
  beginStream(chain);
  index = 0;
  EXPECT_TRUE(showObjects(chain, index));
}

/// While frames pass, also those of other sizes; with defaults again objects are in view again.
TEST(Properties, TakeEveryExtremeBetweenFrames) {
  const OutOfRangeIsMeant quiet;
  Chance chance;
  Chain chain(everything(), kSmall);
  const auto elements = elementsOf(chain);
  int index = 0;
  ASSERT_TRUE(showObjects(chain, index));
  for (int round = campaign(150); round > 0; --round) {
    setEverything(G_OBJECT(chance.pick(elements)), true, chance);
    if (chance.isOneIn(8))
      chain.setCaps(
          {chance.pick(testing::kAllFormats), chance.between(1, 120), chance.between(1, 90)});
    for (int i = chance.between(1, 5); i > 0; --i)
      ASSERT_EQ(chain.push(busyFrame(chain.caps(), index++)), GST_FLOW_OK);
    if (chance.isOneIn(6))
      for (GstElement* element : elements) setDefaults(G_OBJECT(element));
    drain(chain);
  }
  for (GstElement* element : elements) setDefaults(G_OBJECT(element));
  chain.setCaps({"I420", 98, 64});
  index = 0;
  EXPECT_TRUE(showObjects(chain, index));
}

/// Getters and setters of every property on two threads of their own.
TEST(Properties, ChangeWhileAnotherThreadPushes) {
  const OutOfRangeIsMeant quiet;
  const Watchdog watchdog(240);
  Chain chain(everything(), kSmall);
  gst_harness_set_drop_buffers(chain.harness(), TRUE);
  const auto elements = elementsOf(chain);
  std::atomic<bool> isDone = false;
  std::vector<std::thread> threads;
  for (uint32_t i = 0; i < 2; ++i)
    threads.emplace_back([&, i] {
      Chance chance(i);
      while (!isDone) {
        setEverything(G_OBJECT(chance.pick(elements)), true, chance);
        g_usleep(200);
      }
    });
  for (int i = 0; i < campaign(400); ++i) {
    EXPECT_EQ(chain.push(busyFrame(kSmall, i)), GST_FLOW_OK);
    while (GstMessage* message = chain.message(GST_MESSAGE_ANY).release())
      gst_message_unref(message);
  }
  isDone = true;
  for (std::thread& thread : threads) thread.join();
  for (GstElement* element : elements) setDefaults(G_OBJECT(element));
  gst_harness_set_drop_buffers(chain.harness(), FALSE);
  chain.setCaps({"I420", 98, 64});
  int index = 0;
  EXPECT_TRUE(showObjects(chain, index));
}

/// As gst-launch-1.0 reads them: nonsense leaves a value in range.
TEST(Properties, AreReadFromAnyText) {
  const OutOfRangeIsMeant quiet;
  Chance chance;
  for (const char* name : kElements) {
    GstElement* element = gst_element_factory_make(name, nullptr);
    gst_object_ref_sink(element);
    guint count = 0;
    GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
    for (guint i = 0; i < count; ++i) {
      if (!isSettable(specs[i], false)) continue;
      for (int round = campaign(40); round > 0; --round) {
        std::string text;
        for (int length = chance.below(12); length > 0; --length)
          text += static_cast<char>(chance.isOneIn(3) ? chance.between(1, 255)
                                                      : "0123456789.-+e,; "[chance.below(17)]);
        gst_util_set_object_arg(G_OBJECT(element), specs[i]->name, text.c_str());
        GValue value = G_VALUE_INIT;
        g_value_init(&value, specs[i]->value_type);
        g_object_get_property(G_OBJECT(element), specs[i]->name, &value);
        EXPECT_FALSE(!G_IS_PARAM_SPEC_STRING(specs[i]) && g_param_value_validate(specs[i], &value))
            << name << ' ' << specs[i]->name << '=' << text;
        g_value_unset(&value);
      }
    }
    g_free(specs);
    gst_object_unref(element);
  }
}

}  // namespace
}  // namespace rg
