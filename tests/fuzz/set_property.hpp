// SPDX-License-Identifier: LGPL-2.1-or-later
// Properties of elements, set to anything that may be said of them.
#pragma once

#include "tests/fuzz/bytes.hpp"

#include <gst/gst.h>

#include <vector>

namespace rg::fuzz {

/// The elements in a bin, or the element itself; each kept alive by what it is in.
void listElements(GstElement* element, std::vector<GstElement*>& elements);

/// Sets one of the element's own writable properties: to an end of its range, to something in it or
/// beyond it. Files are neither written nor read, but for a few that every machine has.
void setRandomProperty(GstElement* element, Bytes& bytes);

/// A word that some property understands, or almost.
[[nodiscard]] std::string randomText(Bytes& bytes);

}  // namespace rg::fuzz
