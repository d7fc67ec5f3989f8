// SPDX-License-Identifier: MIT
#include "capture_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/composer.hpp>

#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "programs/darkroom/flags/run_flags.hpp"
#include "programs/darkroom/run/jitter.hpp"

namespace app {

using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

namespace {

constexpr std::size_t max_scales = 8;
constexpr double max_scale = 10;
/// Colour and the colour before transparency in halves, depth and motion in floats, normals and mask in halves.
constexpr std::uint64_t bytes_a_pixel = 8 + 6 + 4 + 8 + 6 + 2;
constexpr std::uintmax_t max_description_bytes = 1 << 20;

Json size_of(VkExtent2D extent) { return Json{extent.width, extent.height}; }

darkroom::Failure bad_scales(const std::string& text) {
    return user_error(fmt::format("--scales {}: allowed are 1 to {} numbers in [1, {:g}], each once, with commas",
                                  printable(text), max_scales, max_scale));
}

}  // namespace

std::uint64_t CaptureJob::bytes() const {
    const auto pixels = [](VkExtent2D extent) { return std::uint64_t{extent.width} * extent.height; };
    std::uint64_t out = truth_frames.size() * pixels(desc.extent) * bytes_a_pixel;
    for (const CaptureScale& scale : scales) out += frames.size() * pixels(scale.extent) * bytes_a_pixel;
    return out;
}

Result<std::vector<CaptureScale>> parse_scales(const std::string& text, VkExtent2D extent) {
    std::vector<CaptureScale> out;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(',', start), text.size());
        const std::optional<double> number = darkroom::parse_number(text.substr(start, end - start));
        const bool is_new = number && std::ranges::find(out, *number, &CaptureScale::scale) == out.end();
        if (!is_new || !(*number >= 1 && *number <= max_scale) || out.size() == max_scales) return bad_scales(text);
        CaptureScale& scale = out.emplace_back(CaptureScale{.scale = *number, .folder = fmt::format("{:g}x", *number)});
        scale.extent = scaled(extent, 1 / *number);
        scale.exact = static_cast<float>(extent.height) / static_cast<float>(scale.extent.height);
        start = end + 1;
    }
    return out;
}

Json describe(const CaptureJob& job, std::string_view scene_file) {
    Json inputs = Json::array();
    for (const CaptureScale& scale : job.scales)
        inputs.push_back(Json{{"scale", scale.scale},
                              {"size", size_of(scale.extent)},
                              {"mip_bias", double{darkroom::Composer::mip_bias(scale.exact)}},
                              {"files", scale.files()}});
    return {{"format", 1},
            {"scene", printable(scene_file)},
            {"size", size_of(job.desc.extent)},
            {"frames_per_second", job.frames_per_second},
            {"seed", job.seed},
            {"frames", darkroom::frame_set_text(job.frames)},
            {"inputs", std::move(inputs)},
            {"truth", Json{{"files", CaptureJob::truth_files()},
                           {"frames", darkroom::frame_set_text(job.truth_frames)},
                           {"samples", job.desc.positions},
                           {"mean", job.desc.is_mean_weighed ? "tone_mapped" : "linear"}}}};
}

Result<CapturedTruth> read_capture(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / capture_description;
    DARKROOM_TRY_VALUE(const auto bytes, darkroom::read_file(file, {.max_size = max_description_bytes}));
    const std::optional<Json> json = Json::parse({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    const auto refused = [&](std::string_view what) {
        return user_error(fmt::format("{}: {}", printable(file.string()), what));
    };
    if (!json || !json->is_object()) return refused("is not a description of a capture: a JSON object is needed");
    const Json* const format = json->find("format");
    if (format == nullptr || !format->is_whole() || format->whole() != 1) return refused("format: allowed is 1");
    const Json* const truth = json->find("truth");
    if (truth == nullptr || !truth->is_object()) return refused("truth: an object is needed");
    CapturedTruth out{.folder = folder};
    const Json *const files = truth->find("files"), *const frames = truth->find("frames");
    if (files == nullptr || !files->is_text() || frames == nullptr || !frames->is_text())
        return refused("truth: files and frames are needed, both texts");
    const std::filesystem::path named = files->text();
    if (named.is_absolute() || std::ranges::find(named, std::filesystem::path("..")) != named.end())
        return refused(fmt::format("truth.files {}: allowed is a name within the folder", printable(files->text())));
    out.files = files->text();
    const Result<darkroom::FrameSet> set = parse_frames(frames->text());
    if (!set) return refused(fmt::format("truth.frames: {}", set.error().text));
    out.frames = set->numbers();
    return out;
}

}  // namespace app
