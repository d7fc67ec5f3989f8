// SPDX-License-Identifier: MIT
#include "panels/show/scopes.hpp"

#include <gtest/gtest.h>

#include "panels/test_gui.hpp"

namespace darkroom::panels {
namespace {

/// A landscape of sorts: a bright sky over a dark ground, and something red.
ScopeData landscape() {
    constexpr std::uint32_t width = 240, height = 135;
    std::vector<float> floats;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const float u = static_cast<float>(x) / width, v = static_cast<float>(y) / height;
            const float grain = static_cast<float>((x * 131 + y * 57 + x * y * 3) % 97) / 97 * 0.08f;
            const float sky = 0.55f + 0.4f * v + 0.15f * std::sin(u * 5) + grain;
            const float ground = 0.12f + 0.12f * std::sin(u * 40) * v + grain;
            const bool is_sky = v < 0.5f + 0.08f * std::sin(u * 9);
            const bool is_red = std::hypot(u - 0.7f, v - 0.6f) < 0.1f;
            std::array<float, 4> color{is_sky ? sky * 0.8f : ground * 1.1f, is_sky ? sky * 0.95f : ground,
                                       is_sky ? sky * 1.1f : ground * 0.7f, 1};
            if (is_red) color = {0.75f + grain, 0.2f + grain, 0.15f, 1};
            floats.insert(floats.end(), color.begin(), color.end());
        }
    return measure({.width = width, .height = height, .floats = floats});
}

/// The brightest of a channel in a column of the picture, between two rows.
int brightest(const GuiPicture& picture, int x, int top, int bottom, int channel) {
    int most = 0;
    for (int y = top; y < bottom; ++y) most = std::max<int>(most, picture.at(x, y)[channel]);
    return most;
}

/// In a window that fills the screen, without a border.
void in_window(const std::function<void()>& draw) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(size);
    ImGui::Begin("scopes", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize);
    draw();
    ImGui::End();
}

TEST(PanelScopes, HistogramsStandWhereTheirCodesAre) {
    TestGui gui(532, 220, 1);
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < 64; ++i) bytes.insert(bytes.end(), {64, 128, 192, 255});
    const ScopeData data = measure({.width = 64, .height = 1, .bytes = bytes});
    // Two pixels a bin, behind a padding of ten.
    gui.draw = [&] { in_window([&] { draw_histogram(data, false, {512, 200}); }); };
    gui.frame(2);
    const GuiPicture picture = gui.picture();
    const auto peak = [&](int code, int channel) { return brightest(picture, 10 + code * 2, 60, 200, channel); };
    EXPECT_GT(peak(64, 0), peak(64, 2) + 60);
    EXPECT_GT(peak(128, 1), peak(128, 0) + 60);
    EXPECT_GT(peak(192, 2), peak(192, 1) + 60);
    EXPECT_LT(peak(100, 0), 60);
}

TEST(PanelScopes, LogarithmsRaiseWhatIsRare) {
    TestGui gui(532, 220, 1);
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < 1000; ++i) {
        const auto code = static_cast<std::uint8_t>(i < 10 ? 200 : 50);
        bytes.insert(bytes.end(), {code, code, code, 255});
    }
    const ScopeData data = measure({.width = 1000, .height = 1, .bytes = bytes});
    const auto height_at = [&](bool is_logarithmic) {
        gui.draw = [&] { in_window([&] { draw_histogram(data, is_logarithmic, {512, 200}); }); };
        gui.frame(2);
        const GuiPicture picture = gui.picture();
        int rows = 0;
        for (int y = 10; y < 205; ++y) rows += picture.at(10 + 400, y)[1] > 60 ? 1 : 0;
        return rows;
    };
    EXPECT_LT(height_at(false), 6);
    EXPECT_GT(height_at(true), 50);
}

TEST(PanelScopes, WaveformsStandWhereTheirLevelsAre) {
    TestGui gui(500, 222, 1);
    std::vector<float> floats;
    for (int x = 0; x < 160; ++x) {
        const float level = x < 80 ? 0.25f : 0.75f;
        floats.insert(floats.end(), {level, level, level, 1});
    }
    const ScopeData data = measure({.width = 160, .height = 1, .floats = floats});
    for (const WaveformKind kind : {WaveformKind::Rgb, WaveformKind::Luma, WaveformKind::Parade}) {
        gui.draw = [&] { in_window([&] { draw_waveform(data.waveform, kind, {480, 202}); }); };
        gui.frame(2);
        const GuiPicture picture = gui.picture();
        // Two pixels a level: the one of 0.25 is 51 from the bottom, at 212.
        const int parts = kind == WaveformKind::Parade ? 3 : 1;
        for (int part = 0; part < parts; ++part) {
            const int left = 10 + part * 480 / parts + 40, right = left + 240 / parts;
            const int channel = kind == WaveformKind::Parade ? part : 1;
            EXPECT_GT(brightest(picture, left, 158, 164, channel), 150) << part;
            EXPECT_LT(brightest(picture, left, 54, 60, channel), 60) << part;
            if (kind == WaveformKind::Parade) {
                EXPECT_LT(brightest(picture, left, 158, 164, (part + 1) % 3), 100) << "a channel alone";
            }
            EXPECT_GT(brightest(picture, right, 58, 64, channel), 150) << part;
            EXPECT_LT(brightest(picture, right, 164, 170, channel), 60) << part;
        }
    }
}

