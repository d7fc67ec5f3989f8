// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <darkroom/effects/upscale.hpp>
#include <filesystem>
#include <limits>

#include "compose/test_stacks/host.hpp"
#include "gpu/test_support.hpp"
#include "image/compare/flip.hpp"
#include "image/picture/display_picture.hpp"
#include "shared/srgb_reference.hpp"
#include "upscale/upscale_reference.hpp"

namespace darkroom {
namespace {

constexpr double half_a_code_of_16 = 0.5 / 65535;

ReferenceImage upscaled_reference(const Upscale& upscale, const ReferenceImage& picture, std::uint32_t width,
                                  std::uint32_t height) {
    return upscale_reference(&upscale,
                             {.picture = &picture, .source = &picture, .output_width = width, .output_height = height});
}

/// A picture that is developed into a larger target.
class Enlarged {
  public:
    Enlarged(const ReferenceImage& picture, VkExtent2D target)
        : host_(picture), target_(gpu::test::blank(host_.device.context(), target, VK_FORMAT_R32G32B32A32_SFLOAT)) {}

    ReferenceImage run(const Upscale& upscale, KernelStage kernels = KernelStage::Auto, bool is_on = true) {
        Composer composer(host_.device);
        composer.add(upscale, {.enabled = is_on});
        CompileDesc desc = host_.compile_desc();
        desc.target_extent = test::image_ref(target_).extent;
        desc.kernels = kernels;
        test::must(composer.compile(desc));
        Frame frame = host_.frame();
        frame.target = test::image_ref(target_);
        test::must(host_.record(composer, frame));
        return test::image_of(gpu::test::download(host_.device.context(), target_));
    }

  private:
    test::Host host_;
    gpu::test::Picture target_;
};

/// FsrEasuF of ffx_fsr1.h for a grey picture, written down once more with its own names.
double published(const ReferenceImage& picture, double x, double y) {
    const double left = std::floor(x), top = std::floor(y), px = x - left, py = y - top;
    const auto at = [&](int i, int j) {
        return picture.clamped(static_cast<std::int64_t>(left) + i, static_cast<std::int64_t>(top) + j).g;
    };
    double dir_x = 0, dir_y = 0, len = 0;
    const auto set = [&](double w, int i, int j) {
        const double a = 2 * at(i, j - 1), b = 2 * at(i - 1, j), c = 2 * at(i, j), d = 2 * at(i + 1, j),
                     e = 2 * at(i, j + 1);
        const double max_x = std::max(std::abs(d - c), std::abs(c - b));
        const double max_y = std::max(std::abs(e - c), std::abs(c - a));
        const double len_x = max_x > 0 ? std::min(std::abs(d - b) / max_x, 1.0) : 0;
        const double len_y = max_y > 0 ? std::min(std::abs(e - a) / max_y, 1.0) : 0;
        dir_x += (d - b) * w, dir_y += (e - a) * w;
        len += (len_x * len_x + len_y * len_y) * w;
    };
    set((1 - px) * (1 - py), 0, 0), set(px * (1 - py), 1, 0), set((1 - px) * py, 0, 1), set(px * py, 1, 1);
    const double dir_r = dir_x * dir_x + dir_y * dir_y;
    const bool is_zero = dir_r < 1.0 / 32768;
    const double norm = is_zero ? 1 : 1 / std::sqrt(dir_r);
    dir_x = (is_zero ? 1 : dir_x) * norm, dir_y *= norm;
    len = 0.5 * len * 0.5 * len;
    const double stretch = (dir_x * dir_x + dir_y * dir_y) / std::max(std::abs(dir_x), std::abs(dir_y));
    const double len_x = 1 + (stretch - 1) * len, len_y = 1 - 0.5 * len, lob = 0.5 + (0.21 - 0.5) * len, clip = 1 / lob;
    double color = 0, weight = 0;
    for (int j = -1; j <= 2; ++j)
        for (int i = -1; i <= 2; ++i) {
            if ((i == -1 || i == 2) && (j == -1 || j == 2)) continue;
            const double off_x = i - px, off_y = j - py;
            const double vx = (off_x * dir_x + off_y * dir_y) * len_x, vy = (off_y * dir_x - off_x * dir_y) * len_y;
            const double d2 = std::min(vx * vx + vy * vy, clip), wb = 0.4 * d2 - 1, wa = lob * d2 - 1;
            const double w = (25.0 / 16 * wb * wb - 9.0 / 16) * wa * wa;
            color += at(i, j) * w, weight += w;
        }
    const auto [least, most] = std::minmax({at(0, 0), at(1, 0), at(0, 1), at(1, 1)});
    return std::clamp(color / weight, least, most);
}

TEST(EffectUpscale, GpuIsThePublishedFormula) {
    ReferenceImage picture = test::round_to_float(test::random_display(47, 31, 1));
    for (Rgba& pixel : picture.pixels) pixel.r = pixel.b = pixel.g;
    for (const VkExtent2D extent : {VkExtent2D{94, 62}, {70, 46}, {131, 40}}) {
        Enlarged enlarged(picture, extent);
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            const ReferenceImage out = enlarged.run({}, stage);
            ASSERT_EQ(out.width, extent.width);
            double worst = 0;
            for (std::uint32_t y = 0; y < out.height; ++y)
                for (std::uint32_t x = 0; x < out.width; ++x)
                    worst = std::max(worst,
                                     std::abs(out.at(x, y).g - published(picture, (x + 0.5) * 47 / extent.width - 0.5,
                                                                         (y + 0.5) * 31 / extent.height - 0.5)));
            EXPECT_LE(worst, half_a_code_of_16) << extent.width;
        }
    }
}

TEST(EffectUpscale, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_display(37, 23, 2));
    for (const VkExtent2D extent : {VkExtent2D{74, 46}, {55, 35}, {150, 24}, {38, 90}}) {
        Enlarged enlarged(picture, extent);
        for (const float adaption : {0.0f, 0.5f, 1.0f}) {
            const Upscale upscale{.adaption = adaption};
            EXPECT_LE(test::worst_difference(enlarged.run(upscale),
                                             upscaled_reference(upscale, picture, extent.width, extent.height)),
                      half_a_code_of_16)
                << extent.width << " " << adaption;
        }
    }
}

