// SPDX-License-Identifier: MIT
#include "image/compare/flip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "core/srgb.hpp"
#include "core/thread/parallel.hpp"

namespace darkroom {
namespace {

constexpr double pi = std::numbers::pi;

/// One dimension of a separable filter, symmetric or antisymmetric: the tap at -k weighs mirror * half[k].
struct Kernel {
    std::vector<float> half;
    float mirror = 1.0f;

    [[nodiscard]] int radius() const { return static_cast<int>(half.size()) - 1; }
};

/// out[i] = sum over k of the weight of tap k times centre[i + k * stride]. Blocks of 16 keep the sums in registers.
void convolve(float* out, const float* centre, std::ptrdiff_t stride, const Kernel& kernel, std::size_t count) {
    constexpr std::size_t block = 16;
    const float mirror = kernel.mirror;
    const auto taps = static_cast<std::ptrdiff_t>(kernel.half.size());
    std::size_t x = 0;
    for (; x + block <= count; x += block) {
        float sums[block];
        for (std::size_t i = 0; i < block; ++i) sums[i] = kernel.half[0] * centre[x + i];
        for (std::ptrdiff_t k = 1; k < taps; ++k) {
            const float weight = kernel.half[static_cast<std::size_t>(k)];
            const float* after = centre + x + k * stride;
            const float* before = centre + x - k * stride;
            for (std::size_t i = 0; i < block; ++i) sums[i] += weight * (after[i] + mirror * before[i]);
        }
        for (std::size_t i = 0; i < block; ++i) out[x + i] = sums[i];
    }
    for (; x < count; ++x) {
        float sum = kernel.half[0] * centre[x];
        for (std::ptrdiff_t k = 1; k < taps; ++k) {
            const auto offset = static_cast<std::ptrdiff_t>(x) + k * stride;
            const auto opposite = static_cast<std::ptrdiff_t>(x) - k * stride;
            sum += kernel.half[static_cast<std::size_t>(k)] * (centre[offset] + mirror * centre[opposite]);
        }
        out[x] = sum;
    }
}

/// The filters of the 2020 paper: contrast sensitivity (its colour pipeline) and features (its feature pipeline).
struct Filters {
    Kernel achromatic;
    Kernel red_green;
    std::array<Kernel, 2> blue_yellow;  ///< a sum of two Gaussians is two separable filters, added
    Kernel smooth;
    Kernel edge;   ///< first derivative of a Gaussian
    Kernel point;  ///< second derivative
    int radius = 0;

