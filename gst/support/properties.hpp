// SPDX-License-Identifier: LGPL-2.1-or-later
// Properties as a table: one line each says name, meaning, range and where the value lives.
#pragma once

#include <gst/gst.h>

#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string>
#include <type_traits>

namespace rg {

/// Texts are copied for each frame: what lies beyond is cut off. No text that means anything is as
/// long, so that it is refused where it is read.
inline constexpr size_t kMostTextBytes = size_t{1} << 20;

/// When a property may change.
enum class Mutable { Playing, Ready, Never };

/// One property of an element whose values live in a struct of settings. Its default is what a
/// fresh struct holds. Where `set` throws std::invalid_argument the element says why it is refused.
struct Property {
  const char* name;
  const char* blurb;
  Mutable when;
  double least;
  double most;
  GType (*enumType)();
  GParamSpec* (*makeSpec)(const Property&, const void* defaults, GParamFlags flags);
  void (*get)(const void* settings, GValue* value);
  void (*set)(void* settings, const GValue* value);
};

namespace detail {

template <class Settings, auto Member>
using ValueOf = std::remove_reference_t<decltype(std::declval<Settings&>().*Member)>;

template <class Settings, auto Member>
const auto& valueIn(const void* settings) {
  return static_cast<const Settings*>(settings)->*Member;
}
template <class Settings, auto Member>
auto& valueIn(void* settings) {
  return static_cast<Settings*>(settings)->*Member;
}

}  // namespace detail

/// An int, a double, a bool or a string, by the type of the member.
template <class Settings, auto Member>
constexpr Property property(const char* name, const char* blurb, double least = 0, double most = 0,
                            Mutable when = Mutable::Playing) {
  using Value = detail::ValueOf<Settings, Member>;
  Property p{name, blurb, when, least, most, nullptr, nullptr, nullptr, nullptr};
  p.makeSpec = [](const Property& self, const void* defaults, GParamFlags flags) -> GParamSpec* {
    const Value& value = detail::valueIn<Settings, Member>(defaults);
    if constexpr (std::is_same_v<Value, bool>)
      return g_param_spec_boolean(self.name, self.name, self.blurb, value, flags);
    else if constexpr (std::is_same_v<Value, int>)
      return g_param_spec_int(self.name, self.name, self.blurb, static_cast<int>(self.least),
                              static_cast<int>(self.most), value, flags);
    else if constexpr (std::is_same_v<Value, guint64>)
      return g_param_spec_uint64(self.name, self.name, self.blurb, 0, G_MAXUINT64, value, flags);
    else if constexpr (std::is_same_v<Value, double>)
      return g_param_spec_double(self.name, self.name, self.blurb, self.least, self.most, value,
                                 flags);
    else
      return g_param_spec_string(self.name, self.name, self.blurb, value.c_str(), flags);
  };
  p.get = [](const void* settings, GValue* value) {
    const Value& from = detail::valueIn<Settings, Member>(settings);
    if constexpr (std::is_same_v<Value, bool>)
      g_value_set_boolean(value, from);
    else if constexpr (std::is_same_v<Value, int>)
      g_value_set_int(value, from);
    else if constexpr (std::is_same_v<Value, guint64>)
      g_value_set_uint64(value, from);
    else if constexpr (std::is_same_v<Value, double>)
      g_value_set_double(value, from);
    else
      g_value_set_string(value, from.c_str());
  };
  p.set = [](void* settings, const GValue* value) {
    Value& to = detail::valueIn<Settings, Member>(settings);
    if constexpr (std::is_same_v<Value, bool>) {
      to = g_value_get_boolean(value) != FALSE;
    } else if constexpr (std::is_same_v<Value, int>) {
      to = g_value_get_int(value);
    } else if constexpr (std::is_same_v<Value, guint64>) {
      to = g_value_get_uint64(value);
    } else if constexpr (std::is_same_v<Value, double>) {
      to = g_value_get_double(value);
    } else {
      const char* text = g_value_get_string(value);
      to.assign(text ? text : "", text ? strnlen(text, kMostTextBytes) : 0);
    }
  };
  return p;
}

/// An enum; `type` gives its GType.
template <class Settings, auto Member>
constexpr Property enumProperty(const char* name, const char* blurb, GType (*type)(),
                                Mutable when = Mutable::Playing) {
  using Value = detail::ValueOf<Settings, Member>;
  static_assert(std::is_enum_v<Value>);
  Property p{name, blurb, when, 0, 0, type, nullptr, nullptr, nullptr};
  p.makeSpec = [](const Property& self, const void* defaults, GParamFlags flags) -> GParamSpec* {
    return g_param_spec_enum(self.name, self.name, self.blurb, self.enumType(),
                             static_cast<int>(detail::valueIn<Settings, Member>(defaults)), flags);
  };
  p.get = [](const void* settings, GValue* value) {
    g_value_set_enum(value, static_cast<int>(detail::valueIn<Settings, Member>(settings)));
  };
  p.set = [](void* settings, const GValue* value) {
    detail::valueIn<Settings, Member>(settings) = static_cast<Value>(g_value_get_enum(value));
  };
  return p;
}

/// What a property's spec says of when it may be read and changed.
[[nodiscard]] GParamFlags flagsOf(Mutable when);

/// Adds the table's properties to a class; ids are index + 1.
void installProperties(GObjectClass* klass, std::span<const Property> table, const void* defaults);

/// Registers an enum and marks it as part of the plugin's interface. `values` ends with a row of
/// nulls and must live for ever.
GType registerEnum(const char* name, const GEnumValue* values);

}  // namespace rg
