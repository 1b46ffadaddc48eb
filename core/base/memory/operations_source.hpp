// SPDX-License-Identifier: LGPL-2.1-or-later
// Where a room's operations on pixels come from: a device that has some, or the CPU.
#pragma once

#include "core/base/stage.hpp"

#include <memory>

namespace rg {

/// A device that has a room's operations: a class that does them on the CPU, and what is derived
/// from it.
template <class Operations>
class OperationsSource {
 public:
  virtual ~OperationsSource() = default;
  /// They live shorter than the device and the executor. Throws std::bad_alloc.
  virtual void make(const Executor& executor, std::unique_ptr<Operations>& operations) = 0;
};

/// The device's, where there is one that works and has some, else the CPU's.
template <class Operations>
[[nodiscard]] std::unique_ptr<Operations> makeOperations(const Context& context) {
  auto* source = dynamic_cast<OperationsSource<Operations>*>(context.device.get());
  if (source == nullptr || !context.device->isUp())
    return std::make_unique<Operations>(*context.cpu);
  std::unique_ptr<Operations> operations;
  source->make(*context.cpu, operations);
  return operations;
}

}  // namespace rg