    explicit Filters(double pixels_per_degree);
};

/// exp(-pi^2 x^2 / b) at whole pixels, x in degrees.
Kernel gaussian(double b, int radius, double pixels_per_degree) {
    Kernel kernel;
    for (int i = 0; i <= radius; ++i) {
        const double x = i / pixels_per_degree;
        kernel.half.push_back(static_cast<float>(std::exp(-pi * pi * x * x / b)));
    }
    return kernel;
}

double total(const Kernel& kernel) {
    double sum = kernel.half[0];
    for (std::size_t k = 1; k < kernel.half.size(); ++k) sum += 2.0 * kernel.half[k];
    return sum;
}

void scale(Kernel& kernel, double factor) {
    for (float& weight : kernel.half) weight = static_cast<float>(weight * factor);
}

/// Scales positive weights to sum to 1 and negative ones to -1 over the whole, mirrored kernel.
void balance(Kernel& kernel) {
    double positive = 0.0;
    double negative = 0.0;
    for (std::size_t k = 0; k < kernel.half.size(); ++k) {
        const double after = kernel.half[k];
        const double before = k == 0 ? 0.0 : kernel.half[k] * kernel.mirror;
        positive += std::max(after, 0.0) + std::max(before, 0.0);
        negative -= std::min(after, 0.0) + std::min(before, 0.0);
    }
    // At few pixels per degree every weight may vanish: then the filter finds nothing.
    for (float& weight : kernel.half) {
        const double sum = weight < 0.0f ? negative : positive;
        weight = sum > 0.0 ? static_cast<float>(weight / sum) : 0.0f;
    }
}

Filters::Filters(double pixels_per_degree) {
    constexpr double achromatic_b = 0.0047;
    constexpr double red_green_b = 0.0053;
    constexpr std::array<double, 2> blue_yellow_a = {34.1, 13.5};
    constexpr std::array<double, 2> blue_yellow_b = {0.04, 0.025};
    // Three standard deviations of the widest Gaussian.
    const int spatial = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * pi * pi)) * pixels_per_degree));
    achromatic = gaussian(achromatic_b, spatial, pixels_per_degree);
    red_green = gaussian(red_green_b, spatial, pixels_per_degree);
    scale(achromatic, 1.0 / total(achromatic));
    scale(red_green, 1.0 / total(red_green));
    std::array<double, 2> amplitude{};
    double volume = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
        blue_yellow[i] = gaussian(blue_yellow_b[i], spatial, pixels_per_degree);
        amplitude[i] = blue_yellow_a[i] * std::sqrt(pi / blue_yellow_b[i]);
        volume += amplitude[i] * total(blue_yellow[i]) * total(blue_yellow[i]);
    }
    for (std::size_t i = 0; i < 2; ++i) scale(blue_yellow[i], std::sqrt(amplitude[i] / volume));

    constexpr double peak_to_trough_degrees = 0.082;  // of human edge detection: two standard deviations
    const double deviation = 0.5 * peak_to_trough_degrees * pixels_per_degree;
    const int feature = static_cast<int>(std::ceil(3.0 * deviation));
    edge.mirror = -1.0f;
    for (int i = 0; i <= feature; ++i) {
        const double weight = std::exp(-i * i / (2.0 * deviation * deviation));
        smooth.half.push_back(static_cast<float>(weight));
        edge.half.push_back(static_cast<float>(-i * weight));
        point.half.push_back(static_cast<float>((i * i / (deviation * deviation) - 1.0) * weight));
    }
    scale(smooth, 1.0 / total(smooth));
    balance(edge);
    balance(point);
    radius = std::max(spatial, feature);
}

struct Color {
    float x = 0.0f;
    float y = 0.0f;
    float z = 0.0f;
};

/// Linear Rec. 709 to CIE XYZ relative to the white of the matrix itself, so that (1, 1, 1) becomes (1, 1, 1).
Color relative_xyz(Color rgb) {
    constexpr Color white = {0.950428545f, 1.0f, 1.088900371f};
    return {(0.412386563f * rgb.x + 0.357591488f * rgb.y + 0.180450493f * rgb.z) / white.x,
            0.212636821f * rgb.x + 0.715182976f * rgb.y + 0.072180203f * rgb.z,
            (0.019330620f * rgb.x + 0.119197161f * rgb.y + 0.950372591f * rgb.z) / white.z};
}

Color linear_rgb(Color relative) {
    const Color xyz = {relative.x * 0.950428545f, relative.y, relative.z * 1.088900371f};
    return {3.241003275f * xyz.x - 1.537398934f * xyz.y - 0.498615861f * xyz.z,
            -0.969224334f * xyz.x + 1.875930071f * xyz.y + 0.041554224f * xyz.z,
            0.055639423f * xyz.x - 0.204011202f * xyz.y + 1.057148933f * xyz.z};
}

/// CIELAB with the Hunt adjustment of the 2020 paper: chroma counts less where it is dark.
Color hunt_lab(Color rgb) {
    const auto lightness = [](float t) {
        constexpr float delta = 6.0f / 29.0f;
        return t > delta * delta * delta ? std::pow(t, 1.0f / 3.0f) : t / (3.0f * delta * delta) + 4.0f / 29.0f;
    };
    const Color xyz = relative_xyz(rgb);
    const float fy = lightness(xyz.y);
    const float l = 116.0f * fy - 16.0f;
    return {l, 0.01f * l * 500.0f * (lightness(xyz.x) - fy), 0.01f * l * 200.0f * (fy - lightness(xyz.z))};
}