TEST(EffectUpscale, GpuKeepsFlatFieldsAndPicturesThatAreLargeEnough) {
    const ReferenceImage flat = test::round_to_float(test::uniform(9, 7, {0.3, 0.7, 0.1, 0.25}));
    for (const Rgba& pixel : Enlarged(flat, {31, 19}).run({}).pixels) {
        EXPECT_EQ(pixel.r, flat.pixels[0].r);
        EXPECT_EQ(pixel.a, flat.pixels[0].a);
    }
    const ReferenceImage picture = test::round_to_float(test::random_display(33, 21, 3));
    EXPECT_EQ(test::worst_difference(Enlarged(picture, {33, 21}).run({}), picture), 0);
}

TEST(EffectUpscale, GpuStaysWithinTheNearestFour) {
    ReferenceImage edge(24, 16, {0.1, 0.1, 0.1, 1});
    for (std::uint32_t y = 0; y < 16; ++y)
        for (std::uint32_t x = 0; x < 24; ++x)
            if (y > 3 + x / 3) edge.at(x, y) = {0.9, 0.9, 0.9, 1};
    for (const Rgba& pixel : Enlarged(edge, {60, 40}).run({}).pixels) {
        EXPECT_GE(pixel.g, 0.1f);
        EXPECT_LE(pixel.g, 0.9f);
    }
}

TEST(EffectUpscale, GpuOnTinyPictures) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 7u}, {9u, 1u}, {2u, 2u}}) {
        const ReferenceImage picture = test::round_to_float(test::random_display(width, height, 3));
        EXPECT_LE(test::worst_difference(Enlarged(picture, {13, 11}).run({}), upscaled_reference({}, picture, 13, 11)),
                  half_a_code_of_16)
            << width << "x" << height;
    }
}

TEST(EffectUpscale, GpuNanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture = test::round_to_float(test::random_display(24, 24, 4));
    picture.at(6, 6) = {nan, nan, nan, 1};
    picture.at(15, 9) = {infinity, -infinity, infinity, 1};
    const ReferenceImage out = Enlarged(picture, {48, 48}).run({});
    ASSERT_EQ(out.pixels.size(), 48U * 48);
    for (std::uint32_t y = 0; y < 48; ++y)
        for (std::uint32_t x = 0; x < 48; ++x) {
            const auto is_near = [&](double i, double j) {
                return std::abs((x + 0.5) / 2 - i - 0.5) <= 3 && std::abs((y + 0.5) / 2 - j - 0.5) <= 3;
            };
            const bool is_beside = is_near(6, 6) || is_near(15, 9);
            for (const double value : {out.at(x, y).r, out.at(x, y).g, out.at(x, y).b})
                EXPECT_TRUE(value >= (is_beside ? -65504 : 0) && value <= (is_beside ? 65504 : 1)) << x << "," << y;
        }
}

/// Means of squares of `scale` pixels, which need not be whole.
ReferenceImage reduced(const ReferenceImage& picture, std::uint32_t width, std::uint32_t height) {
    ReferenceImage out(width, height, {0, 0, 0, 1});
    const auto weights = [](std::uint32_t i, std::uint32_t small, std::uint32_t large) {
        const double from = double{1} * i * large / small, to = (i + 1.0) * large / small;
        std::vector<std::pair<std::int64_t, double>> list;
        for (auto at = static_cast<std::int64_t>(from); static_cast<double>(at) < to - 1e-9; ++at) {
            const auto low = static_cast<double>(at);
            list.emplace_back(at, (std::min(to, low + 1) - std::max(from, low)) / (to - from));
        }
        return list;
    };
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            for (const auto& [j, wy] : weights(y, height, picture.height))
                for (const auto& [i, wx] : weights(x, width, picture.width)) {
                    const Rgba& c = picture.clamped(i, j);
                    Rgba& sum = out.at(x, y);
                    sum = {sum.r + wx * wy * c.r, sum.g + wx * wy * c.g, sum.b + wx * wy * c.b, 1};
                }
    return out;
}

