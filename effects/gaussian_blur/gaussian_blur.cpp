// SPDX-License-Identifier: MIT
#include <cmath>
#include <darkroom/effects/gaussian_blur.hpp>

#include "gaussian_blur/gaussian_blur_reference.hpp"

namespace darkroom {

namespace {

constexpr std::uint32_t vectors = 1 + GaussianBlurTaps::capacity / 2;

const GaussianBlur& blur_of(const void* parameters) { return *static_cast<const GaussianBlur*>(parameters); }

void line_constants(const GaussianBlur& blur, float step_x, float step_y, std::span<PassVector> out) {
    const GaussianBlurTaps taps = gaussian_blur_taps(blur);
    out[0] = {taps.centre_weight, static_cast<float>((taps.count + 1) / 2), step_x, step_y};
    // Of an odd number of taps the last vector's second one has weight 0.
    for (std::size_t i = 0; i < taps.count; i += 2)
        out[1 + i / 2] = {taps.offsets[i], taps.weights[i], taps.offsets[i + 1], taps.weights[i + 1]};
}
void horizontal_constants(const void* parameters, const PassContext&, std::span<PassVector> out) {
    line_constants(blur_of(parameters), 1.0f, 0.0f, out);
}
void vertical_constants(const void* parameters, const PassContext&, std::span<PassVector> out) {
    line_constants(blur_of(parameters), 0.0f, 1.0f, out);
}

void build(PassBuilder& builder) {
    const auto line = [&](const char* direction, PassImage from, ConstantsFunction constants) {
        const std::string name = std::string("gaussian_blur ") + direction;
        return builder.add({.name = name,
                            .shader = "gaussian_blur_line.glsl",
                            .inputs = {{.name = "gaussian_blur_input", .image = from}},
                            .output = builder.create({.name = name}),
                            .custom_vectors = vectors,
                            .constants = constants});
    };
    const PassImage half_done = line("horizontal", builder.picture(), horizontal_constants);
    builder.result(line("vertical", half_done, vertical_constants));
}

bool is_identity(const void* parameters) { return blur_of(parameters).radius == 0; }

}  // namespace

GaussianBlurTaps gaussian_blur_taps(const GaussianBlur& blur) {
    GaussianBlurTaps taps;
    if (blur.radius <= 0) return taps;
    const double sigma = blur.sigma > 0.0f ? static_cast<double>(blur.sigma) : blur.radius / 3.0;
    const auto bell = [&](int i) { return i > blur.radius ? 0.0 : std::exp(-0.5 * i * i / (sigma * sigma)); };
    double sum = 1.0;
    for (int i = 1; i <= blur.radius; ++i) sum += 2.0 * bell(i);
    // A bilinear tap between pixels i and i + 1 reads both in the ratio of their weights (Daniel Rakos, "Efficient
    // Gaussian blur with linear sampling", 2010). Far out both may be 0 in float: the tap then lies on pixel i.
    for (int i = 1; i <= blur.radius; i += 2, ++taps.count) {
        const double pair = bell(i) + bell(i + 1);
        taps.offsets[taps.count] = static_cast<float>(i + (pair > 0.0 ? bell(i + 1) / pair : 0.0));
        taps.weights[taps.count] = static_cast<float>(pair / sum);
    }
    taps.centre_weight = static_cast<float>(1.0 / sum);
    return taps;
}

const EffectInfo& effect_info(const GaussianBlur&) {
    static const EffectInfo info{
        .name = "gaussian_blur",
        .doc = "Blurs the picture evenly.",
        .parameters = gaussian_blur_rows.table(),
        .files = embedded_files("gaussian_blur"),
        .touch = Touch::Neighbourhood,
        .accepts = Domains::all(),
        .build = build,
        .reference = gaussian_blur_reference,
        .is_identity = is_identity,
    };
    return info;
}

}  // namespace darkroom
