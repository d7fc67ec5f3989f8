// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <string>

#include "panels/panel_state.hpp"
#include "panels/widgets/icons.hpp"

namespace darkroom::panels {

namespace {

std::string bytes_text(std::uint64_t bytes) {
    return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1024.0 * 1024.0));
}

/// Names of fused kernels get places for line breaks.
std::string breakable(const std::string& name) {
    std::string out;
    for (const char letter : name) out += letter == '+' ? " + " : std::string(1, letter);
    return out;
}

void draw_pass(const PlanPass& pass, std::size_t number) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%zu", number);
    ImGui::TableNextColumn();
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(breakable(pass.name).c_str());
    ImGui::PopTextWrapPos();
    tooltip(fmt::format("{}\nHolds: {} ({})\n{} read, {} written", pass.boundary, fmt::join(pass.entries, ", "),
                        pass.stage, bytes_text(pass.bytes_read), bytes_text(pass.bytes_written))
                .c_str());
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%ux%u", pass.extent.width, pass.extent.height);
}

void draw_sentences(const char* heading, const std::vector<std::string>& sentences) {
    if (sentences.empty()) return;
    ImGui::Spacing();
    ImGui::TextDisabled("%s", heading);
    ImGui::PushTextWrapPos(0);
    for (const std::string& sentence : sentences) ImGui::TextUnformatted(sentence.c_str());
    ImGui::PopTextWrapPos();
}

}  // namespace

void draw_plan_panel(const Plan* plan, bool is_compiling) {
    if (plan == nullptr) {
        ImGui::TextDisabled("%s", is_compiling ? "Compiling..." : "There is no plan yet.");
        return;
    }
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(fmt::format("{} pass{}, {} of images{}", plan->passes.size(),
                                       plan->passes.size() == 1 ? "" : "es", bytes_text(plan->transient_bytes),
                                       is_compiling ? ", compiling..." : "")
                               .c_str());
    ImGui::PopTextWrapPos();
    tooltip(fmt::format("Without sharing memory they would take {}. A frame reads {} and writes {}.",
                        bytes_text(plan->transient_bytes_unaliased), bytes_text(plan->bytes_read()),
                        bytes_text(plan->bytes_written()))
                .c_str());
    if (ImGui::BeginTable("passes", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit)) {
        ImGui::TableSetupColumn("number");
        ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch);
        ImGui::TableSetupColumn("extent");
        for (std::size_t i = 0; i < plan->passes.size(); ++i) draw_pass(plan->passes[i], i + 1);
        ImGui::EndTable();
    }
    draw_sentences("Left out", plan->left_out);
    draw_sentences("Remarks", plan->remarks);
}

}  // namespace darkroom::panels
