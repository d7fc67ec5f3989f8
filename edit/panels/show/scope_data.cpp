// SPDX-License-Identifier: MIT
#include "panels/show/scope_data.hpp"
#include "core/srgb.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace darkroom::panels {

namespace {

float luma(const std::array<float, 3>& rgb) { return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]; }

/// Encoded; nothing where a number is broken.
std::optional<std::array<float, 3>> color_at(const ScopePicture& picture, std::size_t pixel) {
    std::array<float, 3> color{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t place = pixel * 4 + i;
        color[i] = picture.bytes.empty() ? picture.floats[place] : static_cast<float>(picture.bytes[place]) / 255;
        if (!std::isfinite(color[i])) return std::nullopt;
        if (picture.is_linear)
            color[i] = static_cast<float>(srgb_encode(double{color[i]}));  // in float, white were not 1
    }
    return color;
}

/// The step of `count` that the value is nearest to, of which the first is 0 and the last 1.
std::size_t nearest(float value, std::size_t count) {
    return static_cast<std::size_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * static_cast<float>(count - 1)));
}

void count(Vectorscope& scope, const std::array<float, 3>& rgb) {
    const auto [cb, cr] = color_difference(rgb);
    std::uint32_t& cell =
        scope.counts[nearest(0.5f - cr, Vectorscope::size) * Vectorscope::size + nearest(cb + 0.5f, Vectorscope::size)];
    scope.most = std::max(scope.most, ++cell);
}

}  // namespace

std::array<float, 2> color_difference(const std::array<float, 3>& rgb) {
    const float y = luma(rgb);
    return {(rgb[2] - y) / 1.8556f, (rgb[0] - y) / 1.5748f};
}

ScopeData measure(const ScopePicture& picture) {
    ScopeData data;
    for (std::vector<std::uint32_t>& counts : data.waveform.counts) counts.resize(Waveform::columns * Waveform::levels);
    data.vectorscope.counts.resize(Vectorscope::size * Vectorscope::size);
    const std::size_t held = std::max(picture.bytes.size(), picture.floats.size()) / 4;
    const std::size_t pixels = std::min(std::size_t{picture.width} * picture.height, held);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const std::optional<std::array<float, 3>> rgb = color_at(picture, pixel);
        ++(rgb ? data.pixels : data.broken);
        if (!rgb) continue;
        const std::size_t column = pixel % picture.width * Waveform::columns / picture.width;
        const std::array<float, scope_channels> values{(*rgb)[0], (*rgb)[1], (*rgb)[2], luma(*rgb)};
        for (std::size_t i = 0; i < scope_channels; ++i) {
            ++data.histogram.counts[i][nearest(values[i], Histogram::bins)];
            data.histogram.black[i] += values[i] <= 0 ? 1U : 0U;
            data.histogram.white[i] += values[i] >= 1 ? 1U : 0U;
            std::uint32_t& cell =
                data.waveform.counts[i][nearest(values[i], Waveform::levels) * Waveform::columns + column];
            data.waveform.most = std::max(data.waveform.most, ++cell);
        }
        count(data.vectorscope, *rgb);
    }
    return data;
}

}  // namespace darkroom::panels
