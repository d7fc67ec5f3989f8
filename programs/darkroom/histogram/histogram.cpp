// SPDX-License-Identifier: MIT
// darkroom histogram: how light is spread over a frame, in stops from middle grey.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/text/param_text.hpp"
#include "core/try.hpp"
#include "image/frame/frame_file.hpp"
#include "image/frame/layer_file.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/run/json.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace {

using darkroom::FrameFile;

constexpr double middle_grey = 0.18;
constexpr std::array percents{1, 5, 25, 50, 75, 95, 99};

/// Luminances of the pixels, Rec. 709.
struct Light {
    std::vector<double> above_zero;  ///< sorted
    std::uint64_t pixels = 0, black = 0, above_white = 0, transparent = 0;
    std::uint64_t nan = 0, infinite = 0;  ///< in a channel of the file; they count nowhere else
};

/// What each pixel of the file's colour is, in the file; empty: all are finite.
darkroom::Result<std::vector<bool>> not_finite(const std::string& path, const FrameFile& frame, Light& light) {
    if (frame.counts.nan_color + frame.counts.infinite_color == 0) return std::vector<bool>();
    DARKROOM_TRY_VALUE(darkroom::LayerFile file, darkroom::LayerFile::open(path));
    DARKROOM_TRY_VALUE(const darkroom::FileLayer layer, file.find("color"));
    DARKROOM_TRY_VALUE(const darkroom::LayerSamples samples, file.read(layer));
    // Grey, or red, green and blue; alpha is the last of two or four.
    const std::size_t channels = samples.channels, colors = channels < 3 ? 1 : 3;
    std::vector<bool> out(frame.color.pixels.size() / 4);
    for (std::size_t pixel = 0; pixel < out.size(); ++pixel) {
        const std::span<const float> color(&samples.values[pixel * channels], colors);
        out[pixel] = !std::ranges::all_of(color, [](float value) { return std::isfinite(value); });
        if (out[pixel])
            ++(std::ranges::any_of(color, [](float v) { return std::isnan(v); }) ? light.nan : light.infinite);
    }
    return out;
}

darkroom::Result<Light> light_of(const std::string& path, const FrameFile& frame) {
    Light out;
    DARKROOM_TRY_VALUE(const std::vector<bool> is_no_light, not_finite(path, frame, out));
    const std::vector<float>& numbers = frame.color.pixels;
    out.pixels = numbers.size() / 4;
    for (std::size_t i = 0; i < numbers.size(); i += 4) {
        if (!is_no_light.empty() && is_no_light[i / 4]) continue;
        const double luminance = 0.2126 * numbers[i] + 0.7152 * numbers[i + 1] + 0.0722 * numbers[i + 2];
        if (frame.has_alpha && numbers[i + 3] == 0)
            ++out.transparent;
        else if (luminance <= 0)
            ++out.black;
        else
            out.above_zero.push_back(luminance);
        out.above_white += std::max({numbers[i], numbers[i + 1], numbers[i + 2]}) > 1 ? 1 : 0;
    }
    std::ranges::sort(out.above_zero);
    return out;
}

double stops_of(double luminance) { return std::log2(luminance / middle_grey); }

/// Of all that is above black: the value below which so many percent lie.
double percentile(const Light& light, int percent) {
    const std::size_t last = light.above_zero.size() - 1;
    return light.above_zero[last * static_cast<std::size_t>(percent) / 100];
}

/// Pixels by whole stops, from that of the darkest to that of the brightest.
std::vector<std::pair<int, std::uint64_t>> bins_of(const Light& light) {
    std::vector<std::pair<int, std::uint64_t>> out;
    for (const double luminance : light.above_zero) {
        const int stop = static_cast<int>(std::floor(stops_of(luminance)));
        while (out.empty() || out.back().first < stop) out.emplace_back(out.empty() ? stop : out.back().first + 1, 0);
        ++out.back().second;
    }
    return out;
}

