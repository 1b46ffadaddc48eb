// SPDX-License-Identifier: LGPL-2.1-or-later
// Results as bytes, for buffers that go to another process or into a file. Numbers are written
// lowest byte first, pixels as runs along the rows.
#pragma once

#include "core/objects/objects.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace rg {

inline constexpr uint8_t kStoredVersion = 2;

/// All that readers are told of a result; not what it was made from.
template <class Payload>
[[nodiscard]] std::vector<uint8_t> store(const Payload& result);

/// The result of such bytes, with the planes packed for readers; null where the bytes are none or
/// contradict themselves. Throws std::bad_alloc.
template <class Payload>
[[nodiscard]] std::shared_ptr<Payload> restore(std::span<const uint8_t> bytes);

/// Gives a restored result what it was made from, as far as that is there. False where they
/// contradict each other.
[[nodiscard]] bool join(segmentation::Labels& labels,
                        std::shared_ptr<const background::Foreground> foreground);
[[nodiscard]] bool join(graph::Graph& graph, std::shared_ptr<const segmentation::Labels> labels);
[[nodiscard]] bool join(motion::Motion& motion, std::shared_ptr<const graph::Graph> graph);
[[nodiscard]] bool join(objects::Objects& objects, std::shared_ptr<const motion::Motion> motion);

}  // namespace rg
