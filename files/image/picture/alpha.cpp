// SPDX-License-Identifier: MIT
#include "image/picture/alpha.hpp"

#include <algorithm>

namespace darkroom {

void associate(Picture& picture) {
    std::vector<float>& rgba = picture.pixels;
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) rgba[i] *= rgba[i | 3];
}

void make_straight(std::span<float> rgba) {
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) rgba[i] = rgba[i | 3] > 0 ? rgba[i] / rgba[i | 3] : 0;
}

void make_alpha_of_glow(std::span<float> rgba) {
    for (std::size_t i = 0; i + 3 < rgba.size(); i += 4)
        rgba[i + 3] = std::max(rgba[i + 3], std::min(1.0F, std::max({rgba[i], rgba[i + 1], rgba[i + 2]})));
    make_straight(rgba);
}

}  // namespace darkroom