/// By a filter of four pixels each way: `bend` -0.5 is Catmull-Rom's (R. Keys, 1981); none: the bilinear one.
ReferenceImage filtered(const ReferenceImage& picture, std::uint32_t width, std::uint32_t height, bool is_cubic) {
    const auto weight = [&](double d) {
        d = std::abs(d);
        if (!is_cubic) return std::max(1 - d, 0.0);
        return d < 1 ? 1.5 * d * d * d - 2.5 * d * d + 1 : d < 2 ? -0.5 * d * d * d + 2.5 * d * d - 4 * d + 2 : 0.0;
    };
    ReferenceImage out(width, height, {0, 0, 0, 1});
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const UpscalePlace px = upscale_place(x, picture.width, width),
                               py = upscale_place(y, picture.height, height);
            Rgba& sum = out.at(x, y);
            for (int j = -1; j <= 2; ++j)
                for (int i = -1; i <= 2; ++i) {
                    const double w = weight(i - px.part) * weight(j - py.part);
                    const Rgba& c = picture.clamped(px.base + i, py.base + j);
                    sum = {sum.r + w * c.r, sum.g + w * c.g, sum.b + w * c.b, 1};
                }
        }
    return out;
}

double flip_of(const ReferenceImage& truth, const ReferenceImage& shown) {
    const auto picture_of = [](const ReferenceImage& image) {
        Picture out(image.width, image.height);
        for (std::uint32_t y = 0; y < image.height; ++y)
            for (std::uint32_t x = 0; x < image.width; ++x) {
                const Rgba& c = image.at(x, y);
                const std::array values{c.r, c.g, c.b, 1.0};
                for (std::size_t i = 0; i < 4; ++i) out.at(x, y)[i] = static_cast<float>(values[i]);
            }
        return out;
    };
    return test::must(flip(picture_of(truth), picture_of(shown))).mean;
}

/// A stored frame as a display shows it, some 200 lines high.
ReferenceImage shown_frame(const std::filesystem::path& path) {
    const ComparablePicture read = test::must(read_comparable(path));
    ReferenceImage out(read.picture.width, read.picture.height);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const auto value = [&](std::size_t i) { return finite_light_reference(double{read.picture.at(x, y)[i]}); };
            out.at(x, y) = {value(0), value(1), value(2), 1};
        }
    const double scale = std::max(out.height / 200.0, 1.0);
    out = reduced(out, static_cast<std::uint32_t>(out.width / scale), static_cast<std::uint32_t>(out.height / scale));
    if (read.encoding == PictureEncoding::SceneLinear)
        for (Rgba& c : out.pixels) {
            const auto encoded = [](double light) { return srgb_encoded(1 - std::exp(-light)); };
            c = {encoded(c.r), encoded(c.g), encoded(c.b), 1};
        }
    return out;
}

TEST(EffectUpscale, StoredFramesAreNearerToTheTruthThanByOtherFilters) {
    const char* const folder = std::getenv("DARKROOM_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "DARKROOM_TEST_DATA is not set";
    const EffectInfo* const sharpen = find_effect("sharpen");
    for (const double scale : {0.67, 0.5}) {
        double sums[3] = {};
        for (const char* const name :
             {"exr/render_interior/interior.0022.exr", "exr/beachball/singlepart.0001.exr", "exr/photos/Carrots.exr",
              "exr/photos/Desk.exr", "exr/photos/Rec709.exr", "flip/hdr/reference.exr", "flip/ldr/reference.png"}) {
            const ReferenceImage truth = shown_frame(std::filesystem::path(folder) / name);
            const std::uint32_t width = truth.width, height = truth.height;
            const ReferenceImage small = reduced(truth, static_cast<std::uint32_t>(std::lround(width * scale)),
                                                 static_cast<std::uint32_t>(std::lround(height * scale)));
            ReferenceImage up = upscaled_reference({}, small, width, height);
            if (sharpen != nullptr)
                up = sharpen->reference(sharpen->parameters.defaults.data(), {.picture = &up, .source = &up});
            const double own = flip_of(truth, up), bilinear = flip_of(truth, filtered(small, width, height, false)),
                         cubic = flip_of(truth, filtered(small, width, height, true));
            EXPECT_LE(own, 1.05 * std::min(bilinear, cubic)) << name << " at " << scale;
            sums[0] += own, sums[1] += bilinear, sums[2] += cubic;
            std::printf("%s %.2f: %.4f bilinear %.4f cubic %.4f\n", name, scale, own, bilinear, cubic);
        }
        RecordProperty(scale > 0.6 ? "two thirds" : "half", std::to_string(sums[0] / 7) + " bilinear " +
                                                                std::to_string(sums[1] / 7) + " cubic " +
                                                                std::to_string(sums[2] / 7));
        EXPECT_LT(sums[0], sums[1]) << scale;
        EXPECT_LT(sums[0], sums[2]) << scale;
    }
}

}  // namespace
}  // namespace darkroom
