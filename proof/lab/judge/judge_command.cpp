// SPDX-License-Identifier: MIT
// darkroom_lab judge: how far the pictures of a temporal filter are from the truth of a capture.
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "core/own_file.hpp"
#include "core/srgb.hpp"
#include "core/text/markup.hpp"
#include "core/text/param_text.hpp"
#include "image/compare/compare.hpp"
#include "image/frame/sequence.hpp"
#include "image/picture/write.hpp"
#include "lab/capture/capture.hpp"
#include "lab/judge/judge.hpp"
#include "lab/lab.hpp"
#include "programs/darkroom/flags/run_flags.hpp"
#include "programs/darkroom/run/json.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

using darkroom::ErrorSum;
using darkroom::JudgedRegion;
using darkroom::printable;

namespace {

/// What is said: as lines, as JSON, and as a web page with the pictures beside it.
struct Judgement {
    std::string truth, test;  ///< folders
    darkroom::Verdict verdict;
    std::uint32_t width = 0, height = 0;
    struct Edge {
        darkroom::EdgeSharpness truth, test;
    };
    std::optional<Edge> edge;
};

/// NaN: nothing lies there.
Json psnr_of(const ErrorSum& sum) { return sum.samples == 0 ? Json(nullptr) : json_number(sum.psnr()); }

std::string shown(const ErrorSum& sum) { return sum.samples == 0 ? "-" : fmt::format("{:.2f}", sum.psnr()); }

double share(const ErrorSum& part, const ErrorSum& whole) {
    return static_cast<double>(part.samples) / static_cast<double>(std::max<std::uint64_t>(whole.samples, 1));
}

/// Text of a page, whatever folders are called.
std::string on_page(std::string_view text) { return darkroom::escaped(printable(text)); }

struct Row {
    std::string name, psnr, flicker, share;
};

std::vector<Row> rows_of(const darkroom::Verdict& verdict) {
    std::vector<Row> rows{{"all", shown(verdict.error), shown(verdict.flicker), "100 %"}};
    for (std::size_t r = 0; r < darkroom::judged_region_count; ++r)
        rows.push_back({std::string(name_of(static_cast<JudgedRegion>(r))), shown(verdict.regions[r]),
                        shown(verdict.region_flicker[r]),
                        fmt::format("{:.2f} %", 100 * share(verdict.regions[r], verdict.error))});
    return rows;
}

constexpr std::string_view page_start = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Judgement</title><style>
body { font: 15px/1.5 sans-serif; background: #16181c; color: #ddd; margin: 2em; }
table { border-collapse: collapse; margin: 1em 0; } td, th { padding: .2em 1em; text-align: right; }
td:first-child, th:first-child { text-align: left; } tr + tr { border-top: 1px solid #333; }
label { display: inline-block; width: 7em; } input[type=range] { width: 30em; vertical-align: middle; }
#stage { position: relative; display: inline-block; overflow: hidden; line-height: 0; }
#stage img { image-rendering: pixelated; transform-origin: 0 0; }
#over { position: absolute; inset: 0; }
</style></head><body>
)";

constexpr std::string_view page_script = R"(<script>
const at = id => document.getElementById(id);
function show() {
    const number = frames[at("frame").value], text = String(number).padStart(4, "0"), zoom = at("zoom").value;
    const kind = at("what").value;
    at("under").src = `truth.${text}.png`;
    at("top").src = `${kind}.${text}.png`;
    at("number").textContent = number;
    at("over").style.clipPath = `inset(0 0 0 ${at("split").value}%)`;
    for (const image of [at("under"), at("top")]) image.style.width = size[0] * zoom + "px";
}
for (const id of ["frame", "split", "zoom", "what"]) at(id).addEventListener("input", show);
let timer = 0;
at("play").addEventListener("click", () => {
    if (timer) { clearInterval(timer); timer = 0; return; }
    timer = setInterval(() => { at("frame").value = (Number(at("frame").value) + 1) % frames.length; show(); }, 1000 / 12);
});
show();
</script></body></html>
)";

/// Pictures of a frame, beside the page.
std::string picture_name(std::string_view kind, long long number) { return fmt::format("{}.{:04}.png", kind, number); }

std::string text_of(const Judgement& judgement) {
    const darkroom::Verdict& verdict = judgement.verdict;
    std::string out = fmt::format("frames     {}\nFLIP mean  {:.4f}\n", verdict.frames.size(), verdict.flip_mean);
    out += fmt::format("{:<16} {:>9} {:>11} {:>9}\n", "", "PSNR dB", "flicker dB", "pixels");
    for (const Row& row : rows_of(verdict))
        out += fmt::format("{:<16} {:>9} {:>11} {:>9}\n", row.name, row.psnr, row.flicker, row.share);
    out += "recovery, dB by frames since a disocclusion:";
    for (const ErrorSum& sum : verdict.recovery) out += " " + shown(sum);
    out += "\n";
    if (judgement.edge)
        out += fmt::format("edge MTF50, cycles a pixel: {:.3f}, of the truth {:.3f}\n", judgement.edge->test.mtf50,
                           judgement.edge->truth.mtf50);
    return out;
}

Json json_of(const Judgement& judgement) {
    const darkroom::Verdict& verdict = judgement.verdict;
    Json regions = Json::object();
    for (std::size_t r = 0; r < darkroom::judged_region_count; ++r)
        regions[name_of(static_cast<JudgedRegion>(r))] = {{"psnr", psnr_of(verdict.regions[r])},
                                                          {"flicker", psnr_of(verdict.region_flicker[r])},
                                                          {"share", share(verdict.regions[r], verdict.error)}};
    Json recovery = Json::array(), frames = Json::array();
    for (const ErrorSum& sum : verdict.recovery) recovery.push_back(psnr_of(sum));
    for (const darkroom::FrameVerdict& frame : verdict.frames)
        frames.push_back(Json{{"number", frame.number}, {"psnr", json_number(frame.psnr)}, {"flip_mean", frame.flip}});
    Json out{{"truth", printable(judgement.truth)},
             {"test", printable(judgement.test)},
             {"size", Json{judgement.width, judgement.height}},
             {"psnr", psnr_of(verdict.error)},
             {"flicker", psnr_of(verdict.flicker)},
             {"flip_mean", verdict.flip_mean},
             {"regions", std::move(regions)},
             {"recovery", std::move(recovery)},
             {"edge", nullptr},
             {"frames", std::move(frames)}};
    if (judgement.edge)
        out["edge"] = {{"mtf50", judgement.edge->test.mtf50},
                       {"truth_mtf50", judgement.edge->truth.mtf50},
                       {"angle_degrees", judgement.edge->truth.angle_degrees}};
    return out;
}

/// A page that needs nothing but the pictures truth.####.png, test.####.png and error.####.png of these frames.
std::string page_of(const Judgement& judgement) {
    const darkroom::Verdict& verdict = judgement.verdict;
    std::string out(page_start);
    out += fmt::format("<h1>{}</h1><p>against {}; mean FLIP {:.4f}</p>\n", on_page(judgement.test),
                       on_page(judgement.truth), verdict.flip_mean);
    out += "<table><tr><th></th><th>PSNR, dB</th><th>flicker, dB</th><th>pixels</th></tr>\n";
    for (const Row& row : rows_of(verdict))
        out += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", row.name, row.psnr, row.flicker,
                           row.share);
    out += "</table>\n<table><tr><th>frames since a disocclusion</th>";
    for (std::size_t i = 0; i < verdict.recovery.size(); ++i) out += fmt::format("<th>{}</th>", i);
    out += "</tr><tr><td>PSNR, dB</td>";
    for (const ErrorSum& sum : verdict.recovery) out += fmt::format("<td>{}</td>", shown(sum));
    out += "</tr></table>\n";
    if (judgement.edge)
        out += fmt::format("<p>Edge MTF50: {:.3f} cycles a pixel, of the truth {:.3f}</p>\n",
                           judgement.edge->test.mtf50, judgement.edge->truth.mtf50);
    out += fmt::format(
        "<p><label>frame <span id=\"number\"></span></label><input id=\"frame\" type=\"range\" min=\"0\" max=\"{}\" "
        "value=\"0\"> <button id=\"play\">play</button></p>\n",
        verdict.frames.size() - 1);
    out +=
        "<p><label>truth | test</label><input id=\"split\" type=\"range\" min=\"0\" max=\"100\" value=\"50\"> <select "
        "id=\"what\"><option value=\"test\">test</option><option value=\"error\">FLIP errors</option></select></p>\n"
        "<p><label>zoom</label><input id=\"zoom\" type=\"range\" min=\"1\" max=\"8\" value=\"1\"></p>\n"
        "<div id=\"stage\"><img id=\"under\" alt=\"truth\"><div id=\"over\"><img id=\"top\" "
        "alt=\"test\"></div></div>\n";
    out += "<script>const frames = [";
    for (const darkroom::FrameVerdict& frame : verdict.frames) out += fmt::format("{},", frame.number);
    out += fmt::format("], size = [{}, {}];</script>\n", judgement.width, judgement.height);
    return out += page_script;
}

