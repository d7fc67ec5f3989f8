// SPDX-License-Identifier: MIT
#pragma once
// Passes as one writes them by hand for one's own engine: plain GLSL and Vulkan, without the library's kernels, their
// blocks or their regions.

#include "hand_written.hpp"

namespace darkroom::bench {

enum class PlainPass : std::uint8_t {
    Copy,  ///< what the calibration pass does
    Tail,  ///< what the tail does, for a picture that is finite: without guards against NaN
};

/// A row that runs it from the scene to the target. `tile` is that of the noise, 64x64 of R32G32B32A32_SFLOAT.
[[nodiscard]] Result<Row> plain_row(Bed& bed, std::string name, PlainPass pass, gpu::Stage stage,
                                    const TailValues& values, const TableDesc& tile);

}  // namespace darkroom::bench
