// SPDX-License-Identifier: MIT
#pragma once
// The CPU reference: every effect in double precision, written from the published equation. Tests compare the GPU with
// it, and `--reference` develops with it alone. It is for truth, not for speed.

#include <array>
#include <cstdint>
#include <darkroom/color_state.hpp>
#include <darkroom/frame.hpp>
#include <darkroom/resource.hpp>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace darkroom {

struct Rgba {
    double r = 0, g = 0, b = 0, a = 1;
};

/// Row-major, top row first.
struct ReferenceImage {
    std::uint32_t width = 0, height = 0;
    std::vector<Rgba> pixels;

    ReferenceImage() = default;
    ReferenceImage(std::uint32_t w, std::uint32_t h, Rgba fill = {})
        : width(w), height(h), pixels(std::size_t{w} * h, fill) {}
    [[nodiscard]] Rgba& at(std::uint32_t x, std::uint32_t y) { return pixels[std::size_t{y} * width + x]; }
    [[nodiscard]] const Rgba& at(std::uint32_t x, std::uint32_t y) const { return pixels[std::size_t{y} * width + x]; }
    /// The nearest pixel inside.
    [[nodiscard]] const Rgba& clamped(std::int64_t x, std::int64_t y) const {
        const auto inside = [](std::int64_t v, std::uint32_t n) {
            return static_cast<std::uint32_t>(v < 0 ? 0 : v >= n ? std::int64_t{n} - 1 : v);
        };
        return at(inside(x, width), inside(y, height));
    }
};

/// A light with its shadow maps on the CPU, as darkroom::Light has them on the device.
struct ReferenceLight {
    Light light;
    std::uint32_t resolution = 0;  ///< of the square cascades
    /// One list a cascade, row-major, top row first: depth 0 near the light .. 1. Empty: casts no shadow.
    std::vector<std::vector<float>> cascades;
};

/// What the reference of an effect keeps from frame to frame: images under names of its own. Empty where the histories
/// of the GPU would be zero (docs/conventions.md, "Histories").
using ReferenceHistory = std::map<std::string, ReferenceImage, std::less<>>;

/// What a reference reads beside its parameters. Images that are not there are null.
struct ReferenceInput {
    const ReferenceImage* picture = nullptr;
    const ReferenceImage* source = nullptr;  ///< never null: the picture where the entry names none
    const ReferenceImage* second = nullptr;
    const ReferenceImage* depth = nullptr;  ///< red: planar distance
    const ReferenceImage* normals = nullptr;
    const ReferenceImage* velocity = nullptr;
    const ReferenceImage* reactive = nullptr;
    const ReferenceImage* transparency = nullptr;
    const ReferenceImage* exposure = nullptr;
    std::span<const ReferenceLight> lights;
    const Resources* resources = nullptr;
    ColorState color;  ///< what the picture's numbers are
    Camera camera;
    double time = 0;
    double delta_time = 0;
    std::uint64_t frame_index = 0;
    std::uint32_t output_width = 0, output_height = 0;  ///< what the frame is finished at
    ReferenceHistory* history = nullptr;  ///< of this entry, to be read and written; null: a frame by itself
};

using ReferenceFunction = ReferenceImage (*)(const void* parameters, const ReferenceInput&);

/// Where a picture is read: uv, and how strongly a barrel bends it behind that, for red, green (and alpha) and blue.
/// Barrels of a reading add up. See effects/shared/place.glsl.
struct ReferencePlace {
    double u = 0, v = 0;
    std::array<double, 3> barrel{0, 0, 0};
    std::uint32_t height = 1;  ///< of the picture that is made
};
/// A picture, bilinearly.
using ReferenceSampler = std::function<Rgba(double u, double v)>;
using ReferenceMapFunction = ReferencePlace (*)(const void* parameters, ReferencePlace);
using ReferenceTapFunction = Rgba (*)(const void* parameters, Rgba color, const ReferencePlace&,
                                      const ReferenceSampler& read);

/// The reference of an effect, from the function that makes its picture; what reads by places is made of a map or a tap
/// (effects/shared/reading_reference.hpp), which then join those of their neighbours.
struct Reference {
    ReferenceFunction picture = nullptr;
    ReferenceMapFunction map = nullptr;
    ReferenceTapFunction tap = nullptr;

    constexpr Reference() = default;
    constexpr Reference(ReferenceFunction function) : picture(function) {}
    constexpr Reference(ReferenceFunction function, ReferenceMapFunction own) : picture(function), map(own) {}
    constexpr Reference(ReferenceFunction function, ReferenceTapFunction own) : picture(function), tap(own) {}

    [[nodiscard]] explicit operator bool() const { return picture != nullptr; }
    [[nodiscard]] ReferenceImage operator()(const void* parameters, const ReferenceInput& input) const {
        return picture(parameters, input);
    }
    [[nodiscard]] bool is_reading() const { return map != nullptr || tap != nullptr; }
};

/// Centre of a pixel as uv in (0,1), and its coordinates: what pointwise references are given.
struct ReferencePixel {
    std::uint32_t x = 0, y = 0;
    double u = 0, v = 0;
};

/// Lifts `Rgba f(Rgba color, const ReferencePixel&, const Parameters&)` to a ReferenceFunction.
template <class Parameters, Rgba (*function)(Rgba, const ReferencePixel&, const Parameters&)>
ReferenceImage pointwise_reference(const void* parameters, const ReferenceInput& input) {
    ReferenceImage out = *input.picture;
    const Parameters& values = *static_cast<const Parameters*>(parameters);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            out.at(x, y) = function(out.at(x, y), {x, y, (x + 0.5) / out.width, (y + 0.5) / out.height}, values);
    return out;
}

}  // namespace darkroom
