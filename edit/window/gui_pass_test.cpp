// SPDX-License-Identifier: MIT
#include "window/gui_pass.hpp"

#include "panels/test_rasteriser.hpp"
#include "window/test_gui_pass.hpp"

namespace darkroom::window {
namespace {

using test::background;
using test::must;
using test::Picture;
using test::Pixels;

/// Within `codes` of 255 of what the CPU draws.
void expect_as_drawn_by_the_cpu(const Pixels& pixels, const ImDrawData& data, int codes) {
    const ImVec4 clear{background[0], background[1], background[2], background[3]};
    const panels::GuiPicture expected = panels::GuiRasteriser(clear).draw(data);
    int wrong = 0;
    for (std::uint32_t y = 0; y < pixels.height; ++y)
        for (std::uint32_t x = 0; x < pixels.width; ++x)
            for (std::uint32_t i = 0; i < 3; ++i) {
                const long code = std::lround(pixels.at(x, y)[i] * 255);
                const int wanted = expected.at(static_cast<int>(x), static_cast<int>(y))[i];
                if (std::abs(code - wanted) <= codes) continue;
                if (++wrong <= 5) ADD_FAILURE() << x << ", " << y << ", " << i << ": " << code << " for " << wanted;
            }
    EXPECT_EQ(wrong, 0);
}

/// The atlas may be read at coarser coordinates than lavapipe's: SwiftShader's have 16 bits, of hundreds of texels.
int codes_of_text() { return gpu::test::is_lavapipe() ? 1 : 4; }

class WindowGpuGuiPass : public test::GuiPassTest {};

TEST_F(WindowGpuGuiPass, DrawsTextAndShapesAsTheCpuDoes) {
    const ImDrawData& data = interface.frame([](ImDrawList& list) {
        list.AddRectFilled({8, 8}, {40, 24}, IM_COL32(200, 40, 20, 255));
        list.AddRectFilled({30, 12}, {60, 40}, IM_COL32(20, 60, 220, 128));
        list.AddRectFilledMultiColor({60, 2}, {92, 30}, IM_COL32(255, 0, 0, 255), IM_COL32(0, 255, 0, 255),
                                     IM_COL32(0, 0, 255, 255), IM_COL32(255, 255, 255, 0));
        list.AddText({4, 26}, IM_COL32(255, 255, 255, 255), "Exposure 1.5");
        // A list of its own, drawn last.
        ImGui::GetForegroundDrawList()->AddText({4.5F, 44.25F}, IM_COL32(255, 200, 0, 180), "gpu: 3.25 ms");
    });
    const Pixels pixels = draw(data);
    ASSERT_TRUE(result);
    expect_as_drawn_by_the_cpu(pixels, data, codes_of_text());
    EXPECT_EQ(pixels.at(8, 8), (std::array{200 / 255.0F, 40 / 255.0F, 20 / 255.0F, 1.0F}));
}

TEST_F(WindowGpuGuiPass, KeepsToClipRectangles) {
    const ImDrawData& data = interface.frame([](ImDrawList& list) {
        list.PushClipRect({10, 6}, {30, 20});
        list.AddRectFilled({0, 0}, {96, 64}, IM_COL32_WHITE);
        list.PopClipRect();
        list.PushClipRect({-20, 50}, {500, 500});
        list.AddRectFilled({80, 0}, {96, 64}, IM_COL32_BLACK);
        list.PopClipRect();
        list.PushClipRect({40, 40}, {40, 60});
        list.AddRectFilled({0, 0}, {96, 64}, IM_COL32(255, 0, 0, 255));
    });
    const Pixels pixels = draw(data);
    expect_as_drawn_by_the_cpu(pixels, data, 0);
    EXPECT_EQ(pixels.at(10, 6)[0], 1);
    EXPECT_NE(pixels.at(30, 6)[0], 1);
    EXPECT_EQ(pixels.at(95, 63)[0], 0);
}

TEST_F(WindowGpuGuiPass, CallsWhatListsAskFor) {
    int calls = 0;
    const ImDrawData& data = interface.frame([&](ImDrawList& list) {
        list.AddRectFilled({8, 8}, {40, 24}, IM_COL32(200, 40, 20, 255));
        list.AddCallback(
            [](const ImDrawList*, const ImDrawCmd* command) { ++*static_cast<int*>(command->UserCallbackData); },
            &calls);
        list.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
        list.AddRectFilled({30, 12}, {60, 40}, IM_COL32(20, 60, 220, 128));
    });
    expect_as_drawn_by_the_cpu(draw(data), data, 1);
    EXPECT_EQ(calls, 1);
}

TEST_F(WindowGpuGuiPass, PointsMayBeSeveralPixels) {
    ImGui::GetIO().DisplaySize = {48, 32};
    ImGui::GetIO().DisplayFramebufferScale = {2, 2};
    const Pixels pixels = draw(interface.frame([](ImDrawList& list) {
        list.PushClipRect({0, 0}, {12, 32});
        list.AddRectFilled({4, 4}, {20, 8}, IM_COL32(255, 0, 0, 255));
    }));
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 96; ++x)
            ASSERT_EQ(pixels.at(x, y)[0] == 1, x >= 8 && x < 24 && y >= 8 && y < 16) << x << ", " << y;
}

/// Squares of two pixels all over the target, again and again, in one list.
void add_squares(ImDrawList& list, int count) {
    for (int i = 0; i < count; ++i) {
        const ImVec2 place{static_cast<float>(i * 2 % 96), static_cast<float>(i * 2 / 96 * 2 % 64)};
        list.AddRectFilled(place, {place.x + 2, place.y + 2}, IM_COL32(i % 256, i / 256 % 256, 77, 255));
    }
}

TEST_F(WindowGpuGuiPass, BuffersGrowBeyondWhatSmallIndicesReach) {
    for (const int squares : {1, 40'000, 3}) {
        const ImDrawData& data = interface.frame([&](ImDrawList& list) { add_squares(list, squares); });
        expect_as_drawn_by_the_cpu(draw(data), data, 0);
    }
}

TEST_F(WindowGpuGuiPass, SlotsKeepWhatTheyDraw) {
    Picture other = gpu::test::blank(context, extent, VK_FORMAT_R8G8B8A8_UNORM);
    const auto frame = [&](ImU32 color) -> const ImDrawData& {
        return interface.frame([=](ImDrawList& list) { list.AddRectFilled({0, 0}, {96, 64}, color); });
    };
    must(gpu::submit_and_wait(context, "drawing two frames", [&](VkCommandBuffer commands) {
        record(commands, target, frame(IM_COL32(255, 0, 0, 255)), 0);
        record(commands, other, frame(IM_COL32(0, 0, 255, 255)), 1);
    }));
    EXPECT_EQ(gpu::test::download(context, target).at(50, 30), (std::array{1.0F, 0.0F, 0.0F, 1.0F}));
    EXPECT_EQ(gpu::test::download(context, other).at(50, 30), (std::array{0.0F, 0.0F, 1.0F, 1.0F}));
}

TEST_F(WindowGpuGuiPass, AtlasesMayBeExchanged) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    const auto text = [&]() -> const ImDrawData& {
        return interface.frame([](ImDrawList& list) { list.AddText({4, 4}, IM_COL32_WHITE, "Aa"); });
    };
    draw(text());
    ImFontConfig large;
    large.SizePixels = 31;
    atlas.Clear();
    atlas.AddFontDefault(&large);
    must(pass.upload_fonts(atlas));
    const ImDrawData& data = text();
    expect_as_drawn_by_the_cpu(draw(data), data, codes_of_text());
}

class WindowGpuSrgbTarget : public test::GuiPassTest {
  protected:
    WindowGpuSrgbTarget() : GuiPassTest(VK_FORMAT_R8G8B8A8_SRGB) {}
};

TEST_F(WindowGpuSrgbTarget, GetsTheSameColors) {
    const ImDrawData& data = interface.frame([](ImDrawList& list) {
        list.AddRectFilled({0, 0}, {96, 64}, IM_COL32(200, 40, 20, 255));
        for (int i = 0; i < 32; ++i) {
            const auto left = static_cast<float>(i * 3);
            list.AddRectFilled({left, 8}, {left + 3, 40}, IM_COL32(i * 8, 255 - i * 8, i, 255));
        }
    });
    expect_as_drawn_by_the_cpu(draw(data), data, 1);
}

}  // namespace
}  // namespace darkroom::window
