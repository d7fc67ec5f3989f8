// SPDX-License-Identifier: MIT
#include "shared/blue_noise.hpp"

namespace darkroom {

const std::array<std::uint16_t, std::size_t{blue_noise_size} * blue_noise_size>& blue_noise_ranks() {
    static constexpr std::array<std::uint16_t, std::size_t{blue_noise_size} * blue_noise_size> ranks{
#include "shared/blue_noise.inc"
    };
    return ranks;
}

}  // namespace darkroom
