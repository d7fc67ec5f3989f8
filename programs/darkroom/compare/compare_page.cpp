// SPDX-License-Identifier: MIT
#include "compare_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <span>

#include "core/text/lower.hpp"
#include "core/text/markup.hpp"
#include "core/text/param_text.hpp"
#include "image/compare/shown_picture.hpp"

namespace app {

using darkroom::Picture;
using darkroom::printable;
using darkroom::Result;

namespace {

// The policy lets nothing in from elsewhere, which also shows that nothing is needed.
constexpr std::string_view page_start = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<meta http-equiv="Content-Security-Policy"
 content="default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'">
<title>)";

constexpr std::string_view page_style = R"(</title><style>
:root { color-scheme: light dark; --back: #fff; --text: #1c1f24; --soft: #667; --line: #d5d8de; --bad: #b3261e;
  --good: #1b7a3a; --mark: #1a66d0; }
@media (prefers-color-scheme: dark) { :root { --back: #16181c; --text: #dde; --soft: #99a; --line: #33363d;
  --bad: #ff8a80; --good: #7bd88f; --mark: #7db4ff; } }
body { font: 15px/1.5 system-ui, sans-serif; background: var(--back); color: var(--text); margin: 1.5em auto;
  max-width: 1600px; padding: 0 1.5em; }
h1 { font-size: 1.5em; overflow-wrap: anywhere; } h2 { font-size: 1.2em; margin: 0; overflow-wrap: anywhere; }
a { color: var(--mark); } .soft { color: var(--soft); } .bad { color: var(--bad); } .good { color: var(--good); }
kbd { border: 1px solid var(--line); border-radius: .25em; padding: 0 .35em; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
td, th { padding: .15em 1.2em .15em 0; text-align: right; white-space: nowrap; }
td:first-child, th:first-child { text-align: left; } tr + tr { border-top: 1px solid var(--line); }
.pair { border-top: 2px solid var(--line); padding: 1em 0; outline: none; scroll-margin-top: .5em; }
.pair.here h2::before { content: "\25B8 "; color: var(--mark); }
.views { display: grid; grid-template-columns: 2fr 1fr; gap: 1em; align-items: start; }
.maps { display: grid; gap: 1em; min-width: 0; } figure { margin: 0; min-width: 0; }
figcaption { color: var(--soft); font-size: .9em; }
.frame { overflow: auto; } .frame img { display: block; width: 100%; height: auto; image-rendering: pixelated; }
.stage { position: relative; overflow: hidden; cursor: ew-resize; touch-action: pan-y; user-select: none; }
.stage .after { position: absolute; inset: 0; clip-path: inset(0 0 0 var(--split, 50%)); }
.stage::after { content: ""; position: absolute; top: 0; bottom: 0; left: var(--split, 50%); width: 2px;
  margin-left: -1px; background: var(--mark); }
.ends { display: flex; gap: 1em; align-items: center; } .ends input { flex: 1; min-width: 0; }
.actual .views { grid-template-columns: 1fr; } .actual .frame img { width: auto; max-width: none; }
.actual .stage { width: max-content; }
@media (max-width: 800px) { .views { grid-template-columns: 1fr; } }
</style></head><body>
)";

constexpr std::string_view page_keys = R"(<p class="soft"><kbd>j</kbd> <kbd>k</kbd> next and previous pair
· <kbd>←</kbd> <kbd>→</kbd> slider · <kbd>1</kbd> before · <kbd>2</kbd> after · <kbd>3</kbd> half of each
· <kbd>b</kbd> before or after · <kbd>z</kbd> pixels as they are</p>
)";

constexpr std::string_view page_script = R"(<script>
const pairs = [...document.querySelectorAll(".pair")];
let here = 0;
const slider = pair => pair.querySelector("input");
function split(pair, percent) {
    slider(pair).value = percent;
    pair.querySelector(".stage").style.setProperty("--split", slider(pair).value + "%");
}
function go(index) {
    pairs[here].classList.remove("here");
    here = Math.min(Math.max(index, 0), pairs.length - 1);
    pairs[here].classList.add("here");
}
pairs.forEach((pair, index) => {
    const stage = pair.querySelector(".stage");
    const drag = event => {
        const box = stage.getBoundingClientRect();
        if (event.buttons & 1) split(pair, 100 * (event.clientX - box.left) / box.width);
    };
    stage.addEventListener("pointerdown", event => {
        stage.setPointerCapture(event.pointerId);
        go(index);
        drag(event);
    });
    stage.addEventListener("pointermove", drag);
    stage.addEventListener("dragstart", event => event.preventDefault());
    slider(pair).addEventListener("input", () => split(pair, slider(pair).value));
    slider(pair).addEventListener("focus", () => go(index));
    split(pair, slider(pair).value);
});
const keys = {
    j: () => { go(here + 1); pairs[here].scrollIntoView(); },
    k: () => { go(here - 1); pairs[here].scrollIntoView(); },
    1: () => split(pairs[here], 100),
    2: () => split(pairs[here], 0),
    3: () => split(pairs[here], 50),
    b: () => split(pairs[here], Number(slider(pairs[here]).value) > 50 ? 0 : 100),
    z: () => document.body.classList.toggle("actual"),
    ArrowLeft: () => split(pairs[here], Number(slider(pairs[here]).value) - 2),
    ArrowRight: () => split(pairs[here], Number(slider(pairs[here]).value) + 2),
};
document.addEventListener("keydown", event => {
    if (!keys[event.key] || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    keys[event.key]();
});
if (pairs.length) go(0);
</script>
)";

std::string on_page(std::string_view text) { return darkroom::escaped(printable(text)); }

std::string name_on_page(const std::string& path) { return on_page(std::filesystem::path(path).filename().string()); }

bool is_equal(const ComparedLayer& layer) { return layer.max_error() == 0 && layer.non_finite_differences() == 0; }

bool is_equal(const ComparedFiles& files) {
    return files.failures.empty() &&
           std::ranges::all_of(files.layers, [](const ComparedLayer& layer) { return is_equal(layer); });
}

std::string verdict(const ComparedFiles& files) {
    if (!files.failures.empty()) return R"(<span class="bad">fails</span>)";
    return is_equal(files) ? R"(<span class="good">equal</span>)" : R"(<span class="good">passes</span>)";
}

std::string cells(const ComparedLayer& layer) {
    return fmt::format("<td>{}</td><td>{:.6g}</td><td>{:.3f}</td><td>{}</td>",
                       layer.flip ? fmt::format("{:.6f}", layer.flip->mean) : "-", layer.max_error(), layer.errors.psnr,
                       layer.non_finite_differences());
}

std::string list(std::string_view what, std::span<const std::string> lines, std::size_t most) {
    if (lines.empty()) return {};
    std::string out = fmt::format("<p class=\"bad\">{}: {}</p><ul>\n", what, lines.size());
    for (const std::string& line : lines.first(std::min(lines.size(), most)))
        out += fmt::format("<li>{}</li>\n", darkroom::escaped(darkroom::one_printable_line(line)));
    if (lines.size() > most) out += fmt::format("<li>and {} more</li>\n", lines.size() - most);
    return out + "</ul>\n";
}

std::string image(std::string_view name, std::string_view uri, std::uint32_t width, std::uint32_t height) {
    return fmt::format(R"(<img class="{}" alt="{}" width="{}" height="{}" src="{}">)", name, name, width, height, uri);
}

std::string worst_place(const ComparedLayer& layer) {
    const darkroom::SampleErrors::Place& worst = layer.errors.worst;
    if (!(layer.errors.max_error > 0)) return {};
    return fmt::format("worst pixel {},{} {}: {:.6g} and {:.6g}", worst.x, worst.y,
                       on_page(layer.channels[worst.channel]), worst.reference, worst.test);
}

}  // namespace

std::size_t ComparePage::Pair::bytes() const {
    return std::accumulate(uris.begin(), uris.end(), std::size_t{0},
                           [](std::size_t sum, const std::string& uri) { return sum + uri.size(); });
}

ComparePage::Badness ComparePage::badness_of(const ComparedFiles& files) {
    Badness out;
    for (const ComparedLayer& layer : files.layers) {
        out.non_finite += layer.non_finite_differences();
        if (layer.flip) out.flip = std::max(out.flip, layer.flip->mean);
        out.max_error = std::max(out.max_error, layer.max_error());
    }
    return out;
}

void ComparePage::drop_last() {
    // Nothing less bad than it came in since something was dropped before: it is the worst of them.
    dropped_ = pairs_.back().badness;
    pairs_.pop_back();
}

Result<> ComparePage::add(std::size_t index, const ComparedFiles& files, const ComparedColor& color) {
    if (is_equal(files)) return {};
    Pair pair{.index = index, .badness = badness_of(files)};
    // What is left out would make a gap in the order if something less bad were shown.
    if (dropped_ && !(pair.badness > *dropped_)) return {};
    const auto place = std::ranges::find_if(pairs_, [&](const Pair& other) { return pair.badness > other.badness; });
    const auto& [reference, test, comparison] = color;
    pair.width = reference.picture.width;
    pair.height = reference.picture.height;
    pair.is_linear = reference.encoding == darkroom::PictureEncoding::SceneLinear;
    darkroom::ShownDifference difference =
        darkroom::shown_difference(reference.picture, test.picture, reference.encoding);
    pair.gain = difference.gain;
    std::array<Picture, 4> pictures{darkroom::shown_picture(reference.picture, reference.encoding),
                                    darkroom::shown_picture(test.picture, test.encoding), std::move(difference.picture),
                                    comparison.flip_map};
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        DARKROOM_TRY_VALUE(const Picture small, darkroom::no_larger_than(std::move(pictures[i]), max_side));
        pair.shown_width = small.width;
        pair.shown_height = small.height;
        DARKROOM_TRY_VALUE(const std::vector<std::byte> png, darkroom::png_of(small));
        pair.uris[i] = "data:image/png;base64," + darkroom::base64(png);
    }
    pairs_.insert(place, std::move(pair));
    const auto total = [&] {
        std::size_t sum = 0;
        for (const Pair& other : pairs_) sum += other.bytes();
        return sum;
    };
    while (pairs_.size() > max_pairs || total() > max_bytes) drop_last();
    return {};
}

std::string ComparePage::section(const Pair& pair, const ComparedFiles& files) const {
    const auto img = [&](std::size_t i, std::string_view name) {
        return image(name, pair.uris[i], pair.shown_width, pair.shown_height);
    };
    std::string out = fmt::format("<section class=\"pair\" id=\"pair{}\"><h2>{} {}</h2>\n", pair.index,
                                  name_on_page(files.test), verdict(files));
    for (const std::string& failure : files.failures)
        out += fmt::format("<p class=\"bad\">{}</p>\n", darkroom::escaped(darkroom::one_printable_line(failure)));
    const auto color = std::ranges::find_if(files.layers, [](const ComparedLayer& layer) { return !!layer.flip; });
    if (color != files.layers.end())
        out += fmt::format("<p>mean FLIP {:.6f}, most {:.6f} · largest error {:.6g} · PSNR {:.3f} dB · {}</p>\n",
                           color->flip->mean, color->flip->max, color->max_error(), color->errors.psnr,
                           worst_place(*color));
    out += fmt::format("<p class=\"soft\">{}x{}", pair.width, pair.height);
    if (pair.shown_width != pair.width || pair.shown_height != pair.height)
        out += fmt::format(", shown at {}x{}", pair.shown_width, pair.shown_height);
    if (pair.is_linear) out += ", linear light, shown sRGB-encoded and cut off at 1";
    out +=
        "; what is not finite is magenta</p>\n<div class=\"views\"><figure><div class=\"frame\"><div "
        "class=\"stage\">\n";
    out += img(0, "before") + "\n" + img(1, "after") + "\n</div></div>\n";
    out +=
        "<div class=\"ends\"><span>before</span><input type=\"range\" min=\"0\" max=\"100\" step=\"any\" "
        "value=\"50\" aria-label=\"how much of the picture before is shown, in per cent\"><span>after</span></div>"
        "</figure>\n<div class=\"maps\">\n";
    out += fmt::format("<figure><div class=\"frame\">{}</div><figcaption>difference{}</figcaption></figure>\n",
                       img(2, "difference"), pair.gain > 1 ? fmt::format(", times {}", pair.gain) : "");
    out += fmt::format("<figure><div class=\"frame\">{}</div><figcaption>FLIP: {}</figcaption></figure>\n",
                       img(3, "flip"), "black where nobody sees a difference");
    return out + "</div></div></section>\n";
}

std::string ComparePage::table(const ComparedSet& set) const {
    std::vector<std::size_t> order(set.pairs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        const bool is_equal_a = is_equal(set.pairs[a]), is_equal_b = is_equal(set.pairs[b]);
        return is_equal_a != is_equal_b ? is_equal_b : badness_of(set.pairs[a]) > badness_of(set.pairs[b]);
    });
    std::string out =
        "<div class=\"scroll\"><table><tr><th>file</th><th></th><th>layer</th><th>FLIP</th><th>largest error</th>"
        "<th>PSNR, dB</th><th>NaN, infinite</th></tr>\n";
    std::size_t rows = 0;
    for (const std::size_t index : order) {
        const ComparedFiles& files = set.pairs[index];
        std::string name = name_on_page(files.test);
        if (is_equal(files)) {
            out += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", name, verdict(files));
            ++rows;
        }
        if (std::ranges::find(pairs_, index, &Pair::index) != pairs_.end())
            name = fmt::format("<a href=\"#pair{}\">{}</a>", index, name);
        for (const ComparedLayer& layer :
             is_equal(files) ? std::span<const ComparedLayer>() : std::span(files.layers)) {
            out += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td>{}</tr>\n", name, verdict(files),
                               on_page(darkroom::one_printable_line(layer.name)), cells(layer));
            ++rows;
        }
        if (rows >= max_rows) {
            const auto shown = static_cast<std::size_t>(std::ranges::find(order, index) - order.begin()) + 1;
            if (shown < order.size())
                out += fmt::format("<tr><td>and {} pairs more, none of them worse</td></tr>\n", order.size() - shown);
            break;
        }
    }
    return out + "</table></div>\n";
}

