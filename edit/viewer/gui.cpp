// SPDX-License-Identifier: MIT
#include "gui.hpp"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <utility>

#include "gpu/device/context.hpp"
#include "panels/widgets/imgui_versions.hpp"
#include "panels/widgets/theme.hpp"
#include "window/texture_address.hpp"

namespace app {

using darkroom::Result;

namespace {

/// As many images as swapchains have, and more than frames under way.
constexpr std::size_t max_changed = 6;

}  // namespace

Result<std::unique_ptr<Gui>> Gui::create(darkroom::gpu::Context& context, darkroom::window::Window& window,
                                         const darkroom::window::GuiPass::Desc& desc) {
    std::unique_ptr<Gui> out(new Gui(context, window));
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // where panels lie follows from the window's size
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    out->is_attached_ = ImGui_ImplGlfw_InitForOther(window.handle(), true);
    out->scale_ = window.scale();
    darkroom::panels::apply_theme(out->scale_);
    DARKROOM_TRY_VALUE(darkroom::window::GuiPass pass, darkroom::window::GuiPass::create(context, desc, *io.Fonts));
    out->pass_.emplace(std::move(pass));
    return out;
}

Gui::~Gui() {
    if (is_attached_) ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

// Without a queue a key that went down and up since the last frame would never have been pressed, and its Ctrl would be
// that of the end of the frame, for the text that was typed then, too: such text is for the next frame.
void Gui::hold_short_presses() {
    if (darkroom::panels::has_key_queue) return;
    for (const int key : held_)
        if (!window_.is_down(key)) darkroom::panels::set_backend_key(key, false);
    held_.clear();
    bool is_shortcut = false;
    for (const darkroom::window::KeyPress& press : window_.pressed()) {
        if (darkroom::panels::set_backend_key(press.key, true)) held_.push_back(press.key);
        is_shortcut |= (press.modifiers & GLFW_MOD_CONTROL) != 0;
    }
    darkroom::panels::send_control(is_shortcut || window_.is_down(GLFW_KEY_LEFT_CONTROL) ||
                                   window_.is_down(GLFW_KEY_RIGHT_CONTROL));
    ImVector<ImWchar>& typed = ImGui::GetIO().InputQueueCharacters;
    std::vector<unsigned> now = std::exchange(later_, {});
    std::vector<unsigned>& these = is_shortcut ? later_ : now;
    these.insert(these.end(), typed.begin(), typed.end());
    typed.resize(0);
    for (const unsigned character : now) ImGui::GetIO().AddInputCharacter(character);
}

Result<> Gui::begin(float scale) {
    if (scale != scale_) {
        scale_ = scale;
        darkroom::panels::apply_theme(scale);
        DARKROOM_TRY(pass_->upload_fonts(*ImGui::GetIO().Fonts));
        damage_ = {};
    }
    ImGui_ImplGlfw_NewFrame();
    hold_short_presses();
    ImGui::NewFrame();
    return {};
}

std::vector<VkRect2D> Gui::parts_of(const darkroom::window::PresentFrame& frame, const ImDrawData& lists) {
    changed_.push_back({frame.number, damage_.take(lists, darkroom::window::address_of(ImGui::GetIO().Fonts->TexID))});
    if (changed_.size() > max_changed) changed_.pop_front();
    // One that was begun and not drawn leaves a gap.
    if (frame.age == 0 || frame.age > changed_.size() ||
        changed_[changed_.size() - frame.age].frame != frame.number + 1 - frame.age)
        return {{{0, 0}, frame.extent}};
    std::vector<VkRect2D> out;
    for (std::size_t i = changed_.size() - frame.age; i < changed_.size(); ++i)
        for (const VkRect2D& part : changed_[i].parts) darkroom::window::add_part(out, part);
    return out;
}

Result<> Gui::draw(const darkroom::window::PresentFrame& frame) {
    has_popup_ = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    ImGui::Render();
    ImDrawData* const lists = ImGui::GetDrawData();
    const auto width = static_cast<std::uint32_t>(lists->DisplaySize.x * lists->FramebufferScale.x);
    const auto height = static_cast<std::uint32_t>(lists->DisplaySize.y * lists->FramebufferScale.y);
    // The window may have changed between its events and the swapchain.
    const bool fits = width == frame.extent.width && height == frame.extent.height;
    std::vector<VkRect2D> parts{{{0, 0}, frame.extent}};
    if (fits)
        parts = parts_of(frame, *lists);
    else
        damage_ = {};
    DARKROOM_TRY(pass_->begin(*lists, frame.slot));
    for (const VkRect2D& part : parts) {
        const VkRenderingAttachmentInfo attachment{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                                   .imageView = frame.view,
                                                   .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                                   .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                   .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                   .clearValue = {.color = {.float32 = {0.0F, 0.0F, 0.0F, 1.0F}}}};
        const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                        .renderArea = part,
                                        .layerCount = 1,
                                        .colorAttachmentCount = 1,
                                        .pColorAttachments = &attachment};
        context_.vk.CmdBeginRendering(frame.commands, &rendering);
        const Result<> done = fits ? pass_->record_part(frame.commands, *lists, frame.slot, part) : Result<>();
        context_.vk.CmdEndRendering(frame.commands);
        if (!done) return done;
    }
    return {};
}

bool Gui::wants_keys() const { return ImGui::GetIO().WantTextInput; }
bool Gui::has_typed(unsigned character) const {
    const ImGuiIO& io = ImGui::GetIO();
    return !io.WantTextInput && io.InputQueueCharacters.contains(static_cast<ImWchar>(character));
}

bool Gui::wants_mouse() const { return ImGui::GetIO().WantCaptureMouse; }

}  // namespace app