/// The HyAB distance of Abasi et al., "Distance metrics for very large color differences", 2019.
float hyab(Color a, Color b) {
    return std::abs(a.x - b.x) + std::sqrt((a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

constexpr float color_exponent = 0.7f;

/// The 2020 paper, error redistribution: the power of the distance, spread so that common errors use most of the range.
float redistribute(float distance, float largest) {
    constexpr float knee_input = 0.4f;
    constexpr float knee_output = 0.95f;
    const float error = std::pow(distance, color_exponent);
    const float knee = knee_input * largest;
    if (error < knee) return knee_output / knee * error;
    return knee_output + (error - knee) / (largest - knee) * (1.0f - knee_output);
}

/// A picture in the linear opponent space YCxCz, one plane per channel.
struct Opponent {
    std::size_t width = 0;
    std::size_t height = 0;
    std::array<std::vector<float>, 3> planes;

    Opponent(std::size_t w, std::size_t h) : width(w), height(h) {
        for (std::vector<float>& plane : planes) plane.resize(w * h);
    }
};

template <class Decode>
void convert(Opponent& out, const Picture& picture, const Decode& decode) {
    parallel_for(out.height, 0, [&](std::size_t row) {
        for (std::size_t i = row * out.width; i < (row + 1) * out.width; ++i) {
            const float* pixel = &picture.pixels[4 * i];
            const Color xyz = relative_xyz({decode(pixel[0]), decode(pixel[1]), decode(pixel[2])});
            out.planes[0][i] = 116.0f * xyz.y - 16.0f;
            out.planes[1][i] = 500.0f * (xyz.x - xyz.y);
            out.planes[2][i] = 200.0f * (xyz.y - xyz.z);
        }
    });
}

/// A band of rows of one picture, filtered along x, and rows of it filtered along y.
class Band {
  public:
    Band(const Opponent& picture, const Filters& filters, std::size_t first, std::size_t rows)
        : filters_(filters), width_(picture.width) {
        const auto radius = static_cast<std::size_t>(filters.radius);
        const std::size_t held = rows + 2 * radius;
        for (std::vector<float>& plane : planes_) plane.resize(held * width_);
        std::vector<float> padded(width_ + 2 * radius);
        const std::array<std::pair<std::size_t, const Kernel*>, 7> passes = {{{0, &filters.achromatic},
                                                                              {0, &filters.smooth},
                                                                              {0, &filters.edge},
                                                                              {0, &filters.point},
                                                                              {1, &filters.red_green},
                                                                              {2, &filters.blue_yellow[0]},
                                                                              {2, &filters.blue_yellow[1]}}};
        for (std::size_t row = 0; row < held; ++row) {
            // Beyond its border a picture continues with its border.
            const std::size_t shifted = std::max(first + row, radius) - radius;
            const std::size_t source = std::min(shifted, picture.height - 1);
            for (std::size_t pass = 0; pass < passes.size(); ++pass) {
                const auto [channel, kernel] = passes[pass];
                if (pass == 0 || channel != passes[pass - 1].first) {
                    const float* from = &picture.planes[channel][source * width_];
                    std::fill_n(padded.begin(), radius, from[0]);
                    std::copy_n(from, width_, padded.begin() + filters.radius);
                    std::fill_n(padded.end() - filters.radius, radius, from[width_ - 1]);
                }
                convolve(&planes_[pass][row * width_], &padded[radius], 1, *kernel, width_);
            }
        }
        for (std::vector<float>& row : out_) row.resize(width_);
    }

    void filter_row(std::size_t row) {
        const auto along_y = [&](std::size_t out, std::size_t plane, const Kernel& kernel) {
            const std::size_t centre = (row + static_cast<std::size_t>(filters_.radius)) * width_;
            convolve(out_[out].data(), &planes_[plane][centre], static_cast<std::ptrdiff_t>(width_), kernel, width_);
        };
        along_y(0, 0, filters_.achromatic);
        along_y(1, 4, filters_.red_green);
        along_y(2, 5, filters_.blue_yellow[0]);
        along_y(3, 6, filters_.blue_yellow[1]);
        along_y(4, 2, filters_.smooth);
        along_y(5, 1, filters_.edge);
        along_y(6, 3, filters_.smooth);
        along_y(7, 1, filters_.point);
    }

    /// What a viewer sees of the pixel, in Hunt-adjusted CIELAB.
    [[nodiscard]] Color seen(std::size_t x) const {
        const float y = (out_[0][x] + 16.0f) / 116.0f;
        const float z = y - (out_[2][x] + out_[3][x]) / 200.0f;
        const Color rgb = linear_rgb({y + out_[1][x] / 500.0f, y, z});
        return hunt_lab({std::clamp(rgb.x, 0.0f, 1.0f), std::clamp(rgb.y, 0.0f, 1.0f), std::clamp(rgb.z, 0.0f, 1.0f)});
    }
    /// Strength of the edge and of the point; the detectors' weights sum to zero, so Y's offset drops out.
    [[nodiscard]] float edge(std::size_t x) const { return length(out_[4][x], out_[5][x]); }
    [[nodiscard]] float point(std::size_t x) const { return length(out_[6][x], out_[7][x]); }

  private:
    static float length(float a, float b) { return std::sqrt(a * a + b * b) / 116.0f; }

    const Filters& filters_;
    std::size_t width_;
    std::array<std::vector<float>, 7> planes_;
    std::array<std::vector<float>, 8> out_;
};

/// Raises each error to that of this pair of pictures, if it is larger.
void raise_errors(std::vector<float>& errors, const Opponent& reference, const Opponent& test, const Filters& filters) {
    constexpr std::size_t band_rows = 48;
    const float largest = std::pow(hyab(hunt_lab({0.0f, 1.0f, 0.0f}), hunt_lab({0.0f, 0.0f, 1.0f})), color_exponent);
    parallel_for((reference.height + band_rows - 1) / band_rows, 0, [&](std::size_t index) {
        const std::size_t first = index * band_rows;
        const std::size_t rows = std::min(band_rows, reference.height - first);
        Band a(reference, filters, first, rows);
        Band b(test, filters, first, rows);
        for (std::size_t row = 0; row < rows; ++row) {
            a.filter_row(row);
            b.filter_row(row);
            float* out = &errors[(first + row) * reference.width];
            for (std::size_t x = 0; x < reference.width; ++x) {
                const float color = redistribute(hyab(a.seen(x), b.seen(x)), largest);
                const float edge = std::abs(a.edge(x) - b.edge(x));
                const float point = std::abs(a.point(x) - b.point(x));
                // The 2020 paper, final difference: one of features makes one of colour more visible.
                const float feature = std::sqrt(std::max(edge, point) * (1.0f / std::numbers::sqrt2_v<float>));
                out[x] = std::max(out[x], std::clamp(std::pow(color, 1.0f - feature), 0.0f, 1.0f));
            }
        }
    });
}

float decode_srgb(float value) {
    if (!(value > 0.0f)) return 0.0f;
    return srgb_decode(std::min(value, 1.0f));
}

/// Narkowicz, "ACES Filmic Tone Mapping Curve", 2015, with the factor 0.6 before it that the 2021 paper uses.
struct Aces {
    static constexpr double a = 0.6 * 0.6 * 2.51;
    static constexpr double b = 0.6 * 0.03;
    static constexpr double c = 0.6 * 0.6 * 2.43;
    static constexpr double d = 0.6 * 0.59;
    static constexpr double e = 0.14;

    static float map(float x) {
        if (!(x > 0.0f)) return 0.0f;
        // Beyond 1e6 the curve is flat; squares of larger numbers would overflow.
        const float v = std::min(x, 1.0e6f);
        const float mapped = (static_cast<float>(a) * v + static_cast<float>(b)) * v /
                             ((static_cast<float>(c) * v + static_cast<float>(d)) * v + static_cast<float>(e));
        return std::min(mapped, 1.0f);
    }
    /// The x that is mapped to t.
    static double inverse(double t) {
        const double p = (b - t * d) / (a - t * c);
        const double q = -t * e / (a - t * c);
        return -0.5 * p + std::sqrt(0.25 * p * p - q);
    }
};

/// The exposures of the 2021 paper: from "the brightest pixel is not clipped" to "the median is bright".
void choose_exposures(FlipErrors& out, const Picture& reference) {
    std::vector<float> luminance;
    luminance.reserve(out.errors.size());
    for (std::size_t i = 0; i < out.errors.size(); ++i) {
        const float* pixel = &reference.pixels[4 * i];
        const float y = 0.2126f * pixel[0] + 0.7152f * pixel[1] + 0.0722f * pixel[2];
        luminance.push_back(std::isfinite(y) ? std::max(y, 0.0f) : 0.0f);
    }
    const auto middle = luminance.begin() + static_cast<std::ptrdiff_t>(luminance.size() / 2);
    std::nth_element(luminance.begin(), middle, luminance.end());
    double median = *middle;
    if (luminance.size() % 2 == 0) median = 0.5 * (median + *std::max_element(luminance.begin(), middle));
    const double brightest = *std::max_element(middle, luminance.end());
    out.exposures = 1;
    if (brightest <= 0.0) return;
    // A reference that is mostly black has no median to expose for; 2^-14 of its peak stands in, 14 stops of range.
    median = std::max(median, brightest * 0x1p-14);
    constexpr double bright = 0.85;
    out.start_exposure = std::log2(Aces::inverse(bright) / brightest);
    out.stop_exposure = std::log2(Aces::inverse(bright) / median);
    out.exposures = static_cast<std::uint32_t>(std::max(2.0, std::ceil(out.stop_exposure - out.start_exposure)));
}

void summarise(FlipErrors& out) {
    std::vector<float> sorted = out.errors;
    std::sort(sorted.begin(), sorted.end());
    double sum = 0.0;
    for (const float error : sorted) sum += error;
    out.mean = sum / static_cast<double>(sorted.size());
    out.min = sorted.front();
    out.max = sorted.back();
    double running = 0.0;
    for (const float error : sorted) {
        running += error;
        if (running > 0.5 * sum) {
            out.weighted_median = error;
            return;
        }
    }
}

}  // namespace

Result<FlipErrors> flip(const Picture& reference, const Picture& test, const FlipDesc& desc) {
    if (reference.width != test.width || reference.height != test.height) {
        return user_error(fmt::format("compare: the pictures differ in size: {}x{} and {}x{}; they must be the same",
                                      reference.width, reference.height, test.width, test.height));
    }
    const std::size_t count = std::size_t{reference.width} * reference.height;
    if (count == 0) return user_error("compare: the pictures are empty (0 pixels); at least one is needed");
    if (!(desc.pixels_per_degree >= 1.0 && desc.pixels_per_degree <= 1000.0)) {
        return user_error(
            fmt::format("compare: pixels_per_degree is {}; allowed is [1, 1000]", desc.pixels_per_degree));
    }
    FlipErrors out{.width = reference.width, .height = reference.height, .errors = std::vector<float>(count)};
    const Filters filters(desc.pixels_per_degree);
    Opponent a(reference.width, reference.height);
    Opponent b(reference.width, reference.height);
    if (desc.encoding == PictureEncoding::Display) {
        convert(a, reference, decode_srgb);
        convert(b, test, decode_srgb);
        raise_errors(out.errors, a, b, filters);
    } else {
        choose_exposures(out, reference);
        const double last = std::max(1.0, static_cast<double>(out.exposures) - 1.0);
        for (std::uint32_t i = 0; i < out.exposures; ++i) {
            const double stops = out.start_exposure + i * (out.stop_exposure - out.start_exposure) / last;
            const auto exposure = static_cast<float>(std::exp2(stops));
            const auto decode = [exposure](float value) { return Aces::map(value * exposure); };
            convert(a, reference, decode);
            convert(b, test, decode);
            raise_errors(out.errors, a, b, filters);
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const auto has_nan = [i](const Picture& picture) {
            const float* pixel = &picture.pixels[4 * i];
            return std::isnan(pixel[0]) || std::isnan(pixel[1]) || std::isnan(pixel[2]);
        };
        if (has_nan(reference) != has_nan(test)) out.errors[i] = 1.0f;
    }
    summarise(out);
    return out;
}

}  // namespace darkroom
