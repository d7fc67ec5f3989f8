// SPDX-License-Identifier: MIT
#include "window/pane.hpp"

#include <numbers>
#include <random>

#include "panels/show/false_color.hpp"
#include "shared/color_state_reference.hpp"
#include "window/test_gui_pass.hpp"

namespace darkroom::window {
namespace {

using gpu::test::make_pixels;
using gpu::test::upload;
using test::Picture;
using test::Pixels;
using Rgb = std::array<double, 3>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr Rgb magenta{1, 0, 1}, over_red{1, 0.1, 0.1}, under_blue{0.1, 0.3, 1};

// IEC 61966-2-1.
double decode(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }
double encode(double light) { return light <= 0.0031308 ? light * 12.92 : 1.055 * std::pow(light, 1 / 2.4) - 0.055; }
double weighted(const Rgb& color) { return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]; }
template <class Change>
Rgb each(const Rgb& color, Change change) {
    return {change(color[0]), change(color[1]), change(color[2])};
}
Rgb grey(double value) { return {value, value, value}; }

/// What pane.hpp promises of a picture without marks.
Rgb expected(const std::array<float, 4>& texel, const PaneView& view, const Pane& pane) {
    const Rgb color{texel[0], texel[1], texel[2]};
    const double exposure = std::exp2(static_cast<double>(pane.exposure));
    const auto chosen = [&](const Rgb& from) {
        return pane.channels == PaneChannels::Rgb ? from : grey(from[static_cast<std::size_t>(pane.channels) - 1]);
    };
    const auto mapped = [&](double value) { return (value - view.low) / (static_cast<double>(view.high) - view.low); };
    if (pane.channels == PaneChannels::Alpha)
        return grey(view.transfer == PaneTransfer::Raw ? mapped(texel[3]) : texel[3]);
    const bool is_luminance = pane.channels == PaneChannels::Luminance;
    if (view.transfer == PaneTransfer::Raw) {
        const Rgb shown = each(color, mapped);
        return is_luminance ? grey(weighted(shown)) : chosen(shown);
    }
    const bool is_linear = view.transfer == PaneTransfer::SceneLinear;
    const Rgb light = each(color, [&](double value) { return (is_linear ? value : decode(value)) * exposure; });
    return each(is_luminance ? grey(weighted(light)) : chosen(light), encode);
}

ImageRef reference(const Picture& picture) {
    return {.image = picture.image.handle,
            .view = picture.image.view,
            .format = picture.image.info.format,
            .extent = {picture.image.info.extent.width, picture.image.info.extent.height},
            .layout = picture.layout};
}

class WindowGpuPane : public test::GuiPassTest {
  protected:
    static constexpr std::uint32_t width = 16, height = 8, left = 8, top = 16;

    /// The pane's pixels, each texel `zoom` of them wide and high.
    Pixels show(const Pane& pane, std::uint32_t zoom = 1) {
        const Pixels whole = draw(interface.frame([&](ImDrawList& list) {
            list.AddImage(pane.texture(), {left, top},
                          {static_cast<float>(left + width * zoom), static_cast<float>(top + height * zoom)});
        }));
        EXPECT_TRUE(result);
        return make_pixels(width * zoom, height * zoom,
                           [&](std::uint32_t x, std::uint32_t y) { return whole.at(x + left, y + top); });
    }
    void expect_color(const std::array<float, 4>& found, const Rgb& wanted, const std::string& what) const {
        for (std::size_t i = 0; i < 3; ++i)
            // Half a code, and what the driver's pow loses; blending units of hardware need be no more precise than
            // what they blend into (Vulkan specification, "Blending"), and may round a tenth of a code off.
            EXPECT_NEAR(found[i] * 255, std::clamp(wanted[i], 0.0, 1.0) * 255, gpu::test::is_lavapipe() ? 0.55 : 0.65)
                << what << ", channel " << i;
    }

