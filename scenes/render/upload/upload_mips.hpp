// SPDX-License-Identifier: MIT
#pragma once
// Mip levels of pictures, each a box-filtered half of the one before, in linear light where the picture is
// sRGB-encoded. On the CPU, so that every device shows the same textures.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/model.hpp"

namespace darkroom::render {

struct MipLevel {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

/// Levels 1, 2, ... down to 1x1 of level 0 in `rgba`, four bytes a pixel; alpha is linear always. Odd sizes are
/// filtered by three taps (Guthe and Heckbert, "Non-Power-of-Two Mipmapping", 2005). With a cutoff, alpha of each level
/// is scaled so that as large a share of its pixels reaches the cutoff as of level 0, else what is masked thins out far
/// away (Ignacio Castano, "Computing Alpha Mipmaps", 2010).
[[nodiscard]] std::vector<MipLevel> mip_levels(std::uint32_t width, std::uint32_t height,
                                               std::span<const std::uint8_t> rgba, bool is_srgb,
                                               std::optional<float> alpha_cutoff = {});

/// A level whose samples are codes of 16 bits or halves.
struct WideMipLevel {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint16_t> rgba;
};

/// All levels of a picture of 16 bits or of halves, level 0 included, as linear numbers: codes if `as_codes`, which
/// only linear codes can be, else halves, into which sRGB codes are decoded (as there is no sRGB format of 16 bits).
[[nodiscard]] std::vector<WideMipLevel> wide_mip_levels(const scene::Image& image, bool is_srgb, bool as_codes,
                                                        std::optional<float> alpha_cutoff = {});

}  // namespace darkroom::render
