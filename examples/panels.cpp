// SPDX-License-Identifier: MIT
// Darkroom's panels in a host's own Dear ImGui, over the host's own Composer. The host keeps its window, its backend
// and its frame loop; the panels change a document, and the Composer follows it. Here nobody looks and a made-up mouse
// drags a slider, so that no display is needed.

#include <imgui.h>

#include <cstdio>
#include <darkroom/darkroom.hpp>
#include <darkroom/look.hpp>

#include "edit/document.hpp"
#include "panels/panels.hpp"
#include "panels/widgets/theme.hpp"

namespace {

int fail(const darkroom::Error& error) {
    std::fprintf(stderr, "panels: %s\n", error.text.c_str());
    return error.fault == darkroom::Fault::User ? 1 : 2;
}

}  // namespace

int main() {
    // A host adopts its own device, and records the Composer into its frames.
    darkroom::Composer composer(darkroom::Device::assumed());
    darkroom::edit::LookDocument document;  // or LookDocument::open("film.toml", {})
    if (const auto done = darkroom::apply(document.look(), composer); !done) return fail(done.error());
    darkroom::Look followed = document.look();
    darkroom::Result<darkroom::Plan> plan = composer.plan({.max_extent = {1920, 1080}});
    if (!plan) return fail(plan.error());

    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {1280, 720};
    darkroom::panels::apply_theme(1);
    io.Fonts->Build();
    darkroom::panels::LookPanels panels(document);
    panels.select("exposure");
    const darkroom::panels::WidgetPlaces& places = panels.places();

    for (int frame = 0; frame < 20; ++frame) {
        // What a backend does: the mouse goes to the slider, is pressed, goes to the right, and is released.
        if (const auto slider = places.find("exposure.exposure"); slider != places.end()) {
            io.MousePos = {slider->second.least.x + 8.0f * static_cast<float>(frame), slider->second.center().y};
            io.MouseDown[0] = frame > 5 && frame < 15;
        }
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({340, 360});
        ImGui::Begin("Stack");
        panels.draw_stack();
        ImGui::End();
        ImGui::SetNextWindowPos({0, 360});
        ImGui::SetNextWindowSize({340, 360});
        ImGui::Begin("Parameters");
        panels.draw_entry();
        ImGui::End();
        ImGui::SetNextWindowPos({940, 0});
        ImGui::SetNextWindowSize({340, 720});
        ImGui::Begin("Plan");
        panels.set_plan(&*plan);
        panels.draw_plan();
        ImGui::End();
        panels.draw_popups();
        ImGui::Render();  // and a backend draws it

        const auto done = darkroom::follow(followed, document.look(), composer);
        if (!done) return fail(done.error());
        if (done->needs_compile) plan = composer.plan({.max_extent = {1920, 1080}});  // a host: compile_later
        followed = document.look();
    }
    ImGui::DestroyContext();

    const darkroom::Handle exposure = composer.find("exposure").value();
    const float value = std::bit_cast<float>(composer.words(exposure)[0]);
    std::printf("%s: the Composer has %g\n", std::string(document.undo_name()).c_str(), static_cast<double>(value));
    return document.can_undo() && value != darkroom::Exposure{}.exposure ? 0 : 1;
}
