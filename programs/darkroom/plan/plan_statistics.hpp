// SPDX-License-Identifier: MIT
#pragma once
// `plan --statistics`: what a driver's compiler made of a plan's kernels, and what that costs on a chip.

#include <darkroom/device.hpp>
#include <darkroom/kernel_statistics.hpp>
#include <darkroom/plan.hpp>
#include <string>
#include <vector>

#include "develop/cost/kernel_cost.hpp"

namespace app {

/// The chip of this name, or, for an empty one, the first of the device's family; null: none is listed. Errors: a name
/// that is not listed, or of another family than the device compiles for.
[[nodiscard]] darkroom::Result<const darkroom::Chip*> chip_named(const std::string& name,
                                                                 const darkroom::DeviceInfo& device);

/// How often the loops of a kernel run, as a user says who knows better than its machine code.
struct GivenLoops {
    std::string kernel;
    std::vector<double> trips;
};
/// "volumetric.march=1,32,0"
[[nodiscard]] darkroom::Result<GivenLoops> parse_loops(const std::string& text);

struct StatisticsReport {
    const darkroom::DeviceInfo& device;
    const darkroom::Plan& plan;
    std::span<const darkroom::KernelStatistics> kernels;  ///< one for each pass of the plan
    const darkroom::Chip* chip = nullptr;
    std::span<const GivenLoops> loops;
};
/// Errors: loops of a kernel that the plan does not have, or of more than the kernel has.
[[nodiscard]] darkroom::Result<std::string> text_of(const StatisticsReport& report);
[[nodiscard]] darkroom::Result<std::string> json_of(const StatisticsReport& report);

}  // namespace app
