// SPDX-License-Identifier: MIT
#include <cmath>
#include <darkroom/warp_grid.hpp>

namespace darkroom {

VkExtent2D warp_grid_cells(Vec2 grid) {
    return {static_cast<std::uint32_t>(std::lround(grid.x)), static_cast<std::uint32_t>(std::lround(grid.y))};
}

PassImage warp_grid(PassBuilder& builder, Vec2 grid, KernelPassDesc pass) {
    const VkExtent2D cells = warp_grid_cells(grid);
    pass.output = builder.create(
        {.name = pass.name, .format = VK_FORMAT_R16G16B16A16_SFLOAT, .extent = {cells.width + 1, cells.height + 1}});
    return builder.add(pass);
}

}  // namespace darkroom
