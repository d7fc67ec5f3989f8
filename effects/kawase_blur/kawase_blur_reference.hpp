// SPDX-License-Identifier: MIT
#pragma once
// Both of Kawase's filters in double precision, tap by tap: Masaki Kawase, "Frame buffer postprocessing effects in
// DOUBLE-S.T.E.A.L" (2003); Marius Bjorge, "Bandwidth-efficient rendering" (2015). The edge is repeated.

#include <algorithm>
#include <darkroom/effects/kawase_blur.hpp>
#include <darkroom/reference.hpp>
#include <vector>

#include "shared/halve_reference.hpp"
#include "shared/sample_reference.hpp"

namespace darkroom {

struct KawaseBlurReferenceTap {
    double x, y;  ///< in texels of the image that is read
    double weight;
};

inline ReferenceImage kawase_blur_reference_pass(const ReferenceImage& image, std::uint32_t width, std::uint32_t height,
                                                 const std::vector<KawaseBlurReferenceTap>& taps) {
    const auto limited = [](double value) { return std::clamp(value, -65504.0, 65504.0); };
    ReferenceImage out(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            Rgba sum{0, 0, 0, 1};
            for (const KawaseBlurReferenceTap& tap : taps)
                sum = weighed_sum_reference(sum,
                                            sample_reference(image, (x + 0.5) / width + tap.x / image.width,
                                                             (y + 0.5) / height + tap.y / image.height),
                                            tap.weight);
            out.at(x, y) = {limited(sum.r), limited(sum.g), limited(sum.b), 1};
        }
    return out;
}

inline std::vector<KawaseBlurReferenceTap> kawase_blur_reference_corners(double x, double y, double weight) {
    return {{-x, -y, weight}, {x, -y, weight}, {-x, y, weight}, {x, y, weight}};
}

inline ReferenceImage kawase_blur_reference_dual(ReferenceImage image, const KawaseBlur& blur) {
    const std::uint32_t width = image.width, height = image.height;
    const auto count = static_cast<std::uint32_t>(blur.iterations);
    const double offset = double{blur.offset};
    const auto side = [](std::uint32_t whole, std::uint32_t level) { return std::max(whole >> level, 1u); };
    for (std::uint32_t i = 1; i <= count; ++i) {
        const std::uint32_t w = side(width, i), h = side(height, i);
        // The corners of the output's pixel, which on odd sides is wider than two texels.
        auto taps =
            kawase_blur_reference_corners(0.5 * offset * image.width / w, 0.5 * offset * image.height / h, 0.125);
        taps.push_back({0, 0, 0.5});
        image = kawase_blur_reference_pass(image, w, h, taps);
    }
    auto taps = kawase_blur_reference_corners(0.5 * offset, 0.5 * offset, 1.0 / 6);
    for (const double reach : {-offset, offset}) {
        taps.push_back({reach, 0, 1.0 / 12});
        taps.push_back({0, reach, 1.0 / 12});
    }
    for (std::uint32_t i = count; i-- > 0;)
        image = kawase_blur_reference_pass(image, side(width, i), side(height, i), taps);
    return image;
}

inline ReferenceImage kawase_blur_reference(const void* parameters, const ReferenceInput& input) {
    const auto& blur = *static_cast<const KawaseBlur*>(parameters);
    ReferenceImage image = *input.picture;
    for (Rgba& color : image.pixels) color = clean_reference(color);
    const ReferenceImage picture = image;
    if (blur.mode == KawaseBlurMode::Dual) {
        image = kawase_blur_reference_dual(image, blur);
    } else {
        for (std::int32_t i = 0; i < blur.iterations; ++i) {
            const double reach = (i + 0.5) * double{blur.offset};
            image = kawase_blur_reference_pass(image, image.width, image.height,
                                               kawase_blur_reference_corners(reach, reach, 0.25));
        }
    }
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i].a = std::clamp(picture.pixels[i].a, -65504.0, 65504.0);
    return image;
}

}  // namespace darkroom
