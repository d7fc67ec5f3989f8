// SPDX-License-Identifier: MIT
#include "verifier/verify_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace app {

using darkroom::verify::Difference;
using darkroom::verify::Finding;
using darkroom::verify::Report;
using darkroom::verify::Subject;

namespace {

std::string version_of(std::uint32_t version) {
    return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                       VK_API_VERSION_PATCH(version));
}

Json json_of(const Finding& finding) {
    constexpr std::array channels{"red", "green", "blue", "alpha"};
    const darkroom::verify::Form& form = finding.form;
    Json out{
        {"kind", name_of(finding.kind)}, {"subject", finding.subject.name},
        {"kernels", finding.kernels},    {"stage", form.stage == darkroom::KernelStage::Compute ? "compute" : "raster"},
        {"lean", form.is_lean},          {"size", {form.extent.width, form.extent.height}},
        {"text", text_of(finding)}};
    if (finding.kind == Finding::Kind::Failed) {
        out["error"] = finding.error;
        return out;
    }
    const Difference& worst = finding.worst;
    out.update(Json{{"pixel", {worst.x, worst.y}},
                    {"channel", channels[worst.channel]},
                    {"value", json_number(worst.value)},
                    {"expected", json_number(worst.expected)},
                    {"allowed", json_number(worst.allowed)},
                    {"pixels", worst.pixels}});
    if (finding.kind != Finding::Kind::Reference) return out;
    out["smallest"] = Json{{"size", {finding.smallest_extent.width, finding.smallest_extent.height}},
                           {"look", darkroom::write_look(look_of(finding.smallest))}};
    return out;
}

/// The effects of findings, each once, in the order they were found.
std::vector<std::string> names_of(const std::vector<Finding>& findings) {
    std::vector<std::string> out;
    for (const Finding& finding : findings) {
        std::string name = finding.subject.name.substr(0, finding.subject.name.find('['));
        if (std::ranges::find(out, name) == out.end()) out.push_back(std::move(name));
    }
    return out;
}

}  // namespace

Json json_of(const Report& report) {
    Json traits = Json::object();
    for (const auto& [name, value] : report.traits) traits[name] = value;
    Json findings = Json::array();
    for (const Finding& finding : report.findings) findings.push_back(json_of(finding));
    return Json{{"device", Json{{"name", report.device.name},
                                {"driver", report.device.driver},
                                {"vulkan", version_of(report.device.api_version)},
                                {"software", report.device.is_software},
                                {"traits", traits}}},
                {"seed", report.seed},
                {"kernels", report.kernels},
                {"pictures", report.pictures},
                {"seconds", report.seconds},
                {"unchanged", report.unchanged},
                {"not_tried", report.not_tried},
                {"findings", findings}};
}

std::string summary_of(const Report& report) {
    const std::string tried =
        fmt::format("{} | {} | Vulkan {}\n{} kernels, {} pictures, {:.1f} s", report.device.name, report.device.driver,
                    version_of(report.device.api_version), report.kernels, report.pictures, report.seconds);
    const std::string left = report.not_tried.empty() ? "" : fmt::format("; not tried: {}", report.not_tried.size());
    if (report.findings.empty()) return fmt::format("{}{}: as the references say", tried, left);
    return fmt::format("{}{}: {} findings, in {}", tried, left, report.findings.size(),
                       fmt::join(names_of(report.findings), ", "));
}

darkroom::Look look_of(const Subject& subject) {
    darkroom::Look out{.is_flat = false};
    for (const darkroom::verify::Step& step : subject.steps) {
        darkroom::LookEntry& entry = out.entries.emplace_back(darkroom::LookEntry{.effect = step.info});
        entry.words = step.words;
        entry.is_of_ui = step.info->flat.ui == darkroom::UiPart::Layer;
        if (step.info->has_second() && !step.info->joins_ui()) entry.second = "alpha";
        for (const darkroom::ParamInfo& row : step.info->parameters.rows) {
            if (row.kind != darkroom::Kind::Resource) continue;
            entry.resources.push_back({std::string(row.name), row.is_picture ? "picture.exr" : "table.cube", nullptr});
            entry.words[row.word] = static_cast<std::uint32_t>(entry.resources.size());
        }
    }
    return out;
}

}  // namespace app
