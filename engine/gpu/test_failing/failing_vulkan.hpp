// SPDX-License-Identifier: MIT
#pragma once
// For tests only: Vulkan functions in place of the driver's, one call of which fails with an error that the
// specification allows there. They count the calls that may fail, and know every object that was made and not
// destroyed.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom::gpu::test::failing {

/// Over the functions that `real` finds.
[[nodiscard]] PFN_vkGetInstanceProcAddr vulkan_over(PFN_vkGetInstanceProcAddr real);

/// A call that may fail.
struct Call {
    std::string_view name;
    std::size_t errors = 0;  ///< how many it may fail with
};

/// Counts from now on. Of the calls that may fail, call `number` does, with the error `error` of those that it may
/// have.
void arm(std::uint64_t number, std::size_t error);
inline constexpr std::uint64_t never = ~std::uint64_t{0};
/// No call fails, and none is counted.
void disarm();
/// Since arm().
[[nodiscard]] std::vector<Call> calls();

struct Failed {
    std::string_view name;  ///< empty: none has failed
    VkResult result = VK_SUCCESS;
};
[[nodiscard]] Failed failed();

/// What was made and not destroyed, as names of the functions that make it.
[[nodiscard]] std::vector<std::string> alive();
/// Of the device's memory that is allocated and not freed.
[[nodiscard]] std::uint64_t memory_bytes();
/// What was destroyed that nobody had made, since the last call.
[[nodiscard]] std::vector<std::string> take_wrongs();

}  // namespace darkroom::gpu::test::failing
