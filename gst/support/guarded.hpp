// SPDX-License-Identifier: LGPL-2.1-or-later
// The border between C++ and the C code that calls an element.
#pragma once

#include <gst/gst.h>

#include <exception>
#include <new>

namespace rg {

/// Runs the body of a vfunc. An exception must not unwind through C: it becomes an error on the bus
/// and the value `failed`.
template <class T, class Body>
T guarded(gpointer element, T failed, Body body) noexcept {
  const char* what = "unknown exception";
  try {
    return body();
  } catch (const std::bad_alloc&) {
    what = "out of memory";
  } catch (const std::exception& e) {
    GST_ELEMENT_ERROR(element, LIBRARY, FAILED, ("Internal error: %s.", e.what()), (nullptr));
    return failed;
  } catch (...) {
  }
  GST_ELEMENT_ERROR(element, LIBRARY, FAILED, ("Internal error: %s.", what), (nullptr));
  return failed;
}

}  // namespace rg
