// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/backend/open_device.hpp"

namespace rg::gpu {

Result<std::shared_ptr<Device>> openDevice(int, const std::shared_ptr<Device>&) {
  return Error{
      "this build has no CUDA: install the CUDA toolkit (nvcc) and build with -Dcuda=enabled"};
}

}  // namespace rg::gpu
