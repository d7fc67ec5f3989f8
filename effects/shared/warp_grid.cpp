// SPDX-License-Identifier: MIT
#include "shared/warp_grid.hpp"

namespace darkroom {

PassImage warp_grid(PassBuilder& builder, std::uint32_t columns, std::uint32_t rows, KernelPassDesc pass) {
    pass.output =
        builder.create({.name = pass.name, .format = VK_FORMAT_R16G16B16A16_SFLOAT, .extent = {columns + 1, rows + 1}});
    return builder.add(pass);
}

}  // namespace darkroom
