// SPDX-License-Identifier: MIT
#pragma once
// For tests only: Dear ImGui without a window, drawn by GuiPass on a picture of 96 x 64 pixels.

#include <gtest/gtest.h>
#include <imgui.h>

#include "gpu/test_run.hpp"
#include "window/gui_pass.hpp"

namespace darkroom::window::test {

using gpu::test::must;
using gpu::test::Picture;
using gpu::test::Pixels;

/// Dear ImGui without a window.
class Interface {
  public:
    explicit Interface(VkExtent2D extent) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {static_cast<float>(extent.width), static_cast<float>(extent.height)};
        io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
        ImGui::GetStyle().AntiAliasedLines = ImGui::GetStyle().AntiAliasedFill = false;
    }
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;
    ~Interface() { ImGui::DestroyContext(); }

    /// What `draw` adds to the list behind all windows.
    template <class Draw>
    const ImDrawData& frame(Draw draw) {
        ImGui::GetIO().Fonts->Build();
        ImGui::NewFrame();
        draw(*ImGui::GetBackgroundDrawList());
        ImGui::Render();
        return *ImGui::GetDrawData();
    }
};

/// Not half way between two codes, where a device may take either.
inline constexpr std::array<float, 4> background{0.25, 0.4F, 0.125, 1};

class GuiPassTest : public ::testing::Test {
  protected:
    static constexpr VkExtent2D extent{96, 64};

    explicit GuiPassTest(VkFormat format = VK_FORMAT_R8G8B8A8_UNORM, const ColorState& color = srgb_color)
        : target(gpu::test::blank(context, extent, format)),
          pass(must(GuiPass::create(context, {.format = format, .color = color}, *ImGui::GetIO().Fonts))) {}

    void record(VkCommandBuffer commands, const Picture& onto, const ImDrawData& data, std::uint32_t slot) {
        const VkRenderingAttachmentInfo color{
            .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
            .imageView = onto.image.view,
            .imageLayout = VK_IMAGE_LAYOUT_GENERAL,
            .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
            .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
            .clearValue = {.color = {.float32 = {background[0], background[1], background[2], background[3]}}}};
        const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                   .renderArea = {{0, 0}, extent},
                                   .layerCount = 1,
                                   .colorAttachmentCount = 1,
                                   .pColorAttachments = &color};
        context.vk.CmdBeginRendering(commands, &info);
        result = pass.record(commands, data, slot);
        context.vk.CmdEndRendering(commands);
    }
    Pixels draw(const ImDrawData& data, std::uint32_t slot = 0) {
        must(gpu::submit_and_wait(context, "drawing the interface",
                                  [&](VkCommandBuffer commands) { record(commands, target, data, slot); }));
        return gpu::test::download(context, target);
    }

    Interface interface { extent };
    gpu::Context& context = gpu::test::context();
    Picture target;
    GuiPass pass;
    Result<> result;
};

}  // namespace darkroom::window::test
