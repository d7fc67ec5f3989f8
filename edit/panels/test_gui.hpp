// SPDX-License-Identifier: MIT
#pragma once
// Dear ImGui without a window, for tests: frames of a given size, a mouse and a keyboard that tests move.

#include <gtest/gtest.h>
#include <imgui.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "image/picture/write.hpp"
#include "panels/test_rasteriser.hpp"
#include "panels/widgets/imgui_versions.hpp"
#include "panels/widgets/theme.hpp"

namespace darkroom::panels {

class TestGui {
  public:
    TestGui(float width, float height, float scale) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.LogFilename = nullptr;
        io.DisplaySize = {width, height};
        io.DeltaTime = 1.0f / 60;
        io.MousePos = {-1, -1};
        io.ConfigInputTextCursorBlink = false;
        io.SetClipboardTextFn = [](void* user, const char* text) { *static_cast<std::string*>(user) = text; };
        io.GetClipboardTextFn = [](void* user) { return static_cast<std::string*>(user)->c_str(); };
        io.ClipboardUserData = &clipboard;
        use_own_keys();
        apply_theme(scale);
        unsigned char* pixels = nullptr;
        int atlas_width = 0, atlas_height = 0;
        io.Fonts->GetTexDataAsAlpha8(&pixels, &atlas_width, &atlas_height);
    }
    TestGui(const TestGui&) = delete;
    TestGui& operator=(const TestGui&) = delete;
    ~TestGui() { ImGui::DestroyContext(); }

    /// What a frame draws.
    std::function<void()> draw;
    std::string clipboard;

    void frame(int count = 1) {
        for (int i = 0; i < count; ++i) {
            ImGui::NewFrame();
            draw();
            ImGui::Render();
        }
    }
    void move(ImVec2 place) {
        ImGui::GetIO().MousePos = place;
        frame();
    }
    void press(int button = 0) {
        ImGui::GetIO().MouseDown[button] = true;
        frame();
    }
    void release(int button = 0) {
        ImGui::GetIO().MouseDown[button] = false;
        frame(2);
    }
    /// Alone: not the second half of a double click.
    void click(ImVec2 place, int button = 0) {
        wait();
        double_click_half(place, button);
    }
    void double_click(ImVec2 place) {
        click(place);
        double_click_half(place, 0);
    }
    void drag(ImVec2 from, ImVec2 to, int steps = 8) {
        wait();
        move(from);
        press();
        for (int i = 1; i <= steps; ++i) {
            const float part = static_cast<float>(i) / static_cast<float>(steps);
            move({from.x + (to.x - from.x) * part, from.y + (to.y - from.y) * part});
        }
        release();
    }
    void key(ImGuiKey key) {
        send_key(key, true);
        frame();
        send_key(key, false);
        frame();
    }
    void type(std::string_view text) {
        for (const char letter : text) {
            ImGui::GetIO().AddInputCharacter(static_cast<unsigned char>(letter));
            frame();
        }
    }
    void control(bool is_down) { send_control(is_down); }
    void alt(bool is_down) { send_alt(is_down); }
    /// Long enough for tooltips, and for a click to be the first.
    void wait() { frame(40); }

    [[nodiscard]] GuiPicture picture() const { return GuiRasteriser(surround_color).draw(*ImGui::GetDrawData()); }
    /// For people: where DARKROOM_SHOW names a folder, what is seen becomes a PNG in it.
    void show(const std::string& name) const {
        const char* const folder = std::getenv("DARKROOM_SHOW");
        if (folder == nullptr) return;
        const GuiPicture shown = picture();
        const auto ok =
            write_bytes(std::filesystem::path(folder) / (name + ".png"), static_cast<std::uint32_t>(shown.width),
                        static_cast<std::uint32_t>(shown.height), shown.rgba);
        EXPECT_TRUE(ok) << ok.error().text;
    }

  private:
    void double_click_half(ImVec2 place, int button) {
        move(place);
        press(button);
        release(button);
    }
};

}  // namespace darkroom::panels
