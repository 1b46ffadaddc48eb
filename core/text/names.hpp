// SPDX-License-Identifier: LGPL-2.1-or-later
// The words that files, metas and messages use for the core's enumerations: one spelling for all.
#pragma once

#include "core/objects.hpp"
#include "core/stage.hpp"

#include <string_view>

namespace rg::text {

[[nodiscard]] constexpr std::string_view name(Status status) {
  switch (status) {
    case Status::Ok:
      return "ok";
    case Status::Training:
      return "training";
    case Status::Skipped:
      return "skipped";
  }
  return "skipped";
}

[[nodiscard]] constexpr std::string_view name(ObjectState state) {
  switch (state) {
    case ObjectState::New:
      return "new";
    case ObjectState::Tracked:
      return "tracked";
    case ObjectState::Stopped:
      return "stopped";
    case ObjectState::Occluded:
      return "occluded";
    case ObjectState::Lost:
      return "lost";
  }
  return "lost";
}

[[nodiscard]] constexpr std::string_view name(EventKind kind) {
  switch (kind) {
    case EventKind::ObjectNew:
      return "object-new";
    case EventKind::ObjectEnd:
      return "object-end";
    case EventKind::Merge:
      return "merge";
    case EventKind::Split:
      return "split";
    case EventKind::SceneChanged:
      return "scene-changed";
  }
  return "scene-changed";
}

}  // namespace rg::text
