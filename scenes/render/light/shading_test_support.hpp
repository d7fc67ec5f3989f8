// SPDX-License-Identifier: MIT
#pragma once
// For tests only: functions of shaders/ evaluated for many inputs at once, without drawing anything, and inputs for
// them.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/test_run.hpp"
#include "render/shader_text.hpp"
#include "scene/math.hpp"

namespace darkroom::render::test {

using glm::dvec3;
using scene::vec4;

/// A file of shaders/ for the middle of another shader: without its first lines, which only begin one.
inline std::string shader_part(std::string_view name) {
    const std::string text = shader_text(name);
    std::size_t start = 0;
    for (int line = 0; line < 2; ++line) start = text.find('\n', start) + 1;
    return text.substr(start);
}

/// What reflected() and reflected_surroundings() are made of.
inline std::string brdf_shader() {
    return shader_part("light/microfacets.glsl") + shader_part("light/layers.glsl") + shader_part("light/brdf.glsl");
}

/// What shaders take from frame.glsl, as variables that a test sets.
inline std::string frame_stand_in() {
    return "const uint Output_hdr = 0u;\nconst uint Output_display = 1u;\nstruct FrameBlock {\n" +
           shader_part("frame_block.glsl") + "};\nFrameBlock frame;\nstruct LightBlock {\n" +
           shader_part("light/light_block.glsl") + "};\nLightBlock lights;\n";
}

/// `body` is that of a kernel (gpu/kernel/kernel.hpp) whose images are input_0, input_1, ...; all inputs are equally
/// long.
inline std::vector<vec4> evaluate(const std::string& name, const std::string& body,
                                  const std::vector<std::vector<vec4>>& inputs) {
    gpu::Context& context = gpu::test::context();
    const std::size_t count = inputs.front().size();
    constexpr std::uint32_t width = 64;
    const auto height = static_cast<std::uint32_t>((count + width - 1) / width);
    gpu::KernelSpec spec{.name = name, .outputs = {VK_FORMAT_R32G32B32A32_SFLOAT}, .is_whole = true, .body = body};
    std::vector<gpu::test::Picture> pictures;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        spec.images.push_back({.name = "input_" + std::to_string(i)});
        const auto value = [&](std::uint32_t x, std::uint32_t y) {
            const vec4 v = inputs[i][std::min<std::size_t>(y * width + x, count - 1)];
            return std::array{v.x, v.y, v.z, v.w};
        };
        pictures.push_back(
            gpu::test::upload(context, gpu::test::make_pixels(width, height, value), VK_FORMAT_R32G32B32A32_SFLOAT));
    }
    gpu::test::Picture out = gpu::test::blank(context, {width, height}, VK_FORMAT_R32G32B32A32_SFLOAT);
    const auto kernel = gpu::test::must(gpu::Kernel::create(context, spec, gpu::Stage::Compute));
    gpu::test::Run run{.outputs = {&out}};
    for (gpu::test::Picture& picture : pictures) run.inputs.push_back(&picture);
    gpu::test::run_kernel(context, *kernel, run);
    const gpu::test::Pixels pixels = gpu::test::download(context, out);
    std::vector<vec4> values(count);
    for (std::size_t i = 0; i < count; ++i) {
        values[i] = {pixels.rgba[4 * i], pixels.rgba[4 * i + 1], pixels.rgba[4 * i + 2], pixels.rgba[4 * i + 3]};
    }
    return values;
}

/// The least and the most of what a pixel may show.
struct Range {
    dvec3 low{0}, high{0};
};

/// Of `truth(x, y)` at the pixel's centre and at places as far beside it as vertices may be shifted; where it says
/// nothing such a place is passed over.
inline Range around_center(std::uint32_t x, std::uint32_t y,
                           const std::function<std::optional<dvec3>(double, double)>& truth) {
    const double shift = gpu::test::vertex_shift();
    const dvec3 center = truth(x + 0.5, y + 0.5).value();
    Range range{center, center};
    if (shift == 0) return range;
    for (const double down : {-shift, 0.0, shift})
        for (const double right : {-shift, 0.0, shift})
            if (const std::optional<dvec3> there = truth(x + 0.5 + right, y + 0.5 + down)) {
                range.low = glm::min(range.low, *there);
                range.high = glm::max(range.high, *there);
            }
    return range;
}

/// Compares red, green and blue, and reports the largest excess.
inline void expect_close(const std::vector<vec4>& device, const std::vector<dvec3>& truth, double relative,
                         double absolute) {
    ASSERT_EQ(device.size(), truth.size());
    double worst = 0;
    std::size_t place = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double error = std::abs(double(device[i][c]) - truth[i][c]);
            const double excess = error / (relative * std::abs(truth[i][c]) + absolute);
            if (!(excess <= worst) && !std::isnan(worst)) {
                worst = excess;
                place = i;
            }
        }
    }
    EXPECT_LE(worst, 1) << "at " << place << ": " << device[place].x << ' ' << device[place].y << ' ' << device[place].z
                        << " instead of " << truth[place].x << ' ' << truth[place].y << ' ' << truth[place].z;
}

/// Equally distributed over the sphere, or over the hemisphere of positive y.
class Directions {
  public:
    explicit Directions(std::uint32_t seed) : engine_(seed) {}
    double number() { return static_cast<double>(engine_()) / 4294967296.0; }
    dvec3 on_sphere() {
        const double y = 2 * number() - 1;
        const double angle = 2 * std::numbers::pi * number();
        const double radius = std::sqrt(1 - y * y);
        return {radius * std::cos(angle), y, radius * std::sin(angle)};
    }
    dvec3 around(const dvec3& n) {
        const dvec3 direction = on_sphere();
        return glm::dot(direction, n) < 0 ? -direction : direction;
    }

  private:
    std::mt19937 engine_;
};

}  // namespace darkroom::render::test