    /// Light and code of all kinds, from below black to above white.
    Pixels numbers(float low = -0.25F, float high = 2.5F) {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> value(low, high);
        return make_pixels(width, height, [&](std::uint32_t, std::uint32_t) {
            return std::array{value(random), value(random), value(random), value(random)};
        });
    }
};

TEST_F(WindowGpuPane, ShowsNumbersAsThePaneSays) {
    const Pixels source = numbers();
    const Picture picture = upload(context, source, VK_FORMAT_R32G32B32A32_SFLOAT);
    for (const PaneTransfer transfer : {PaneTransfer::Encoded, PaneTransfer::SceneLinear, PaneTransfer::Raw})
        for (const PaneChannels channels : {PaneChannels::Rgb, PaneChannels::Red, PaneChannels::Green,
                                            PaneChannels::Blue, PaneChannels::Alpha, PaneChannels::Luminance})
            for (const float exposure : {0.0F, -2.0F, 1.5F}) {
                const Pane pane{.view = {reference(picture), transfer, -0.1F, 1.9F},
                                .exposure = exposure,
                                .channels = channels,
                                .is_nearest = true};
                const Pixels shown = show(pane);
                for (std::uint32_t y = 0; y < height; ++y)
                    for (std::uint32_t x = 0; x < width; ++x)
                        expect_color(
                            shown.at(x, y), expected(source.at(x, y), pane.view, pane),
                            fmt::format("transfer {}, channels {}, {} stops, {}, {}", static_cast<int>(transfer),
                                        static_cast<int>(channels), exposure, x, y));
                if (HasFailure()) return;
            }
}

// A wheel whose hues are those of HSV (A. R. Smith, "Color Gamut Transform Pairs", 1978), turned from red at the right
// against the clock, and as much light as there is motion.
TEST_F(WindowGpuPane, ShowsMotionAsAWheelOfHues) {
    const double full = 8, tau = 2 * std::numbers::pi;
    for (int i = 0; i < 12; ++i)
        for (const double far : {0.04, 0.5, 1.0, 3.0}) {
            const double angle = i * tau / 12;
            // Previous minus present, y down.
            const std::array motion{static_cast<float>(-std::cos(angle) * far * full),
                                    static_cast<float>(std::sin(angle) * far * full), 0.0F, 0.0F};
            const Picture picture =
                upload(context, make_pixels(width, height, [&](std::uint32_t, std::uint32_t) { return motion; }),
                       VK_FORMAT_R32G32B32A32_SFLOAT);
            const Pixels shown =
                show({.view = {reference(picture), PaneTransfer::Motion, 0, static_cast<float>(full)}}, 6);
            const double sixth = angle / tau * 6, rising = std::fmod(sixth, 1.0), falling = 1 - rising;
            const std::array<Rgb, 6> of_sixth{
                {{1, rising, 0}, {falling, 1, 0}, {0, 1, rising}, {0, falling, 1}, {rising, 0, 1}, {1, 0, falling}}};
            const Rgb hue = of_sixth[static_cast<std::size_t>(sixth + 1e-9) % 6];
            const std::string what = fmt::format("{} degrees, {} of the fullest", i * 30, far);
            // In a corner of a cell of 24 pixels, whose arrow is in its middle.
            const std::array<float, 4> corner = shown.at(1, 1);
            const bool is_seam = rising < 1e-6 || falling < 1e-6;  // one sixth or the other: alike but for rounding
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(corner[c] * 255, encode(hue[c] * std::min(far, 1.0)) * 255, is_seam ? 1.5 : 1) << what;
            // Along the arrow it is white, at either side of it not.
            const double x = std::cos(angle), y = -std::sin(angle);
            const auto white = [&](double along, double beside) {
                const std::array<float, 4> texel = shown.at(static_cast<std::uint32_t>(36 + along * x - beside * y),
                                                            static_cast<std::uint32_t>(12 + along * y + beside * x));
                return std::min({texel[0], texel[1], texel[2]});
            };
            if (far < 1) continue;
            EXPECT_GT(white(4, 0), 0.7) << what;
            EXPECT_LT(white(-8, 4), 0.1) << what << ": no head at its start";
            EXPECT_GT(white(7, 3), 0.1) << what << ": the head";
        }
}

TEST_F(WindowGpuPane, ShowsEncodedBytesUnchanged) {
    const Pixels source = make_pixels(width, height, [](std::uint32_t x, std::uint32_t y) {
        const auto code = static_cast<float>(y * 16 + x);
        return std::array{code / 255, (code + 127) / 255, (255 - code) / 255, 0.0F};
    });
    const Picture picture = upload(context, source, VK_FORMAT_R8G8B8A8_UNORM);
    for (const bool is_nearest : {true, false}) {
        const Pixels shown = show({.view = {reference(picture)}, .is_nearest = is_nearest});
        for (std::size_t i = 0; i < source.rgba.size(); ++i)
            ASSERT_EQ(shown.rgba[i], i % 4 == 3 ? 1 : source.rgba[i]) << i;
    }
}

TEST_F(WindowGpuPane, ShowsDepth) {
    gpu::Image depth =
        test::must(gpu::Image::create(context, {.name = "depth",
                                                .format = VK_FORMAT_D32_SFLOAT,
                                                .extent = {width, height, 1},
                                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                                         VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT}));
    test::must(gpu::submit_and_wait(context, "clearing depth", [&](VkCommandBuffer commands) {
        const VkImageSubresourceRange whole{VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
        const VkClearDepthStencilValue half{0.5F, 0};
        gpu::transition(context, commands, depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        context.vk.CmdClearDepthStencilImage(commands, depth.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &half, 1,
                                             &whole);
        gpu::transition(context, commands, depth, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                        VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    }));
    const Picture picture{std::move(depth), VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
    const Pixels shown =
        show({.view = {reference(picture), PaneTransfer::Raw, 0.25F, 0.75F}, .channels = PaneChannels::Red});
    expect_color(shown.at(3, 3), grey(0.5), "depth");
}

TEST_F(WindowGpuPane, MagnifiesTexelsAsSquaresOrSmoothly) {
    const Pixels source = numbers(0, 1);
    const Picture picture = upload(context, source, VK_FORMAT_R32G32B32A32_SFLOAT);
    const Pixels squares = show({.view = {reference(picture)}, .is_nearest = true}, 4);
    const Pixels smooth = show({.view = {reference(picture)}}, 4);
    for (std::uint32_t x = 2; x + 2 < width * 4; ++x) {
        EXPECT_EQ(squares.at(x, 10)[1], squares.at(x / 4 * 4, 8)[1]) << x;
        const double place = (x + 0.5) / 4 - 0.5;
        const auto column = static_cast<std::uint32_t>(place);
        const auto texel = [&](std::uint32_t i, std::uint32_t j) { return double{source.at(i, j)[1]}; };
        const auto row = [&](std::uint32_t j) {
            return std::lerp(texel(column, j), texel(column + 1, j), place - column);
        };
        // Vulkan gives weights in steps of no more than 1/16, which is 16 codes; drivers have 1/256.
        EXPECT_NEAR(smooth.at(x, 10)[1] * 255, std::lerp(row(2), row(3), (10.5 / 4 - 0.5) - 2) * 255, 2) << x;
    }
}

TEST_F(WindowGpuPane, ShowsTheRegionAndNothingBesideIt) {
    const Pixels source = make_pixels(64, 32, [](std::uint32_t x, std::uint32_t y) {
        const bool is_inside = x >= 20 && x < 36 && y >= 10 && y < 18;
        return is_inside ? std::array{0.0F, 1.0F, 0.0F, 1.0F} : std::array{1.0F, 0.0F, 0.0F, 1.0F};
    });
    const Picture picture = upload(context, source, VK_FORMAT_R8G8B8A8_UNORM);
    Pane pane{.view = {reference(picture)}};
    pane.view.image.region = {{20, 10}, {16, 8}};
    const Pixels shown = show(pane, 4);
    for (std::size_t i = 0; i < shown.rgba.size(); i += 4) {
        ASSERT_EQ(shown.rgba[i], 0) << i;
        ASSERT_EQ(shown.rgba[i + 1], 1) << i;
    }
}

TEST_F(WindowGpuPane, ComparesTwoViewsAtADivider) {
    const Picture first = upload(context, numbers(0, 1), VK_FORMAT_R32G32B32A32_SFLOAT);
    const Pixels other = make_pixels(4, 4, [](std::uint32_t, std::uint32_t) {
        return std::array{0.1F, 0.2F, 0.3F, 1.0F};
    });
    const Picture second = upload(context, other, VK_FORMAT_R16G16B16A16_SFLOAT);
    const PaneView light{reference(second), PaneTransfer::SceneLinear};
    const Pane alone{.view = {reference(first)}, .is_nearest = true};
    const Pixels without = show(alone);
    for (const std::uint32_t divider : {0U, 5U, 8U, 16U}) {
        Pane pane = alone;
        pane.second = light;
        pane.divider = static_cast<float>(divider) / width;
        const Pixels shown = show(pane);
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::string what = fmt::format("divider {}, column {}", divider, x);
            if (x + 1 == divider || x == divider) {
                expect_color(shown.at(x, 4), grey(0.9), what);
            } else if (x < divider) {
                EXPECT_EQ(shown.at(x, 4), without.at(x, 4)) << what;
            } else {
                expect_color(shown.at(x, 4), {encode(0.1), encode(0.2), encode(0.3)}, what);
            }
        }
    }
}

TEST_F(WindowGpuPane, DrawsNothingOfImagesThatAreNotGiven) {
    const Picture picture = upload(context, numbers(0, 1), VK_FORMAT_R32G32B32A32_SFLOAT);
    const Pixels nothing = show({.second = PaneView{reference(picture)}});
    expect_color(nothing.at(12, 4), {test::background[0], test::background[1], test::background[2]}, "background");
    const Pane alone{.view = {reference(picture)}};
    Pane without_second = alone;
    without_second.second = PaneView{};
    EXPECT_EQ(show(without_second).rgba, show(alone).rgba);
}

/// A texel for each band, in its middle, and the picture's grey there.
Pixels band_samples(std::span<const panels::FalseColorBand> bands, double below, double above, bool is_linear) {
    return make_pixels(16, 8, [&](std::uint32_t x, std::uint32_t) {
        const std::size_t band = std::min<std::size_t>(x, bands.size() - 1);
        const double from = band == 0 ? below : bands[band].from;
        const double end = band + 1 == bands.size() ? above : bands[band + 1].from;
        const double middle = (from + end) / 2;
        const auto value = static_cast<float>(is_linear ? 0.18 * std::exp2(middle) : middle);
        return std::array{value, value, value, 1.0F};
    });
}

TEST_F(WindowGpuPane, ColorsEachBand) {
    for (const bool is_linear : {true, false}) {
        const std::span<const panels::FalseColorBand> bands =
            is_linear ? std::span<const panels::FalseColorBand>(panels::stop_bands)
                      : std::span<const panels::FalseColorBand>(panels::code_bands);
        const Pixels source = band_samples(bands, is_linear ? -8 : 0, is_linear ? 8 : 1, is_linear);
        const Picture picture = upload(context, source, VK_FORMAT_R32G32B32A32_SFLOAT);
        const Pixels shown =
            show({.view = {reference(picture), is_linear ? PaneTransfer::SceneLinear : PaneTransfer::Encoded},
                  .is_false_color = true,
                  .is_nearest = true});
        for (std::uint32_t band = 0; band < bands.size(); ++band) {
            const auto& [r, g, b] = bands[band].color;
            expect_color(shown.at(band, 1), bands[band].is_grey ? grey(source.at(band, 1)[0]) : Rgb{r, g, b},
                         std::string(bands[band].name));
        }
    }
}

TEST_F(WindowGpuPane, FalseColorIsOfTheExposedLuminance) {
    const Pixels source = make_pixels(width, height, [](std::uint32_t, std::uint32_t) {
        return std::array{0.0F, 0.18F / 0.7152F, 0.0F, 1.0F};
    });
    const Picture picture = upload(context, source, VK_FORMAT_R32G32B32A32_SFLOAT);
    Pane pane{.view = {reference(picture), PaneTransfer::SceneLinear}, .is_false_color = true};
    for (const panels::FalseColorBand& band : panels::stop_bands) {
        if (band.from == panels::lowest_band) continue;
        pane.exposure = static_cast<float>(band.from) + 0.1F;
        const auto& [r, g, b] = band.color;
        expect_color(show(pane).at(5, 5), {r, g, b}, std::string(band.name));
    }
}

TEST_F(WindowGpuPane, MarksWhatIsClippedOrBroken) {
    const std::vector<std::pair<std::array<float, 4>, std::optional<Rgb>>> cases{
        {{0, 0.5F, 0.999F, 1}, std::nullopt},
        {{0.2F, 1, 0.3F, 1}, over_red},
        {{0.2F, 7, -0.3F, 1}, over_red},
        {{0.2F, 0.5F, -0.001F, 1}, under_blue},
        {{0.2F, not_a_number, 2, 1}, magenta},
        {{static_cast<float>(infinity), 0, 0, 1}, magenta},
        {{0, 0, static_cast<float>(-infinity), 1}, magenta}};
    const Pixels source = make_pixels(width, height, [&](std::uint32_t x, std::uint32_t) {
        return cases[std::min<std::size_t>(x / 2, cases.size() - 1)].first;
    });
    const Picture picture = upload(context, source, VK_FORMAT_R32G32B32A32_SFLOAT);
    Pane pane{.view = {reference(picture), PaneTransfer::SceneLinear}, .is_nearest = true};
    const Pixels unmarked = show(pane);
    pane.is_clipping_marked = true;
    const Pixels marked = show(pane);
    for (std::uint32_t i = 0; i < cases.size(); ++i) {
        int stripes = 0;
        for (std::uint32_t y = 0; y < height; ++y) {
            const std::array<float, 4> found = marked.at(i * 2, y);
            if (found == unmarked.at(i * 2, y)) continue;
            ++stripes;
            ASSERT_TRUE(cases[i].second) << i;
            expect_color(found, *cases[i].second, fmt::format("case {}", i));
        }
        const int all = cases[i].second == magenta ? 8 : 4;
        EXPECT_EQ(stripes, cases[i].second ? all : 0) << i;
    }
    // Broken numbers are black where nothing is marked.
    expect_color(unmarked.at(8, 3), {0, 0, 0}, "not a number");
}

TEST_F(WindowGpuPane, RefusesMorePanesThanItHasSetsFor) {
    const Picture picture = upload(context, numbers(0, 1), VK_FORMAT_R32G32B32A32_SFLOAT);
    std::vector<Pane> panes(GuiPass::max_panes + 1, Pane{.view = {reference(picture)}});
    const auto with = [&](std::size_t count) -> const ImDrawData& {
        return interface.frame([&](ImDrawList& list) {
            // Each twice: a picture shown again takes no more.
            for (std::size_t i = 0; i < 2 * count; ++i) list.AddImage(panes[i % count].texture(), {0, 0}, {8, 8});
        });
    };
    draw(with(GuiPass::max_panes));
    EXPECT_TRUE(result);
    draw(with(GuiPass::max_panes + 1));
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().text.find("more than 256 pictures"), std::string::npos) << result.error().text;
    draw(with(1));
    EXPECT_TRUE(result);
}

class WindowGpuHighRange : public test::GuiPassTest, public ::testing::WithParamInterface<ColorState> {
  protected:
    WindowGpuHighRange() : GuiPassTest(VK_FORMAT_R16G16B16A16_SFLOAT, GetParam()) {}

    [[nodiscard]] std::array<double, 3> nits(const Pixels& pixels, std::uint32_t x, std::uint32_t y) const {
        const std::array<float, 4> p = pixels.at(x, y);
        return nits_of({p[0], p[1], p[2]}, GetParam());
    }
};

// White of the interface is that of BT.2408, and light goes on to the display's peak.
TEST_P(WindowGpuHighRange, WhatIsDrawnHasItsLuminance) {
    const std::array<float, 4> lights{0.05F, 1, 3, 40};
    const Picture light = upload(context,
                                 make_pixels(4, 1,
                                             [&](std::uint32_t x, std::uint32_t) {
                                                 return std::array{lights[x], lights[x], lights[x], 1.0F};
                                             }),
                                 VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
    Pane pane{.view = {.image = reference(light), .transfer = PaneTransfer::SceneLinear}, .is_nearest = true};
    const Pixels pixels = draw(interface.frame([&](ImDrawList& list) {
        list.AddRectFilled({0, 0}, {16, 16}, IM_COL32_WHITE);
        list.AddRectFilled({16, 0}, {32, 16}, IM_COL32(128, 128, 128, 255));
        list.AddImage(pane.texture(), {0, 16}, {64, 32});
    }));
    ASSERT_TRUE(result);
    const auto expect_nits = [&](std::uint32_t x, std::uint32_t y, double wanted) {
        for (const double found : nits(pixels, x, y)) EXPECT_NEAR(found, wanted, 0.01 * wanted) << x << " " << y;
    };
    expect_nits(8, 8, 203);
    expect_nits(24, 8, 203 * decode(128 / 255.0));
    for (std::uint32_t i = 0; i < lights.size(); ++i) expect_nits(16 * i + 8, 24, std::min(203.0 * lights[i], 1000.0));
}

INSTANTIATE_TEST_SUITE_P(Targets, WindowGpuHighRange, ::testing::Values(scrgb_color, pq_color, hlg_color));

}  // namespace
}  // namespace darkroom::window
