// SPDX-License-Identifier: LGPL-2.1-or-later
// The properties source and tags: the user's own words in every line and message.
#pragma once

#include "core/text/text.hpp"
#include "gst/support/properties.hpp"

#include <gst/gst.h>

#include <memory>
#include <string>

namespace rg {

struct GivenOrigin : text::Origin {
  std::string tagsText;  ///< The tags as they were given.
};
/// Null where neither source nor tags are set. Shared, as settings are copied for each frame.
using OriginPtr = std::shared_ptr<const GivenOrigin>;

/// What setters refuse throws std::invalid_argument with the reason, and leaves all as it was.
struct OriginSettings {
  OriginPtr origin;
};
[[nodiscard]] const char* sourceOf(const OriginSettings& settings);
void setSource(OriginSettings& settings, const char* text);
[[nodiscard]] const char* tagsOf(const OriginSettings& settings);
void setTags(OriginSettings& settings, const char* text);

namespace detail {

template <class Settings, auto get, auto set>
constexpr Property originProperty(const char* name, const char* blurb) {
  Property p{name, blurb, Mutable::Playing, 0, 0, nullptr, nullptr, nullptr, nullptr};
  p.makeSpec = [](const Property& self, const void*, GParamFlags flags) -> GParamSpec* {
    return g_param_spec_string(self.name, self.name, self.blurb, "", flags);
  };
  p.get = [](const void* settings, GValue* value) {
    const OriginSettings& from = *static_cast<const Settings*>(settings);
    g_value_set_string(value, get(from));
  };
  p.set = [](void* settings, const GValue* value) {
    OriginSettings& to = *static_cast<Settings*>(settings);
    set(to, g_value_get_string(value));
  };
  return p;
}

}  // namespace detail

template <class Settings>
constexpr Property sourceProperty() {
  return detail::originProperty<Settings, sourceOf, setSource>(
      "source",
      "Where the frames come from, in your own words, as \"gate 3\": told in every message and "
      "line of JSON; empty = not told");
}

template <class Settings>
constexpr Property tagsProperty() {
  return detail::originProperty<Settings, tagsOf, setTags>(
      "tags",
      "Words of your own, as \"site=north, lane=7\": told in every message and line of JSON, there "
      "as an object. Keys begin with a letter; values with commas stand in double quotes");
}

/// Adds the fields "source" (text) and "tags" (a GstStructure of texts), as far as they are set.
void setOrigin(GstStructure* fields, const OriginPtr& origin);

}  // namespace rg
