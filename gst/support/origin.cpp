// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/origin.hpp"

#include <stdexcept>
#include <utility>

namespace rg {
namespace {

std::string checked(const char* text) {
  std::string copy = text ? text : "";
  if (copy.size() > text::kMostOriginBytes)
    throw std::invalid_argument("it may have " + std::to_string(text::kMostOriginBytes) +
                                " bytes at most");
  if (!g_utf8_validate(copy.data(), static_cast<gssize>(copy.size()), nullptr))
    throw std::invalid_argument("it is not UTF-8");
  return copy;
}

/// A copy of what is set with one part changed.
template <class Change>
OriginPtr changed(const OriginPtr& origin, Change change) {
  auto copy = origin ? std::make_shared<GivenOrigin>(*origin) : std::make_shared<GivenOrigin>();
  change(*copy);
  return copy->isEmpty() ? nullptr : copy;
}

}  // namespace

const char* sourceOf(const OriginSettings& settings) {
  return settings.origin ? settings.origin->source.c_str() : "";
}

void setSource(OriginSettings& settings, const char* text) {
  settings.origin = changed(settings.origin, [&](GivenOrigin& to) { to.source = checked(text); });
}

const char* tagsOf(const OriginSettings& settings) {
  return settings.origin ? settings.origin->tagsText.c_str() : "";
}

void setTags(OriginSettings& settings, const char* text) {
  settings.origin = changed(settings.origin, [&](GivenOrigin& to) {
    to.tagsText = checked(text);
    auto tags = text::parseTags(to.tagsText);
    if (!tags) throw std::invalid_argument(tags.error().message);
    to.tags = *std::move(tags);
  });
}

void setOrigin(GstStructure* fields, const OriginPtr& origin) {
  if (!origin) return;
  if (!origin->source.empty())
    gst_structure_set(fields, "source", G_TYPE_STRING, origin->source.c_str(), nullptr);
  if (origin->tags.empty()) return;
  GstStructure* tags = gst_structure_new_empty("tags");
  for (const auto& [key, value] : origin->tags)
    gst_structure_set(tags, key.c_str(), G_TYPE_STRING, value.c_str(), nullptr);
  gst_structure_set(fields, "tags", GST_TYPE_STRUCTURE, tags, nullptr);
  gst_structure_free(tags);
}

}  // namespace rg