Json document_of(const std::string& path, const FrameFile& frame, const Light& light) {
    Json out{{"file", path},
             {"width", frame.color.width},
             {"height", frame.color.height},
             {"black", light.black},
             {"above_white", light.above_white},
             {"nan", light.nan},
             {"infinite", light.infinite},
             {"transparent", light.transparent},
             {"stops", Json::array()},
             {"percentiles", Json::object()}};
    for (const auto& [stop, count] : bins_of(light)) out["stops"].push_back(Json{{"from", stop}, {"pixels", count}});
    if (light.above_zero.empty()) return out;
    for (const int percent : percents)
        out["percentiles"][std::to_string(percent)] = json_number(percentile(light, percent));
    out["brightest"] = json_number(light.above_zero.back());
    return out;
}

void tell_of(const std::string& path, const FrameFile& frame, const Light& light) {
    const auto share = [&](std::uint64_t count) {
        return 100.0 * static_cast<double>(count) / static_cast<double>(std::max<std::uint64_t>(light.pixels, 1));
    };
    answer(fmt::format("{}: {}x{}; stops from middle grey (0.18), share of the pixels", darkroom::printable(path),
                       frame.color.width, frame.color.height));
    auto bins = bins_of(light);
    std::ranges::reverse(bins);
    for (const auto& [stop, count] : bins)
        answer(fmt::format("{:>+5} {:>6.2f} % {}", stop, share(count),
                           std::string(static_cast<std::size_t>(std::ceil(share(count))), '#')));
    for (const auto& [count, name] :
         {std::pair(light.black, "black or below"), std::pair(light.above_white, "above white (1.0) in a channel"),
          std::pair(light.nan, "NaN in a channel, and counted nowhere else"),
          std::pair(light.infinite, "infinite in a channel, and counted nowhere else"),
          std::pair(light.transparent, "wholly transparent")})
        if (count != 0) answer(fmt::format("{:>13.2f} % {}", share(count), name));
    if (light.above_zero.empty()) return;
    std::string line = "percentiles:";
    for (const int percent : percents)
        line += fmt::format(" {} % {:+.1f}", percent, stops_of(percentile(light, percent)));
    answer(fmt::format("{}; brightest {:.4g} ({:+.1f})", line, light.above_zero.back(),
                       stops_of(light.above_zero.back())));
}

int run(const std::vector<std::string>& paths, bool is_json) {
    Json all = Json::array();
    for (const std::string& path : paths) {
        const darkroom::Result<FrameFile> frame = darkroom::read_frame(path, {.has_shadow_depths = false});
        if (!frame) return fail(frame.error());
        for (const std::string& warning : frame->warnings)
            warn(fmt::format("{}: {}", darkroom::printable(path), warning));
        const darkroom::Result<Light> light = light_of(path, *frame);
        if (!light) return fail(light.error());
        if (is_json)
            all.push_back(document_of(path, *frame, *light));
        else
            tell_of(path, *frame, *light);
    }
    if (is_json) answer((paths.size() > 1 ? all : all.elements().front()).dump(2));
    return exit_ok;
}

}  // namespace

CommandRow histogram_command() {
    return {.names = {"histogram"}, .place = 55, .add = [](const CommandHost& host) {
                const CommandFlags command = host.program.add_command(
                    "histogram", "Tells how light is spread over frames and pictures, in stops");
                command.examples(
                    "darkroom histogram frame.exr\n"
                    "darkroom histogram reference.png changed.png\n"
                    "darkroom histogram frame.exr --json");
                const auto inputs = std::make_shared<std::vector<std::string>>();
                const auto is_json = std::make_shared<bool>();
                command.add_option("INPUT", *inputs, "Frames or pictures; code values are decoded to light")
                    .type_name("FILE")
                    .required();
                command.add_flag("--json", *is_json, "For programs: a document, or an array of them for several files");
                return std::vector<Command>{{command, [=] { return run(*inputs, *is_json); }}};
            }};
}

}  // namespace app