namespace fs = std::filesystem;
using darkroom::FrameFile;
using darkroom::Result;
using darkroom::ShownCodes;
using darkroom::user_error;

struct Options {
    std::string truth, test, folder;
    std::optional<std::string> frames, edge;
    bool is_json = false;
};

/// A part of the picture.
struct Window {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

Result<Window> parse_window(const std::string& text) {
    std::array<std::uint32_t, 4> numbers{};
    constexpr std::string_view between = ",,x";
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto [next, error] = std::from_chars(at, end, numbers[i]);
        const bool is_right = i == 3 ? next == end : next != end && *next == between[i];
        if (error != std::errc() || !is_right || (i >= 2 && numbers[i] == 0))
            return user_error(fmt::format("--edge {}: expected X,Y,WIDTHxHEIGHT in pixels", printable(text)));
        at = next + 1;
    }
    return Window{numbers[0], numbers[1], numbers[2], numbers[3]};
}

/// The pictures of a folder by their frame's number.
Result<std::map<long long, fs::path>> pictures_of(const fs::path& folder) {
    std::map<long long, fs::path> out;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        std::error_code ignored;
        const std::optional<long long> number = darkroom::frame_number(entry->path());
        if (!number || !entry->is_regular_file(ignored) || !darkroom::written_format(entry->path())) continue;
        if (const auto [found, is_new] = out.emplace(*number, entry->path()); !is_new)
            return user_error(fmt::format("{}: {} and {} are both frame {}", printable(folder.string()),
                                          printable(found->second.filename().string()),
                                          printable(entry->path().filename().string()), *number));
    }
    if (error)
        return user_error(fmt::format("{}: cannot list the folder: {}", printable(folder.string()), error.message()));
    return out;
}

