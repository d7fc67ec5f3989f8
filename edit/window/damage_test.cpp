// SPDX-License-Identifier: MIT
#include "window/damage.hpp"

#include <random>

#include "window/test_gui_pass.hpp"
#include "window/texture_address.hpp"

namespace darkroom::window {
namespace {

using test::must;
using test::Pixels;

bool covers(const std::vector<VkRect2D>& parts, std::int32_t x, std::int32_t y) {
    return std::ranges::any_of(parts, [&](const VkRect2D& part) {
        return x >= part.offset.x && x < part.offset.x + static_cast<std::int32_t>(part.extent.width) &&
               y >= part.offset.y && y < part.offset.y + static_cast<std::int32_t>(part.extent.height);
    });
}

TEST(WindowDamage, IsWhatHasChanged) {
    test::Interface interface({400, 300});
    Damage damage;
    const auto taken = [&](float value, bool has_more = false) {
        const ImDrawData& data = interface.frame([&](ImDrawList& list) {
            list.AddRectFilled({10, 10}, {110, 30}, IM_COL32(40, 40, 40, 255));
            list.AddRectFilled({10, 100}, {10 + value, 120}, IM_COL32(200, 40, 40, 255));
            list.AddText({200, 200}, IM_COL32_WHITE, "what stands");
            if (has_more) ImGui::GetForegroundDrawList()->AddRectFilled({300, 20}, {320, 40}, IM_COL32_WHITE);
        });
        return damage.take(data, address_of(ImGui::GetIO().Fonts->TexID));
    };
    std::vector<VkRect2D> parts = taken(50);
    ASSERT_EQ(parts.size(), 1U) << "all of it at first";
    EXPECT_EQ(parts[0].extent.width, 400U);
    EXPECT_EQ(parts[0].extent.height, 300U);
    EXPECT_TRUE(taken(50).empty());
    parts = taken(80);
    EXPECT_TRUE(covers(parts, 89, 110));
    EXPECT_FALSE(covers(parts, 50, 20));
    EXPECT_FALSE(covers(parts, 210, 205));
    parts = taken(80, true);
    EXPECT_TRUE(covers(parts, 310, 30));
    EXPECT_FALSE(covers(parts, 50, 110));
    parts = taken(80);
    EXPECT_TRUE(covers(parts, 310, 30)) << "what is gone";
    ImGui::GetIO().DisplaySize = {200, 300};
    EXPECT_TRUE(covers(taken(80), 199, 299)) << "another size";
}

TEST(WindowDamage, FewPartsCoverAll) {
    std::mt19937 random(2);
    const auto below = [&](std::uint32_t most) { return static_cast<std::uint32_t>(random() % most); };
    for (int run = 0; run < 200; ++run) {
        std::vector<VkRect2D> parts, added;
        for (int i = 0; i < 20; ++i) {
            const VkRect2D part{{static_cast<std::int32_t>(below(90)), static_cast<std::int32_t>(below(90))},
                                {below(9), below(9)}};
            added.push_back(part);
            add_part(parts, part);
            ASSERT_LE(parts.size(), max_damaged_parts);
        }
        for (const auto& [offset, extent] : added)
            for (std::uint32_t y = 0; y < extent.height; ++y)
                for (std::uint32_t x = 0; x < extent.width; ++x)
                    ASSERT_TRUE(covers(parts, offset.x + static_cast<std::int32_t>(x),
                                       offset.y + static_cast<std::int32_t>(y)));
    }
}

class WindowGpuDamage : public test::GuiPassTest {
  protected:
    /// Over what the target has.
    Pixels draw_parts(const ImDrawData& data, const std::vector<VkRect2D>& parts) {
        must(pass.begin(data, 0));
        must(gpu::submit_and_wait(context, "drawing the interface in parts", [&](VkCommandBuffer commands) {
            for (const VkRect2D& part : parts) {
                const VkRenderingAttachmentInfo color{
                    .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                    .imageView = target.image.view,
                    .imageLayout = VK_IMAGE_LAYOUT_GENERAL,
                    .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                    .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                    .clearValue = {.color = {.float32 = {test::background[0], test::background[1], test::background[2],
                                                         test::background[3]}}}};
                const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                           .renderArea = part,
                                           .layerCount = 1,
                                           .colorAttachmentCount = 1,
                                           .pColorAttachments = &color};
                context.vk.CmdBeginRendering(commands, &info);
                must(pass.record_part(commands, data, 0, part));
                context.vk.CmdEndRendering(commands);
            }
        }));
        return gpu::test::download(context, target);
    }
};

// Shapes that come, go, move and change, over and under each other: as if all were drawn anew.
TEST_F(WindowGpuDamage, PartsOverTheFrameBeforeAreTheWholeFrame) {
    struct Shape {
        ImVec2 place, size;
        ImU32 color;
        int kind;
    };
    std::mt19937 random(6);
    const auto below = [&](float most) { return std::uniform_real_distribution(0.0F, most)(random); };
    const auto shape = [&] {
        return Shape{{below(90) - 8, below(60) - 8},
                     {2 + below(40), 2 + below(30)},
                     IM_COL32(random() % 256, random() % 256, random() % 256, 64 + random() % 192),
                     static_cast<int>(random() % 3)};
    };
    std::vector<Shape> shapes;
    for (int i = 0; i < 12; ++i) shapes.push_back(shape());
    Damage damage;
    std::size_t drawn = 0;
    for (int frame = 0; frame < 60; ++frame) {
        const std::size_t at = random() % shapes.size();
        if (frame % 4 == 1) shapes[at] = shape();
        if (frame % 4 == 2 && shapes.size() > 3) shapes.erase(shapes.begin() + static_cast<std::ptrdiff_t>(at));
        if (frame % 4 == 3) shapes.insert(shapes.begin() + static_cast<std::ptrdiff_t>(at), shape());
        const ImDrawData& data = interface.frame([&](ImDrawList& list) {
            for (const auto& [place, size, color, kind] : shapes) {
                const ImVec2 end{place.x + size.x, place.y + size.y};
                if (kind == 0) list.AddRectFilled(place, end, color);
                if (kind == 1) list.AddText(place, color, "Grade 0.5");
                if (kind == 2) {
                    list.PushClipRect(place, end, true);
                    list.AddCircleFilled(place, size.x, color);
                    list.PopClipRect();
                }
            }
        });
        const std::vector<VkRect2D> parts = damage.take(data, address_of(ImGui::GetIO().Fonts->TexID));
        for (const VkRect2D& part : parts) drawn += std::size_t{part.extent.width} * part.extent.height;
        const Pixels by_parts = draw_parts(data, parts);
        const Pixels whole = draw(data);
        ASSERT_TRUE(by_parts.rgba == whole.rgba) << "frame " << frame;
    }
    EXPECT_LT(drawn, std::size_t{60} * extent.width * extent.height / 2) << "and less is drawn";
}

}  // namespace
}  // namespace darkroom::window
