// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

#include "core/text/param_text.hpp"
#include "develop/inspect/inspector.hpp"
#include "image/picture/resize.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/device_flags.hpp"
#include "programs/darkroom/flags/flags.hpp"
#include "programs/darkroom/flags/frame_flags.hpp"
#include "programs/darkroom/flags/look_flags.hpp"
#include "programs/darkroom/flags/ocio_flags.hpp"
#include "programs/darkroom/run/frames.hpp"
#include "programs/darkroom/run/json.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"
#include "programs/darkroom/run/ui_source.hpp"

namespace app {

namespace {

using darkroom::InspectedEntry;
using darkroom::InspectedPixel;
using darkroom::PixelValue;
using darkroom::Result;
using darkroom::user_error;

struct Options {
    LookFlags look;
    DeviceFlags device;
    FrameFlags frame;
    OcioFlags ocio;
    std::string input, size;
    std::vector<std::string> at;
    NumberFlag time{"--time", {.least = 0, .most = 1e9, .unit = "s"}};
    bool is_json = false;
};

/// A pixel with all that is known of it.
struct Probed {
    InspectedPixel pixel;
    std::array<std::uint8_t, 4> codes{};  ///< of the picture that develop makes
    std::optional<darkroom::NonFiniteBirth> birth;
};

struct Report {
    VkExtent2D extent{};
    double time = 0;
    std::uint64_t frame_index = 0;
    std::vector<Probed> pixels;
};

Result<VkOffset2D> parse_place(const std::string& text) {
    VkOffset2D out{};
    const char* const end = text.data() + text.size();
    const auto x = std::from_chars(text.data(), end, out.x);
    const bool has_comma = x.ec == std::errc() && x.ptr != end && *x.ptr == ',';
    const auto y = has_comma ? std::from_chars(x.ptr + 1, end, out.y) : x;
    if (has_comma && y.ec == std::errc() && y.ptr == end) return out;
    return user_error(
        fmt::format("--at: '{}' is not a pixel, allowed is X,Y: two whole numbers", darkroom::printable(text)));
}

Result<std::vector<VkOffset2D>> places(const Options& options, VkExtent2D extent) {
    std::vector<VkOffset2D> out;
    for (const std::string& text : options.at) {
        DARKROOM_TRY_VALUE(const VkOffset2D place, parse_place(text));
        const auto is_in = [](std::int32_t at, std::uint32_t size) {
            return at >= 0 && static_cast<std::uint32_t>(at) < size;
        };
        if (!is_in(place.x, extent.width) || !is_in(place.y, extent.height))
            return user_error(fmt::format("--at {},{}: the picture is {}x{}, allowed is 0,0 to {},{}", place.x, place.y,
                                          extent.width, extent.height, extent.width - 1, extent.height - 1));
        out.push_back(place);
    }
    return out;
}

bool is_all_finite(const InspectedPixel& pixel) {
    return darkroom::is_finite(pixel.scene) && std::ranges::all_of(pixel.entries, [](const InspectedEntry& entry) {
               return darkroom::is_finite(entry.after);
           });
}

class Probe {
  public:
    explicit Probe(const Options& options) : options_(options) {}

