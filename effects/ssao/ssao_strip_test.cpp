// SPDX-License-Identifier: MIT
// Makes the page's picture, in the folder that DARKROOM_PICTURES names: of each scene of boxes, without a colour of its
// own, what rays say, then ours with 16 samples at half size, with 64 at full size, and nothing.
#include <gtest/gtest.h>

#include <cstdlib>
#include <darkroom/composer.hpp>
#include <darkroom/effects/ssao.hpp>
#include <filesystem>

#include "image/picture/write.hpp"
#include "ssao/ssao_truth.hpp"

namespace darkroom {
namespace {

constexpr std::uint32_t strip_width = 320, strip_height = 180, strip_left = 320,
                        strip_top = 180;  // of 960x540, pixel by pixel

ReferenceImage occlusion_of(const test::BoxView& view, const Ssao& ssao) {
    return test::develop([&](Composer& composer) { composer.add(ssao); }, test::uniform(960, 540, {1, 1, 1, 1}),
                         view.options());
}

/// What is lit from above and a little from the side, times `visibility`, as code values.
void paint(Picture& strip, std::uint32_t column, std::uint32_t row, const test::BoxView& view, const auto& visibility) {
    for (std::uint32_t y = 0; y < strip_height; ++y)
        for (std::uint32_t x = 0; x < strip_width; ++x) {
            const Rgba& normal = view.normals.at(strip_left + x, strip_top + y);
            const double light = 0.6 + 0.25 * normal.g + 0.1 * normal.r;
            const auto code = static_cast<float>(std::pow(light * visibility(strip_left + x, strip_top + y), 1 / 2.2));
            float* const out = strip.at(column * strip_width + x, row * strip_height + y);
            std::fill_n(out, 3, code);
            out[3] = 1;
        }
}

TEST(SoakGpuSsaoTruth, Strip) {
    const char* const folder = std::getenv("DARKROOM_PICTURES");
    if (folder == nullptr) GTEST_SKIP() << "DARKROOM_PICTURES names no folder to write ssao_truth.jpg into";
    const std::array scenes{test::corner_scene(), test::courtyard_scene(), test::stairs_scene()};
    Picture strip(4 * strip_width, static_cast<std::uint32_t>(scenes.size()) * strip_height);
    constexpr float radius = 1;
    for (std::uint32_t row = 0; row < scenes.size(); ++row) {
        const test::BoxView view = test::view_of(scenes[row], 960, 540);
        const test::OcclusionTruth rays(test::triangles_of(scenes[row].boxes));
        paint(strip, 0, row, view, [&](std::uint32_t x, std::uint32_t y) {
            const Rgba& normal = view.normals.at(x, y);
            return rays.visibility(view.point(x, y), {normal.r, normal.g, normal.b}, double{radius}, 16);
        });
        const ReferenceImage usual = occlusion_of(view, {.radius = radius});
        const ReferenceImage best =
            occlusion_of(view, {.radius = radius, .samples = 64, .resolution = SsaoResolution::Full});
        paint(strip, 1, row, view, [&](std::uint32_t x, std::uint32_t y) { return usual.at(x, y).r; });
        paint(strip, 2, row, view, [&](std::uint32_t x, std::uint32_t y) { return best.at(x, y).r; });
        paint(strip, 3, row, view, [](std::uint32_t, std::uint32_t) { return 1.0; });
    }
    const auto written = write_picture(std::filesystem::path(folder) / "ssao_truth.jpg", strip);
    ASSERT_TRUE(written) << written.error().text;
}

}  // namespace
}  // namespace darkroom
