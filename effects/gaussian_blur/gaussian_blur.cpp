// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/gaussian_blur.hpp>
#include <string>

#include "gaussian_blur/gaussian_blur_reference.hpp"

namespace darkroom {

namespace {

constexpr auto gaussian_blur_rows = describe(
    field<&GaussianBlur::radius>("Half-width of the blur; 0 leaves the picture as it is.", {0, 64}, unit::pixels)
        .at_compile()
        .as_size_of<&GaussianBlur::reach>()
        .as_loop_count(),
    field<&GaussianBlur::sigma>("Standard deviation of the bell curve; 0 takes a third of the radius.", {0, 64},
                                unit::pixels)
        .at_compile()
        .as_size_of<&GaussianBlur::reach>(),
    field<&GaussianBlur::resolution>(
        "Size at which a wide blur works: automatic takes a smaller picture where no detail is lost, full never does.")
        .at_compile(),
    field<&GaussianBlur::reach>(
        "Pixels that radius and sigma are measured in: those of the picture, or of a picture of 1080 lines.")
        .at_compile());

constexpr std::uint32_t vectors = 1 + GaussianBlurTaps::capacity / 2;

/// In texels of the smallest picture that is blurred. A wider curve hides the grid of those texels better and costs
/// more; with this one a unit step is off by less than a code of 8 bits.
constexpr double least_sigma = 1.3;
/// A curve that is cut off sooner, in standard deviations, has an edge that a smaller picture would soften.
constexpr double least_cut_off = 2.9;

const GaussianBlur& blur_of(const void* parameters) { return *static_cast<const GaussianBlur*>(parameters); }

double sigma_of(const GaussianBlur& blur) {
    return blur.sigma > 0.0f ? static_cast<double>(blur.sigma) : blur.radius / 3.0;
}

/// exp(-i^2 / (2 sigma^2)) for i from -radius to radius.
struct Bell {
    double sigma;
    std::int32_t radius;

    [[nodiscard]] double at(std::int32_t i) const {
        return i > radius ? 0.0 : std::exp(-0.5 * i * i / (sigma * sigma));
    }
    [[nodiscard]] double sum() const {
        double sum = 1.0;
        for (std::int32_t i = 1; i <= radius; ++i) sum += 2.0 * at(i);
        return sum;
    }
    [[nodiscard]] double variance() const {
        double sum = 1.0, moment = 0.0;
        for (std::int32_t i = 1; i <= radius; ++i) {
            const double both = 2.0 * at(i);
            sum += both;
            moment += both * i * i;
        }
        return moment / sum;
    }
};

/// The curve of this radius that has this variance, or comes nearest to it.
Bell bell_of_variance(double variance, std::int32_t radius) {
    double low = 0.1, high = 4.0 * radius;
    for (int i = 0; i < 24; ++i) {
        const double middle = 0.5 * (low + high);
        (Bell{middle, radius}.variance() < variance ? low : high) = middle;
    }
    return {low, radius};
}

template <bool is_horizontal>
void line_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const VkExtent2D whole = context.frame_extent, own = context.output_extent;
    const double scale = is_horizontal ? double{1} * whole.width / own.width : double{1} * whole.height / own.height;
    const GaussianBlurTaps taps = gaussian_blur_taps(gaussian_blur_in_pixels(blur_of(parameters), whole.height), scale);
    out[0] = {taps.centre_weight, static_cast<float>((taps.count + 1) / 2), is_horizontal ? 1.0f : 0.0f,
              is_horizontal ? 0.0f : 1.0f};
    // Of an odd number of pairs the last vector's second one has weight 0.
    for (std::size_t i = 0; i < taps.count; i += 2)
        out[1 + i / 2] = {taps.fractions[i], taps.weights[i], taps.fractions[i + 1], taps.weights[i + 1]};
}

PassImage add_lines(PassBuilder& builder, PassImage picture, std::uint32_t level) {
    const auto line = [&](const char* direction, const char* shader, PassImage from, ConstantsFunction constants) {
        const std::string name = std::string("gaussian_blur ") + direction;
        return builder.add({.name = name,
                            .shader = level == 0 ? shader : "gaussian_blur.glsl#small",
                            .inputs = {{.name = "gaussian_blur_input", .image = from}},
                            .output = builder.create({.name = name, .denominator = 1u << level}),
                            .custom_vectors = vectors,
                            .constants = constants});
    };
    const PassImage half_done = line("horizontal", "gaussian_blur.glsl#across", picture, line_constants<true>);
    return line("vertical", "gaussian_blur.glsl#down", half_done, line_constants<false>);
}

void build(PassBuilder& builder) {
    const PassImage picture = builder.picture();
    const GaussianBlur& blur = blur_of(builder.parameters());
    const std::uint32_t height =
        blur.reach == Reach::Height ? builder.from_max_extent([](VkExtent2D extent) { return extent.height; }) : 0;
    const std::uint32_t level = gaussian_blur_level(gaussian_blur_in_pixels(blur, height));
    PassImage image = picture;
    for (std::uint32_t i = 1; i <= level; ++i) {
        const std::string name = "halve " + std::to_string(i);
        image = builder.add({.name = name,
                             .shader = "shared/halve.glsl",
                             .inputs = {{.name = "halve_input", .image = image}},
                             .output = builder.create({.name = name, .denominator = 1u << i})});
    }
    image = add_lines(builder, image, level);
    for (std::uint32_t i = level; i-- > 1;) {
        const std::string name = "double " + std::to_string(i);
        image = builder.add({.name = name,
                             .shader = "shared/double.glsl",
                             .inputs = {{.name = "double_input", .image = image}},
                             .output = builder.create({.name = name, .denominator = 1u << i})});
    }
    if (level > 0)
        image = builder.add({.name = "gaussian_blur result",
                             .shader = "gaussian_blur.glsl#result",
                             .inputs = {{.name = "gaussian_blur_small", .image = image},
                                        {.name = "gaussian_blur_picture", .image = picture}},
                             .output = builder.create({.name = "gaussian_blur result"})});
    builder.result(image);
}

bool is_identity(const void* parameters) { return blur_of(parameters).radius == 0; }

}  // namespace