    Result<Report> run() {
        DARKROOM_TRY(read());
        DARKROOM_TRY_VALUE(const std::vector<VkOffset2D> at, places(options_, input_.extent));
        DARKROOM_TRY(make_composer());
        const std::size_t most = darkroom::Prober::max_pixels(*composer_);
        if (at.size() > most)
            return user_error(fmt::format("--at: {} pixels of a stack of {} entries: allowed are at most {}", at.size(),
                                          composer_->size(), most));
        // The picture as develop makes it, with its own kernels and rounding: what is in its file.
        darkroom::Developer developer(*device_, develop_);
        DARKROOM_TRY_VALUE(const darkroom::DevelopedPicture picture, developer.develop(*composer_, input_));
        warn_of_what_is_left_out(look_, *composer_, composer_->current_plan()->left_out);
        darkroom::Prober prober(*device_, develop_, static_cast<std::uint32_t>(at.size()));
        DARKROOM_TRY_VALUE(darkroom::Inspection seen, prober.probe(*composer_, input_, at));
        Report out{.extent = input_.extent, .time = input_.time, .frame_index = input_.frame_index, .pixels = {}};
        for (InspectedPixel& pixel : seen.pixels) {
            Probed& made = out.pixels.emplace_back(Probed{.pixel = std::move(pixel), .codes = {}, .birth = {}});
            const std::size_t first = (static_cast<std::size_t>(made.pixel.at.y) * input_.extent.width +
                                       static_cast<std::size_t>(made.pixel.at.x)) *
                                      made.codes.size();
            std::copy_n(picture.bytes.begin() + static_cast<std::ptrdiff_t>(first), made.codes.size(),
                        made.codes.begin());
            if (is_all_finite(made.pixel)) continue;
            DARKROOM_TRY_VALUE(made.birth, prober.find_birth(*composer_, input_, made.pixel.at));
        }
        return out;
    }

    [[nodiscard]] int exit_code(int code) const { return device_ ? finish(*device_, code) : code; }

  private:
    /// The look and the frame, as develop reads them.
    Result<> read() {
        DARKROOM_TRY_VALUE(look_, options_.look.look_of_frames());
        if (!options_.look.events.empty()) {
            DARKROOM_TRY_VALUE(timeline_, Timeline::read(options_.look.events, look_));
        }
        DARKROOM_TRY(options_.ocio.check(options_.frame.has_input_space()));
        const std::vector<std::string> eyes = options_.frame.eyes();
        if (eyes.size() > 1) return user_error("--eye both: allowed is one view at a time");
        DARKROOM_TRY_VALUE(darkroom::FrameOptions frame,
                           options_.frame.options(options_.ocio.configuration, eyes.front()));
        DARKROOM_TRY(add_needs(look_, input_.delta_time, timeline_, frame));
        frame.keeps_halves = true;
        const long long number = darkroom::frame_number(options_.input).value_or(1);
        DARKROOM_TRY_VALUE(darkroom::FrameFile file, read_frame({options_.input, number}, frame));
        darkroom::NewSize new_size{file.color.width, file.color.height};
        if (!options_.size.empty()) {
            DARKROOM_TRY_VALUE(new_size, parse_new_size(options_.size));
        }
        DARKROOM_TRY_VALUE(file_, darkroom::resize(std::move(file), new_size));
        const std::string shown = darkroom::printable(options_.input);
        for (const std::string& warning : file_.warnings) warn(fmt::format("{}: {}", shown, warning));
        tell_of_assumed_view(file_, shown);
        lights_ = take_lights(file_);
        input_ = develop_input(file_, lights_);
        if (!file_.frame_index) input_.frame_index = static_cast<std::uint64_t>(std::max(0LL, number));
        return options_.time.read_to(input_.time);
    }

    Result<> make_composer() {
        DARKROOM_TRY_VALUE(const darkroom::KernelStage stage, options_.device.stage());
        develop_ = {.kernels = stage, .fuse = options_.device.is_fused()};
        DARKROOM_TRY_VALUE(darkroom::Device device, options_.device.create());
        device_ = std::make_unique<darkroom::Device>(std::move(device));
        DARKROOM_TRY(darkroom::check_extent(*device_, input_.extent));
        composer_ = std::make_unique<darkroom::Composer>(*device_, darkroom::ComposerDesc{.frames_in_flight = 1});
        DARKROOM_TRY(darkroom::apply(look_, *composer_, {.keeps = timeline_.entries()}));
        DARKROOM_TRY(timeline_.advance(*composer_, input_.time));
        UiSource ui(look_, timeline_);
        DARKROOM_TRY(ui.advance(*composer_, input_.time));
        DARKROOM_TRY_VALUE(ui_, ui.picture(input_.extent));
        input_.ui = *ui_;
        return {};
    }

