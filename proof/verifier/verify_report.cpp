// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <span>

#include "core/own_file.hpp"
#include "core/text/param_text.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"
#include "verifier/verify_report.hpp"
#include "verify/scene.hpp"

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

namespace fs = std::filesystem;
using darkroom::Picture;
using darkroom::ReferenceImage;
using darkroom::Result;
using darkroom::Rgba;

namespace {

std::string folder_name(const Finding& finding, std::size_t number) {
    std::string out = fmt::format("{:02}_{}_{}_{}", number, finding.subject.name,
                                  finding.form.stage == darkroom::KernelStage::Compute ? "compute" : "raster",
                                  finding.form.is_lean ? "lean" : "complete");
    const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    std::ranges::replace_if(
        out, [&](char c) { return !is_plain(static_cast<unsigned char>(c)); }, '_');
    return out;
}

Picture picture_of(const ReferenceImage& image) {
    Picture out(image.width, image.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Rgba& p = image.pixels[i];
        const std::array all{p.r, p.g, p.b, p.a};
        for (std::size_t c = 0; c < all.size(); ++c) out.pixels[i * 4 + c] = static_cast<float>(all[c]);
    }
    return out;
}

/// Red where the pictures differ, the more the redder, over a dim grey of what was expected.
Picture map_of(const Finding& finding) {
    Picture out(finding.expected.width, finding.expected.height);
    double most = 0;
    const auto apart = [&](std::size_t i) {
        const Rgba &a = finding.made.pixels[i], &b = finding.expected.pixels[i];
        const double d = std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b), std::abs(a.a - b.a)});
        return std::isfinite(d) ? d : 1e9;
    };
    for (std::size_t i = 0; i < finding.made.pixels.size(); ++i) most = std::max(most, apart(i));
    for (std::size_t i = 0; i < finding.made.pixels.size(); ++i) {
        const Rgba& b = finding.expected.pixels[i];
        const double grey = 0.4 * std::sqrt(std::clamp((b.r + b.g + b.b) / 3, 0.0, 1.0));
        const double red = most == 0 ? 0 : std::sqrt(apart(i) / most);
        const std::array all{std::max(grey, red), grey, grey, 1.0};
        for (std::size_t c = 0; c < all.size(); ++c) out.pixels[i * 4 + c] = static_cast<float>(all[c]);
    }
    return out;
}

template <std::uint32_t Channels>
darkroom::Plane<Channels> plane_of(VkExtent2D extent, std::span<const float> values) {
    darkroom::Plane<Channels> out(extent.width, extent.height);
    std::ranges::copy(values, out.values.begin());
    return out;
}

darkroom::FrameFile frame_of(const darkroom::verify::SceneFrame& scene) {
    const darkroom::DevelopInput input = scene.input();
    darkroom::FrameFile out;
    out.color = picture_of(scene.color());
    out.has_alpha = true;
    out.depth = plane_of<1>(input.extent, input.depth);
    out.normals = plane_of<3>(input.extent, input.normals);
    out.velocity = plane_of<2>(input.extent, input.velocity);
    out.reactive = plane_of<1>(input.extent, input.reactive);
    out.transparency = plane_of<3>(input.extent, input.transparency);
    out.camera = {.world_to_camera = input.camera.view,
                  .projection = input.camera.projection,
                  .vertical_field_of_view = {},
                  .previous_world_to_camera = input.camera.previous_view,
                  .previous_projection = input.camera.previous_projection,
                  .jitter = {},
                  .previous_jitter = {},
                  .near_distance = input.camera.near_distance,
                  .far_distance = input.camera.far_distance};
    for (const darkroom::ReferenceLight& light : input.lights) {
        darkroom::FrameLight& made = out.lights.emplace_back();
        made.direction = light.light.direction;
        made.color = light.light.color;
        made.volumetric_intensity = light.light.volumetric_intensity;
        made.volumetric_color = light.light.volumetric_color;
        for (std::size_t i = 0; i < light.cascades.size(); ++i)
            made.cascades.push_back({light.light.world_to_cascade[i], light.light.splits[i],
                                     plane_of<1>({light.resolution, light.resolution}, light.cascades[i])});
    }
    out.time = input.time;
    out.delta_time = input.delta_time;
    out.exposure = input.exposure[0];
    out.frame_index = input.frame_index;
    return out;
}

std::string cube_of(const darkroom::ColorTable& table) {
    std::string out = fmt::format("LUT_3D_SIZE {}\n", table.size);
    for (std::size_t i = 0; i < table.cube.size(); i += 3)
        out += fmt::format("{} {} {}\n", table.cube[i], table.cube[i + 1], table.cube[i + 2]);
    return out;
}

const darkroom::WriteOptions as_report{.follows_links = false};

Result<> write_text(const fs::path& path, const std::string& text) {
    return darkroom::write_own_file(path, std::as_bytes(std::span(text)), darkroom::FileOwner::Anyone);
}

/// The tables and pictures that the look names.
Result<> write_resources(const fs::path& folder, const Subject& subject) {
    for (const darkroom::verify::Step& step : subject.steps)
        for (const darkroom::ParamInfo& row : step.info->parameters.rows) {
            if (row.kind != darkroom::Kind::Resource) continue;
            const darkroom::verify::Brought brought;
            const darkroom::ResourceImage& image = brought.picture;
            Picture picture(image.width, image.height);
            picture.pixels = image.rgba;
            DARKROOM_TRY(row.is_picture ? darkroom::write_picture(folder / "picture.exr", picture, as_report)
                                        : write_text(folder / "table.cube", cube_of(brought.table)));
        }
    return {};
}

Result<> write_smallest(const fs::path& folder, const Finding& finding) {
    if (finding.smallest.steps.empty()) return {};
    DARKROOM_TRY(write_text(folder / "look.toml", darkroom::write_look(look_of(finding.smallest))));
    DARKROOM_TRY(write_resources(folder, finding.smallest));
    for (std::uint32_t number = 0; number < darkroom::verify::frame_count; ++number) {
        const darkroom::verify::SceneFrame scene(finding.smallest_extent, number);
        DARKROOM_TRY(darkroom::write_frame(folder / fmt::format("frame.{:04}.exr", number), frame_of(scene)));
    }
    return {};
}

Result<> write_finding(const fs::path& folder, const Finding& finding) {
    DARKROOM_TRY(darkroom::make_own_folder(folder));
    if (finding.made.pixels.empty()) return {};
    const darkroom::WriteOptions whole{.samples = darkroom::SampleKind::Float, .alpha = true, .follows_links = false};
    DARKROOM_TRY(darkroom::write_picture(folder / "made.exr", picture_of(finding.made), whole));
    DARKROOM_TRY(darkroom::write_picture(folder / "expected.exr", picture_of(finding.expected), whole));
    DARKROOM_TRY(darkroom::write_picture(folder / "difference.png", map_of(finding), as_report));
    return write_smallest(folder, finding);
}

}  // namespace

Result<> write_findings(const fs::path& folder, const darkroom::verify::Report& report) {
    for (std::size_t i = 0; i < report.findings.size(); ++i) {
        const Finding& finding = report.findings[i];
        DARKROOM_TRY(write_finding(folder / folder_name(finding, i + 1), finding));
    }
    return write_text(folder / report_name, json_of(report).dump(2) + "\n");
}

}  // namespace app
