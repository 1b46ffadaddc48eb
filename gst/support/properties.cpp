// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/properties.hpp"

namespace rg {

GParamFlags flagsOf(Mutable when) {
  const int readable = G_PARAM_READABLE | G_PARAM_STATIC_STRINGS;
  switch (when) {
    case Mutable::Playing:
      return static_cast<GParamFlags>(readable | G_PARAM_WRITABLE | GST_PARAM_MUTABLE_PLAYING |
                                      GST_PARAM_CONTROLLABLE);
    case Mutable::Ready:
      return static_cast<GParamFlags>(readable | G_PARAM_WRITABLE | GST_PARAM_MUTABLE_READY);
    case Mutable::Never:
      break;
  }
  return static_cast<GParamFlags>(readable);
}

void installProperties(GObjectClass* klass, std::span<const Property> table, const void* defaults) {
  guint id = 1;
  for (const Property& property : table)
    g_object_class_install_property(klass, id++,
                                    property.makeSpec(property, defaults, flagsOf(property.when)));
}

GType registerEnum(const char* name, const GEnumValue* values) {
  const GType type = g_enum_register_static(name, values);
  gst_type_mark_as_plugin_api(type, static_cast<GstPluginAPIFlags>(0));
  return type;
}

}  // namespace rg