    const Options& options_;
    darkroom::Look look_;
    Timeline timeline_;
    darkroom::FrameFile file_;
    std::vector<darkroom::ReferenceLight> lights_;
    std::shared_ptr<const std::vector<std::uint8_t>> ui_;
    darkroom::DevelopInput input_;
    darkroom::DevelopDesc develop_;
    std::unique_ptr<darkroom::Device> device_;
    std::unique_ptr<darkroom::Composer> composer_;
};

std::string_view name_of(darkroom::Domain domain) {
    switch (domain) {
        case darkroom::Domain::SceneLinear:
            return "scene_linear";
        case darkroom::Domain::DisplayLinear:
            return "display_linear";
        case darkroom::Domain::Encoded:
            return "encoded";
    }
    return "";
}

std::string_view name_of(darkroom::EntryPresence presence) {
    switch (presence) {
        case darkroom::EntryPresence::On:
            return "on";
        case darkroom::EntryPresence::Off:
            return "off";
        case darkroom::EntryPresence::LeftOut:
            return "left out";
    }
    return "";
}

/// Where the first value that is not finite comes from, in a sentence.
std::string sentence(const Probed& probed) {
    const auto& entries = probed.pixel.entries;
    if (!probed.birth) return "";
    const darkroom::NonFiniteBirth& birth = *probed.birth;
    const std::string where =
        fmt::format("{},{} ({} pixel{})", birth.at.x, birth.at.y, birth.pixels, birth.pixels == 1 ? "" : "s");
    if (!birth.entry) return fmt::format("not finite in the scene, nearest at {}", where);
    std::string out = fmt::format("not finite first behind {}, nearest at {}", entries[*birth.entry].name, where);
    if (probed.pixel.born && *probed.pixel.born != *birth.entry)
        out += fmt::format("; {} brought it here", entries[*probed.pixel.born].name);
    return out;
}

using Row = std::array<std::string, 9>;

/// A NaN has no sign that means anything.
std::string shown(float value) { return std::isnan(value) ? "nan" : fmt::format("{:.6g}", value); }

Row row_of(const InspectedEntry& entry) {
    Row row{entry.name, entry.effect == entry.name ? "" : entry.effect};
    for (std::size_t c = 0; c < 4; ++c) row[c + 2] = shown(entry.after[c]);
    if (entry.presence != darkroom::EntryPresence::On) {
        row[8] = fmt::format("{}: {}", name_of(entry.presence), entry.why);
        return row;
    }
    row[6] = entry.before ? fmt::format("{:.3g}", entry.change) : "";
    row[7] = entry.before ? fmt::format("{:.3g} %", 100 * entry.relative_change) : "";
    row[8] = fmt::format("{}{}{}", name_of(entry.domain), entry.is_ui ? ", interface" : "",
                         entry.has_neighbours ? ", reads around" : "");
    return row;
}

std::string text_of(const Probed& probed) {
    std::vector<Row> rows{{"entry", "effect", "red", "green", "blue", "alpha", "change", "of it", ""}};
    Row& scene = rows.emplace_back(Row{"scene"});
    for (std::size_t c = 0; c < 4; ++c) scene[c + 2] = shown(probed.pixel.scene[c]);
    scene[8] = "scene_linear";
    for (const InspectedEntry& entry : probed.pixel.entries) rows.push_back(row_of(entry));
    Row& codes = rows.emplace_back(Row{"picture"});
    for (std::size_t c = 0; c < 4; ++c) codes[c + 2] = fmt::to_string(probed.codes[c]);
    codes[8] = "codes of 8 bits";
    if (std::all_of(rows.begin() + 1, rows.end(), [](const Row& row) { return row[1].empty(); })) rows[0][1].clear();
    std::array<std::size_t, 9> widths{};
    for (const Row& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string out = fmt::format("pixel {},{}\n", probed.pixel.at.x, probed.pixel.at.y);
    for (const Row& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (widths[i] == 0) continue;
            line += i < 2 || i == 8 ? fmt::format("  {:<{}}", row[i], widths[i])
                                    : fmt::format("  {:>{}}", row[i], widths[i]);
        }
        out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    if (const std::string found = sentence(probed); !found.empty()) out += fmt::format("  {}\n", found);
    return out;
}

Json json_of(const PixelValue& value) {
    Json out = Json::array();
    for (const float channel : value) out.push_back(json_number(double{channel}));
    return out;
}

Json json_of(const InspectedEntry& entry) {
    Json out{{"name", entry.name},
             {"effect", entry.effect},
             {"presence", name_of(entry.presence)},
             {"is_ui", entry.is_ui},
             {"reads_around", entry.has_neighbours},
             {"domain", name_of(entry.domain)},
             {"after", json_of(entry.after)}};
    if (!entry.why.empty()) out["why"] = entry.why;
    if (!entry.before) return out;
    out["input"] = entry.input;
    out["before"] = json_of(*entry.before);
    out["change"] = json_number(entry.change);
    out["relative_change"] = json_number(entry.relative_change);
    return out;
}

Json json_of(const Probed& probed) {
    const auto& entries = probed.pixel.entries;
    Json list = Json::array();
    for (const InspectedEntry& entry : entries) list.push_back(json_of(entry));
    Json out{{"x", probed.pixel.at.x},
             {"y", probed.pixel.at.y},
             {"scene", json_of(probed.pixel.scene)},
             {"entries", std::move(list)},
             {"codes", probed.codes}};
    if (probed.pixel.born) out["not_finite_since"] = entries[*probed.pixel.born].name;
    if (probed.birth)
        out["first_not_finite"] = {{"entry", probed.birth->entry ? entries[*probed.birth->entry].name : "scene"},
                                   {"x", probed.birth->at.x},
                                   {"y", probed.birth->at.y},
                                   {"pixels", probed.birth->pixels}};
    return out;
}

std::string json_of(const Options& options, const Report& report) {
    Json pixels = Json::array();
    for (const Probed& probed : report.pixels) pixels.push_back(json_of(probed));
    return Json{{"frame", darkroom::printable(options.input)},
                {"width", report.extent.width},
                {"height", report.extent.height},
                {"time", report.time},
                {"frame_index", report.frame_index},
                {"pixels", std::move(pixels)}}
        .dump(2);
}

int run(const Options& options) {
    Probe probe(options);
    const Result<Report> report = probe.run();
    if (!report) return probe.exit_code(fail(report.error()));
    if (options.is_json) {
        fmt::print("{}\n", json_of(options, *report));
    } else {
        fmt::print("{}: {}x{}\n", darkroom::printable(options.input), report->extent.width, report->extent.height);
        for (const Probed& probed : report->pixels) fmt::print("{}", text_of(probed));
    }
    return probe.exit_code(exit_ok);
}

}  // namespace

static Command add_probe(CommandFlags program, std::span<const darkroom::LookEntry> named) {
    const CommandFlags command =
        program.add_command("probe", "Tells what every effect of a look makes of pixels of a frame");
    const auto options = std::make_shared<Options>();
    command.examples(
        "darkroom probe frame.exr --at 12,4\n"
        "darkroom probe frame.exr --look my.toml --at 12,4 --at 3,3\n"
        "darkroom probe frame.exr --at 12,4 --json");
    command.add_option("FRAME", options->input, "A frame, as develop reads it").required();
    command.add_option("--at", options->at, "A pixel of the picture, from its top left corner; may stand several times")
        .type_name("X,Y")
        .repeated()
        .required();
    command.add_flag("--json", options->is_json, "For programs");
    command.add_option("--size", options->size, "As of develop").type_name("WxH[:fit|fill|stretch]");
    options->time.add_to(command, "Time for effects that move; default: the frame's, or 0").type_name("S");
    options->frame.add_to(command);
    options->ocio.add_to(command, false);
    options->device.add_to(command);
    options->look.add_to(command, true, named);
    return {command, [options] { return run(*options); }};
}

CommandRow probe_command() {
    return {.names = {"probe"}, .place = 90, .add = [](const CommandHost& host) {
                return std::vector{add_probe(host.program, host.named)};
            }};
}

}  // namespace app
