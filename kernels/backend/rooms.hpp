// SPDX-License-Identifier: LGPL-2.1-or-later
// The operations of core's rooms on a device, each made in the file of its name.
#pragma once

#include "core/background/methods/difference_operations.hpp"
#include "core/background/methods/paper_operations.hpp"
#include "core/background/operations.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/operations_source.hpp"
#include "core/graph/operations.hpp"
#include "core/motion/operations.hpp"
#include "core/objects/operations.hpp"
#include "core/segmentation/operations.hpp"

#include <memory>

namespace rg::gpu {

class GpuDevice;

template <class Operations>
[[nodiscard]] std::unique_ptr<Operations> operationsOn(GpuDevice& device, const Executor& executor);

template <>
std::unique_ptr<rg::background::Operations> operationsOn(GpuDevice& device,
                                                         const Executor& executor);
template <>
std::unique_ptr<rg::background::PaperOperations> operationsOn(GpuDevice& device,
                                                              const Executor& executor);
template <>
std::unique_ptr<rg::background::DifferenceOperations> operationsOn(GpuDevice& device,
                                                                   const Executor& executor);
template <>
std::unique_ptr<rg::segmentation::Operations> operationsOn(GpuDevice& device,
                                                           const Executor& executor);
// All that the other rooms' read is on the host, too: even a lost device costs nothing.
template <>
std::unique_ptr<rg::graph::Operations> operationsOn(GpuDevice& device, const Executor& executor);
template <>
std::unique_ptr<rg::motion::Operations> operationsOn(GpuDevice& device, const Executor& executor);
template <>
std::unique_ptr<rg::objects::Operations> operationsOn(GpuDevice& device, const Executor& executor);

/// A base of GpuDevice for each room.
template <class Operations>
class RoomSource : public OperationsSource<Operations> {
 public:
  void make(const Executor& executor, std::unique_ptr<Operations>& operations) final;
};

/// All of them.
template <class... Operations>
class RoomSources : public RoomSource<Operations>... {};

using AllRooms =
    RoomSources<rg::background::Operations, rg::background::PaperOperations,
                rg::background::DifferenceOperations, rg::segmentation::Operations,
                rg::graph::Operations, rg::motion::Operations, rg::objects::Operations>;

}  // namespace rg::gpu