/// A picture of a display has been mapped by whoever made it.
bool is_of_display(const FrameFile& frame) {
    return frame.samples == darkroom::SampleKind::Integer8 || frame.samples == darkroom::SampleKind::Integer16;
}

Result<ShownCodes> codes_of(const fs::path& path) {
    DARKROOM_TRY_VALUE(const FrameFile frame,
                       darkroom::read_frame(path, {.has_depth = false, .has_normals = false, .has_velocity = false}));
    if (!is_of_display(frame)) return darkroom::codes_of_light(frame.color);
    // Frames are light, whatever the file: sRGB's curve brings back the codes.
    darkroom::Picture encoded = frame.color;
    for (std::size_t i = 0; i < encoded.pixels.size(); ++i)
        if (i % 4 != 3) encoded.pixels[i] = darkroom::srgb_encode(encoded.pixels[i]);
    return darkroom::codes_of_display(encoded);
}

/// What a display shows, before it is encoded: luminance of Rec. 709.
darkroom::Plane<1> luminance_of(const ShownCodes& codes, const Window& window) {
    darkroom::Plane<1> out(window.width, window.height);
    for (std::uint32_t y = 0; y < window.height; ++y)
        for (std::uint32_t x = 0; x < window.width; ++x) {
            const float* const code = codes.at(window.x + x, window.y + y);
            *out.at(x, y) = 0.2126F * darkroom::srgb_decode(code[0] / 255) +
                            0.7152F * darkroom::srgb_decode(code[1] / 255) +
                            0.0722F * darkroom::srgb_decode(code[2] / 255);
        }
    return out;
}

