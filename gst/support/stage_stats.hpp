// SPDX-License-Identifier: LGPL-2.1-or-later
// What a stage element tells of its work: figures for a program, lines for a person.
#pragma once

#include "gst/support/properties.hpp"

#include <gst/gst.h>

#include <algorithm>
#include <cstdint>
#include <string>

namespace rg {

/// Since the element started.
struct StageStats {
  guint64 frames = 0;
  guint64 dropped = 0;  ///< Of them: without a result.
  guint64 totalNs = 0;
  guint64 worstNs = 0;

  void add(guint64 ns) {
    ++frames;
    totalNs += ns;
    worstNs = std::max(worstNs, ns);
  }
};

/// A new structure "regiongraph-stats".
[[nodiscard]] GstStructure* structureOf(const StageStats& stats);

/// For settings with a member `stats`.
template <class Settings>
constexpr Property statsProperty() {
  Property p{"stats",
             "Since the start: frames (guint64), dropped (guint64: those of them that got no "
             "result), ms-mean and ms-worst (double: the element's own time for a frame)",
             Mutable::Never,
             0,
             0,
             nullptr,
             nullptr,
             nullptr,
             nullptr};
  p.makeSpec = [](const Property& self, const void*, GParamFlags flags) -> GParamSpec* {
    return g_param_spec_boxed(self.name, self.name, self.blurb, GST_TYPE_STRUCTURE, flags);
  };
  p.get = [](const void* settings, GValue* value) {
    g_value_take_boxed(value, structureOf(static_cast<const Settings*>(settings)->stats));
  };
  p.set = [](void*, const GValue*) {};
  return p;
}

/// What a stage says of a frame to a person who tunes it.
struct Progress {
  uint64_t state = 0;  ///< What differs from the frame before is told at once.
  std::string text;
};

/// Tells at level DEBUG, once a second and when something changes.
class ProgressLog {
 public:
  [[nodiscard]] static bool isOn(GstDebugCategory* category) {
    return gst_debug_category_get_threshold(category) >= GST_LEVEL_DEBUG;
  }
  void tell(GstElement* element, GstDebugCategory* category, const Progress& progress,
            GstClockTime pts, const StageStats& stats);
  void restart() { *this = {}; }

 private:
  uint64_t state_ = UINT64_MAX;
  GstClockTime toldAt_ = 0;
  StageStats toldStats_;
};

}  // namespace rg
