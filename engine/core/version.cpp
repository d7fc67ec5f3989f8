// SPDX-License-Identifier: MIT
#include <darkroom/version.hpp>

namespace darkroom {

std::uint32_t library_version() noexcept { return version; }

}  // namespace darkroom
