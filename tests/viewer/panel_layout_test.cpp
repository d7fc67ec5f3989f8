// SPDX-License-Identifier: MIT
// Where the panels of edit lie in windows of any size, and the lines between them.
#include "viewer/panels/panel_layout.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace app {
namespace {

bool is_there(const VkRect2D& area) { return area.extent.width > 0; }
int right(const VkRect2D& area) { return area.offset.x + static_cast<int>(area.extent.width); }
int bottom(const VkRect2D& area) { return area.offset.y + static_cast<int>(area.extent.height); }
bool overlap(const VkRect2D& a, const VkRect2D& b) {
    return a.offset.x < right(b) && b.offset.x < right(a) && a.offset.y < bottom(b) && b.offset.y < bottom(a);
}
std::vector<VkRect2D> all(const PanelAreas& areas) {
    std::vector<VkRect2D> out;
    for (const VkRect2D& area : {areas.bar, areas.stack, areas.entry, areas.view_bar, areas.picture, areas.timeline,
                                 areas.below, areas.status})
        if (is_there(area)) out.push_back(area);
    for (const VkRect2D& area : areas.splitters)
        if (is_there(area)) out.push_back(area);
    return out;
}

struct Shown {
    VkExtent2D window;
    float scale;
};
constexpr Shown usual[]{{{1280, 720}, 1}, {{1600, 900}, 1}, {{1920, 1080}, 1}, {{2560, 1440}, 2}, {{1600, 900}, 2}};

TEST(PanelLayout, PanelsFillTheWindowAndDoNotOverlap) {
    for (const auto& [window, scale] : usual)
        for (int chosen = 0; chosen < 32; ++chosen) {
            const PanelSizes sizes{.has_stack = (chosen & 1) != 0,
                                   .has_entry = (chosen & 2) != 0,
                                   .has_below = (chosen & 4) != 0,
                                   .has_status = (chosen & 8) != 0};
            const std::vector<VkRect2D> areas =
                all(lay_out(sizes, {.window = window, .scale = scale, .has_timeline = (chosen & 16) != 0}));
            std::uint64_t pixels = 0;
            for (std::size_t i = 0; i < areas.size(); ++i) {
                pixels += std::uint64_t{areas[i].extent.width} * areas[i].extent.height;
                EXPECT_GE(areas[i].offset.x, 0);
                EXPECT_LE(right(areas[i]), static_cast<int>(window.width));
                EXPECT_LE(bottom(areas[i]), static_cast<int>(window.height));
                for (std::size_t j = i + 1; j < areas.size(); ++j)
                    EXPECT_FALSE(overlap(areas[i], areas[j])) << window.width << " " << scale << ", " << chosen;
            }
            EXPECT_EQ(pixels, std::uint64_t{window.width} * window.height) << window.width << ", " << chosen;
        }
}

TEST(PanelLayout, ThePictureKeepsRoom) {
    for (const auto& [window, scale] : usual) {
        const PanelAreas areas = lay_out({}, {.window = window, .scale = scale});
        EXPECT_GE(areas.picture.extent.width, window.width / 4) << window.width << " " << scale;
        EXPECT_GE(areas.picture.extent.height, window.height / 4) << window.height << " " << scale;
        EXPECT_GE(static_cast<float>(areas.stack.extent.width), 270 * scale);
        EXPECT_GE(static_cast<float>(areas.entry.extent.width), 270 * scale);
    }
}

TEST(PanelLayout, AnyWindowHasAreas) {
    for (const std::uint32_t width : {64U, 300U, 1280U, 7680U})
        for (const std::uint32_t height : {64U, 200U, 4320U})
            for (const float scale : {0.5F, 1.0F, 3.0F})
                for (const VkRect2D& area :
                     all(lay_out({.stack = 5000, .entry = 5000, .below = 5000},
                                 {.window = {width, height}, .scale = scale, .has_timeline = true, .view_rows = 3})))
                    EXPECT_TRUE(area.extent.width <= width && area.extent.height >= 1) << width << "x" << height;
}

TEST(PanelLayout, ALineGoesWhereTheMouseIs) {
    for (const auto& [window, scale] : usual) {
        const PanelRoom room{.window = window, .scale = scale};
        for (std::size_t i = 0; i < splitter_count; ++i) {
            const VkRect2D before = lay_out({}, room).splitters[i];
            if (!is_there(before)) continue;
            const auto which = static_cast<Splitter>(i);
            const bool is_upright = which == Splitter::Stack || which == Splitter::Entry;
            const float by = (which == Splitter::Entry ? -40 : 40) * scale;
            const auto x = static_cast<float>(before.offset.x) + (is_upright ? by : 0);
            const auto y = static_cast<float>(before.offset.y) + (is_upright ? 0 : by);
            const PanelSizes sizes = moved({}, which, x, y, room);
            const VkRect2D after = lay_out(sizes, room).splitters[i];
            EXPECT_NEAR(static_cast<float>(after.offset.x), x, 6 * scale) << i << ", " << window.width;
            EXPECT_NEAR(static_cast<float>(after.offset.y), y, 6 * scale) << i << ", " << window.width;
            EXPECT_EQ(put_back(sizes, which), PanelSizes{});
        }
    }
}

TEST(PanelLayout, OverThePictureItHasTheWholeWindow) {
    const PanelAreas areas = lay_out({}, {.window = {1920, 1080}, .is_over = true});
    EXPECT_EQ(areas.picture.extent.width, 1920U);
    EXPECT_EQ(areas.picture.extent.height, 1080U);
    EXPECT_EQ(areas.stack.extent.width, 296U);
}

}  // namespace
}  // namespace app
