// SPDX-License-Identifier: LGPL-2.1-or-later
// Enums that other elements and applications filled in.
#pragma once

#include <cstring>
#include <type_traits>

namespace rg {

/// The number in an enum of a C struct. It may be none of the enum's values: a GstVideoMeta that
/// lies, a format that an application registered. To read such a one as the enum is undefined.
template <class Enum>
[[nodiscard]] int numberIn(const Enum& value) {
  static_assert(std::is_enum_v<Enum> && sizeof(Enum) == sizeof(int));
  int number = 0;
  std::memcpy(&number, &value, sizeof number);
  return number;
}

}  // namespace rg