GaussianBlur gaussian_blur_in_pixels(const GaussianBlur& blur, std::uint32_t height) {
    if (blur.reach == Reach::Pixels) return blur;
    GaussianBlur out = blur;
    out.reach = Reach::Pixels;
    out.radius = static_cast<std::int32_t>(std::ceil(pixels_of(Reach::Height, blur.radius, height)));
    out.sigma = static_cast<float>(pixels_of(Reach::Height, sigma_of(blur), height));
    return out;
}

GaussianBlurTaps gaussian_blur_taps(const GaussianBlur& blur, double scale) {
    GaussianBlurTaps taps;
    if (blur.radius <= 0) return taps;
    Bell bell{sigma_of(blur), blur.radius};
    if (scale > 1.0) {
        // Variances add. Each halving by the tent adds 3/4 of a texel's square, each doubling by bilinear taps 3/16 of
        // one of the smaller picture; both series make (scale^2 - 1) / 4 pixels in all.
        const double variance = (bell.variance() - 0.5 * (scale * scale - 1.0)) / (scale * scale);
        if (variance <= 0.0) return taps;
        bell = bell_of_variance(variance, static_cast<std::int32_t>(std::ceil(blur.radius / scale)));
    }
    const double sum = bell.sum();
    // A bilinear tap between texels i and i + 1 reads both in the ratio of their weights (Daniel Rakos, "Efficient
    // Gaussian blur with linear sampling", 2010). Far out both may be 0 in float: the tap then lies on texel i.
    for (std::int32_t i = 1; i <= bell.radius; i += 2, ++taps.count) {
        const double pair = bell.at(i) + bell.at(i + 1);
        taps.fractions[taps.count] = static_cast<float>(pair > 0.0 ? bell.at(i + 1) / pair : 0.0);
        taps.weights[taps.count] = static_cast<float>(pair / sum);
    }
    taps.centre_weight = static_cast<float>(1.0 / sum);
    return taps;
}

std::uint32_t gaussian_blur_level(const GaussianBlur& blur) {
    const double sigma = sigma_of(blur);
    std::uint32_t level = 0;
    while (blur.radius > static_cast<std::int32_t>(2 * GaussianBlurTaps::capacity) << level) ++level;
    if (blur.resolution == GaussianBlurResolution::Full || blur.radius < least_cut_off * sigma) return level;
    while (sigma >= least_sigma * (2u << level)) ++level;
    return level;
}

double gaussian_blur_fetches(const GaussianBlur& blur) {
    const std::uint32_t level = gaussian_blur_level(blur);
    double share = 1.0, fetches = 0.0;
    for (std::uint32_t i = 1; i <= level; ++i) {
        fetches += share;  // the doubling
        share *= 0.25;
        fetches += 4.0 * share;
    }
    fetches += 2.0 * share * (1.0 + 2.0 * static_cast<double>(gaussian_blur_taps(blur, 1u << level).count));
    return level == 0 ? fetches : fetches + 1.0;  // the pixel's own alpha
}

const EffectInfo& effect_info(const GaussianBlur&) {
    static const EffectInfo info{
        .name = "gaussian_blur",
        .doc = "Blurs the picture evenly.",
        .parameters = gaussian_blur_rows.table(),
        .files = embedded_files("gaussian_blur"),
        .touch = Touch::Neighbourhood,
        .accepts = Domains::all(),
        .flat = {.documented = 79, .scene_linear = 87},
        .build = build,
        .reference = gaussian_blur_reference,
        .is_identity = is_identity,
    };
    return info;
}

}  // namespace darkroom
