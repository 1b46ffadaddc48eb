// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/fuzz/set_property.hpp"

#include <array>
#include <cstring>
#include <limits>
#include <memory>

namespace rg::fuzz {
namespace {

constexpr int kMostThreads = 3;
constexpr const char* kWords[] = {
    "",
    "auto",
    "0,0 1,0 1,1 0,1",
    "0,0.5 1,0.5 1,1 0,1; exclude 0.4,0.6 0.5,0.6 0.5,0.7",
    "exclude 0,0 1,0 1,1 0,1",
    "0.5,0.5 0.5001,0.5 0.5,0.5001",
    "1e308,-1e308 nan,inf 0,0",
    "350-10",
    "80-160",
    "-5-400",
    "/dev/null",
    "/nonexistent/mask.png",
    ".",
};

template <class T>
T numberIn(T least, T most, T normal, Bytes& bytes) {
  switch (bytes.between(0, 4)) {
    case 0:
      return least;
    case 1:
      return most;
    case 2:
      return normal;
    default:
      if constexpr (std::is_integral_v<T>)
        return bytes.between(least, most);
      else
        return least + (most - least) * bytes.take<uint16_t>() / T{65535};
  }
}

void setEnum(GstElement* element, GParamSpec* spec, Bytes& bytes) {
  const GEnumClass* values = G_PARAM_SPEC_ENUM(spec)->enum_class;
  const guint index = bytes.between(0u, values->n_values - 1);
  g_object_set(element, spec->name, values->values[index].value, nullptr);
}

void setNumber(GstElement* element, GParamSpec* spec, Bytes& bytes) {
  if (std::strcmp(spec->name, "threads") == 0)
    return g_object_set(element, spec->name, bytes.between(0, kMostThreads), nullptr);
  if (G_IS_PARAM_SPEC_INT(spec)) {
    const auto* range = G_PARAM_SPEC_INT(spec);
    g_object_set(element, spec->name,
                 numberIn(range->minimum, range->maximum, range->default_value, bytes), nullptr);
  } else if (G_IS_PARAM_SPEC_UINT(spec)) {
    const auto* range = G_PARAM_SPEC_UINT(spec);
    g_object_set(element, spec->name,
                 numberIn(range->minimum, range->maximum, range->default_value, bytes), nullptr);
  } else if (G_IS_PARAM_SPEC_DOUBLE(spec)) {
    const auto* range = G_PARAM_SPEC_DOUBLE(spec);
    g_object_set(element, spec->name,
                 numberIn(range->minimum, range->maximum, range->default_value, bytes), nullptr);
  }
}

bool isWritable(const GParamSpec* spec) {
  return (spec->flags & G_PARAM_WRITABLE) != 0 && (spec->flags & G_PARAM_CONSTRUCT_ONLY) == 0;
}

/// Those of the element's own class; a base class' own are not for this project to test.
bool isOurs(const GParamSpec* spec) {
  const char* const kForeign[] = {"GstObject", "GstElement", "GstBaseTransform", "GstBin"};
  for (const char* type : kForeign)
    if (std::strcmp(g_type_name(spec->owner_type), type) == 0) return false;
  return std::strcmp(spec->name, "location") != 0;
}

}  // namespace

void listElements(GstElement* element, std::vector<GstElement*>& elements) {
  elements.push_back(element);
  if (!GST_IS_BIN(element)) return;
  for (GList* child = GST_BIN(element)->children; child; child = child->next)
    listElements(GST_ELEMENT(child->data), elements);
}

std::string randomText(Bytes& bytes) {
  if (bytes.flip()) return bytes.pick(kWords);
  return bytes.text(60);
}

void setRandomProperty(GstElement* element, Bytes& bytes) {
  guint count = 0;
  const std::unique_ptr<GParamSpec*, void (*)(gpointer)> specs(
      g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count), g_free);
  std::vector<GParamSpec*> ours;
  for (guint i = 0; i < count; ++i)
    if (isWritable(specs.get()[i]) && isOurs(specs.get()[i])) ours.push_back(specs.get()[i]);
  if (ours.empty()) return;
  GParamSpec* spec = bytes.pick(ours);
  if (G_IS_PARAM_SPEC_BOOLEAN(spec))
    g_object_set(element, spec->name, static_cast<gboolean>(bytes.flip()), nullptr);
  else if (G_IS_PARAM_SPEC_ENUM(spec))
    setEnum(element, spec, bytes);
  else if (G_IS_PARAM_SPEC_STRING(spec))
    g_object_set(element, spec->name, bytes.flip() ? randomText(bytes).c_str() : nullptr, nullptr);
  else
    setNumber(element, spec, bytes);
}

}  // namespace rg::fuzz