class Judging {
  public:
    explicit Judging(const Options& options) : options_(options) {}

    Result<Judgement> run() {
        DARKROOM_TRY(prepare());
        for (const long long number : numbers_) DARKROOM_TRY(add(number));
        out_.verdict = judge_.verdict();
        if (!options_.folder.empty()) DARKROOM_TRY(write_report());
        return std::move(out_);
    }

  private:
    Result<> prepare() {
        out_.truth = options_.truth;
        out_.test = options_.test;
        DARKROOM_TRY_VALUE(truth_, read_capture(options_.truth));
        DARKROOM_TRY_VALUE(pictures_, pictures_of(options_.test));
        std::optional<darkroom::FrameSet> asked;
        if (options_.frames) {
            DARKROOM_TRY_VALUE(asked, parse_frames(*options_.frames));
        }
        for (const long long number : truth_.frames) {
            if (asked && !asked->contains(number)) continue;
            if (!pictures_.contains(number))
                return user_error(fmt::format("{}: has no picture of frame {}, which the truth has",
                                              printable(options_.test), number));
            numbers_.push_back(number);
        }
        if (numbers_.empty())
            return user_error(fmt::format("--frames {}: the truth has none of them", printable(*options_.frames)));
        if (options_.edge) {
            DARKROOM_TRY_VALUE(edge_, parse_window(*options_.edge));
        }
        if (options_.folder.empty()) return {};
        // A page of an older judgement goes first: what is there is whole, or is not there.
        DARKROOM_TRY(check_folder(options_.folder, MissingFolders::Made));
        std::error_code error;
        for (const char* name : {"index.html", "judge.json"}) fs::remove(fs::path(options_.folder) / name, error);
        return {};
    }

    Result<> add(long long number) {
        const fs::path truth_path = darkroom::numbered(truth_.folder / truth_.files, number);
        DARKROOM_TRY_VALUE(const FrameFile truth, darkroom::read_frame(truth_path, {.has_normals = false}));
        const ShownCodes truth_codes = darkroom::codes_of_light(truth.color);
        const fs::path& test_path = pictures_.at(number);
        DARKROOM_TRY_VALUE(const ShownCodes test_codes, codes_of(test_path));
        if (test_codes.width != truth_codes.width || test_codes.height != truth_codes.height)
            return user_error(fmt::format("{}: is {}x{}, its truth is {}x{}", printable(test_path.string()),
                                          test_codes.width, test_codes.height, truth_codes.width, truth_codes.height));
        const Result<darkroom::RegionMap> map = regions_.find(truth, truth_codes);
        if (!map) return user_error(fmt::format("{}: {}", printable(truth_path.string()), map.error().text));
        DARKROOM_TRY(judge_.add(number, truth_codes, test_codes, *map));
        out_.width = truth_codes.width;
        out_.height = truth_codes.height;
        DARKROOM_TRY(measure_edge(number, truth_codes, test_codes));
        return options_.folder.empty() ? Result<>() : write_pictures(number, truth_codes, test_codes);
    }