TEST(PanelScopes, SaysWhatIsUnderTheMouse) {
    TestGui gui(532, 320, 1);
    const ScopeData data = landscape();
    gui.draw = [&] { in_window([&] { draw_histogram(data, false, {512, 200}); }); };
    gui.frame(2);
    const GuiPicture before = gui.picture();
    gui.move({270, 100});
    gui.frame(2);
    EXPECT_NE(gui.picture().rgba, before.rgba);
    gui.show("histogram_tooltip");
}

TEST(PanelScopes, HasATabForEach) {
    for (const float scale : {1.0f, 2.5f}) {
        TestGui gui(420 * scale, 300 * scale, scale);
        ScopesPanel panel;
        panel.set(landscape());
        gui.draw = [&] { in_window([&] { panel.draw(); }); };
        gui.frame(3);
        std::vector<std::vector<std::uint8_t>> seen;
        for (const float tab : {50.0f, 130.0f, 210.0f, 280.0f}) {
            gui.click({tab * scale, 20 * scale});
            gui.move({-1, -1});
            gui.frame(3);
            gui.show("scopes_" + std::to_string(static_cast<int>(scale * 10)) + "_" +
                     std::to_string(static_cast<int>(tab)));
            seen.push_back(gui.picture().rgba);
            for (std::size_t i = 0; i + 1 < seen.size(); ++i) EXPECT_NE(seen[i], seen.back()) << tab;
            // Few enough to be drawn in every frame.
            EXPECT_LT(ImGui::GetDrawData()->TotalVtxCount, 50'000) << tab;
        }
    }
}

TEST(PanelScopes, NoiseIsNotTooMuchForSmallIndices) {
    TestGui gui(420, 300, 1);
    std::vector<std::uint8_t> bytes(std::size_t{480} * 270 * 4);
    std::mt19937 random(3);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random() % 256);
    const ScopeData data = measure({.width = 480, .height = 270, .bytes = bytes});
    for (const WaveformKind kind : {WaveformKind::Rgb, WaveformKind::Luma, WaveformKind::Parade}) {
        gui.draw = [&] { in_window([&] { draw_waveform(data.waveform, kind, {400, 200}); }); };
        gui.frame(2);
        EXPECT_LT(ImGui::GetDrawData()->TotalVtxCount, 50'000);
    }
    gui.draw = [&] { in_window([&] { draw_vectorscope(data.vectorscope, 200); }); };
    gui.frame(2);
    EXPECT_LT(ImGui::GetDrawData()->TotalVtxCount, 50'000);
}

TEST(PanelScopes, LegendsNameEveryBand) {
    TestGui gui(300, 420, 1);
    gui.draw = [&] { in_window([&] { draw_legend(stop_bands); }); };
    gui.frame(2);
    gui.show("legend");
    const GuiPicture picture = gui.picture();
    for (const FalseColorBand& band : stop_bands) {
        bool is_found = false;
        for (int y = 0; y < picture.height && !is_found; ++y) {
            const std::uint8_t* const pixel = picture.at(20, y);
            is_found = true;
            for (int i = 0; i < 3; ++i) is_found &= std::abs(pixel[i] / 255.0f - band.color[i]) < 0.01f;
        }
        EXPECT_TRUE(is_found) << band.name;
    }
}

TEST(PanelScopes, NothingMeasuredYetIsAnEmptyPlot) {
    TestGui gui(420, 300, 1);
    ScopesPanel panel;
    gui.draw = [&] { in_window([&] { panel.draw(); }); };
    gui.frame(2);
    gui.draw = [&] {
        in_window([&] {
            draw_waveform({}, WaveformKind::Parade, {100, 50});
            draw_vectorscope({}, 100);
        });
    };
    gui.frame(2);
}

}  // namespace
}  // namespace darkroom::panels
