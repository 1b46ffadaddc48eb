// SPDX-License-Identifier: LGPL-2.1-or-later
// The words that files, metas and messages use for the core's enumerations: one spelling for all.
#pragma once

#include "core/base/stage.hpp"
#include "core/objects/objects.hpp"

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

[[nodiscard]] constexpr std::string_view name(objects::ObjectState state) {
  switch (state) {
    case objects::ObjectState::New:
      return "new";
    case objects::ObjectState::Tracked:
      return "tracked";
    case objects::ObjectState::Stopped:
      return "stopped";
    case objects::ObjectState::Occluded:
      return "occluded";
    case objects::ObjectState::Lost:
      return "lost";
  }
  return "lost";
}

[[nodiscard]] constexpr std::string_view name(objects::EventKind kind) {
  switch (kind) {
    case objects::EventKind::ObjectNew:
      return "object-new";
    case objects::EventKind::ObjectEnd:
      return "object-end";
    case objects::EventKind::Merge:
      return "merge";
    case objects::EventKind::Split:
      return "split";
    case objects::EventKind::SceneChanged:
      return "scene-changed";
  }
  return "scene-changed";
}

}  // namespace rg::text