std::string ComparePage::html(const ComparedSet& set, const std::string& reference, const std::string& test) const {
    const auto equal = static_cast<std::size_t>(
        std::ranges::count_if(set.pairs, [](const ComparedFiles& files) { return is_equal(files); }));
    std::string out(page_start);
    out += on_page(test);
    out += page_style;
    out += fmt::format(
        "<h1>{}</h1>\n<p>against {} · {} compared: <b class=\"{}\">{} fail</b>, {} equal, {} missing, "
        "{} cannot be compared</p>\n",
        on_page(test), on_page(reference), set.pairs.size(), set.failed() > 0 ? "bad" : "good", set.failed(), equal,
        set.missing(), set.errors.size());
    const std::size_t bare = set.pairs.size() - equal - pairs_.size();
    if (bare > 0)
        out += fmt::format(
            "<p>{} pairs that differ have no pictures here: a page holds those of the {} worst, and "
            "{} MiB of them.</p>\n",
            bare, max_pairs, max_bytes >> 20);
    out += list("cannot be compared", set.errors, max_rows);
    out += list("only in the reference", set.only_in_reference, max_rows);
    out += list("only in the test", set.only_in_test, max_rows);
    out += table(set);
    if (!pairs_.empty()) out += page_keys;
    for (const Pair& pair : pairs_) out += section(pair, set.pairs[pair.index]);
    if (!pairs_.empty()) out += page_script;
    return out + "</body></html>\n";
}

Result<> check_page_name(const std::filesystem::path& path) {
    const std::string extension = darkroom::lower(path.extension().string());
    if (extension == ".html" || extension == ".htm") return {};
    return darkroom::user_error(
        fmt::format("{}: {}; .html .htm can be written as a page", printable(path.string()),
                    extension.empty() ? "no extension" : fmt::format("unknown extension {}", printable(extension))));
}

}  // namespace app