    /// Of the last frame, which has the longest history.
    Result<> measure_edge(long long number, const ShownCodes& truth, const ShownCodes& test) {
        if (!edge_ || number != numbers_.back()) return {};
        if (std::uint64_t{edge_->x} + edge_->width > truth.width ||
            std::uint64_t{edge_->y} + edge_->height > truth.height)
            return user_error(fmt::format("--edge {}: reaches beyond the picture of {}x{}", printable(*options_.edge),
                                          truth.width, truth.height));
        const auto sharpness = [&](const ShownCodes& codes, const char* whose) -> Result<darkroom::EdgeSharpness> {
            auto found = darkroom::edge_sharpness(luminance_of(codes, *edge_));
            if (found) return found;
            return user_error(
                fmt::format("--edge {}: of the {}: {}", printable(*options_.edge), whose, found.error().text));
        };
        DARKROOM_TRY_VALUE(const auto of_truth, sharpness(truth, "truth"));
        DARKROOM_TRY_VALUE(const auto of_test, sharpness(test, "test"));
        out_.edge = Judgement::Edge{of_truth, of_test};
        return {};
    }

    Result<> write_pictures(long long number, const ShownCodes& truth, const ShownCodes& test) const {
        const darkroom::Picture a = picture_of(truth), b = picture_of(test);
        DARKROOM_TRY_VALUE(const darkroom::Comparison compared, darkroom::compare(a, b));
        for (const auto& [kind, picture] :
             {std::pair("truth", &a), std::pair("test", &b), std::pair("error", &compared.flip_map)})
            DARKROOM_TRY(darkroom::write_picture(fs::path(options_.folder) / picture_name(kind, number), *picture,
                                                 {.follows_links = false}));
        return {};
    }

    Result<> write_report() const {
        const auto write = [&](const char* name, const std::string& text) {
            return darkroom::write_own_file(fs::path(options_.folder) / name, std::as_bytes(std::span(text)),
                                            darkroom::FileOwner::Anyone);
        };
        DARKROOM_TRY(write("judge.json", json_of(out_).dump(2) + "\n"));
        return write("index.html", page_of(out_));
    }

    const Options& options_;
    CapturedTruth truth_;
    std::map<long long, fs::path> pictures_;
    std::vector<long long> numbers_;
    std::optional<Window> edge_;
    darkroom::RegionFinder regions_;
    darkroom::Judge judge_;
    Judgement out_;
};

int run(const Options& options) {
    const Result<Judgement> judgement = Judging(options).run();
    if (!judgement) return fail(judgement.error());
    if (options.is_json) {
        fmt::print("{}\n", json_of(*judgement).dump(2));
        return exit_ok;
    }
    const std::string text = text_of(*judgement);
    answer(text.substr(0, text.size() - 1));
    return exit_ok;
}

}  // namespace

Command add_judge(CommandFlags program) {
    const CommandFlags command =
        program.add_command("judge", "Says how far the pictures of a temporal filter are from the truth of a capture");
    command.examples(
        "darkroom_lab judge --truth captured --test captured/1x\n"
        "darkroom_lab judge --truth captured --test captured/1x -o judgement\n"
        "darkroom_lab judge --truth captured --test captured/1x --frames 1 --json");
    const auto options = std::make_shared<Options>();
    command.add_option("--truth", options->truth, "A folder of `capture`").type_name("DIR").required();
    command
        .add_option("--test", options->test,
                    "Pictures with the same numbers: linear light (.exr, .hdr), or sRGB codes of c / (1 + max c)")
        .type_name("DIR")
        .required();
    command.add_option("-o,--output,--out", options->folder, "A folder for judge.json and a page with the pictures")
        .type_name("DIR");
    command.add_option("--frames", options->frames, "Frames of the truth that count; default: all").type_name("A-B");
    command.add_option("--edge", options->edge, "Place of a slanted edge whose sharpness is measured")
        .type_name("X,Y,WxH");
    command.add_flag("--json", options->is_json, "For programs");
    return {command, [options] { return run(*options); }};
}

}  // namespace app
