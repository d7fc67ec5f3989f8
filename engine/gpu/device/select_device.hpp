// SPDX-License-Identifier: MIT
#pragma once
// Which of a machine's devices the user means.

#include <cstddef>
#include <darkroom/device.hpp>
#include <darkroom/result.hpp>
#include <span>
#include <string>

namespace darkroom::gpu {

/// What is told where there is none: `why` stands behind it.
[[nodiscard]] Failure no_device(const std::string& why = {});
/// The place of the device in `infos`, which are best first. A number that is a device's index means that device;
/// anything else, other numbers too ("4090"), is part of a name. Empty: the first. It may be one that is not usable.
[[nodiscard]] Result<std::size_t> select_device(std::span<const DeviceInfo> infos, const std::string& select);

}  // namespace darkroom::gpu
