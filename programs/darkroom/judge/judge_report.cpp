// SPDX-License-Identifier: MIT
#include "judge_report.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/text/markup.hpp"
#include "core/text/param_text.hpp"

namespace app {

using darkroom::ErrorSum;
using darkroom::JudgedRegion;
using darkroom::printable;

namespace {

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

}  // namespace

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

}  // namespace app
