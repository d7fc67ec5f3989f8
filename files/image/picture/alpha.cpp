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
    for (std::size_t i = 0; i + 3 < rgba.size(); i += 4) {
        const float alpha = std::clamp(rgba[i + 3], 0.0F, 1.0F), weight = alpha > 0 ? alpha : 1;
        const float made = std::max(alpha, std::min(1.0F, weight * std::max({rgba[i], rgba[i + 1], rgba[i + 2]})));
        for (std::size_t c = 0; c < 3; ++c) rgba[i + c] = made > 0 ? rgba[i + c] * (weight / made) : 0;
        rgba[i + 3] = made;
    }
}

}  // namespace darkroom
