// SPDX-License-Identifier: MIT
#include "compare_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "core/text/param_text.hpp"
#include "programs/darkroom/run/json.hpp"

namespace app {

using darkroom::printable;

namespace {

// JSON is UTF-8, file names need not be.
Json texts(std::span<const std::string> list) {
    Json out = Json::array();
    for (const std::string& text : list) out.push_back(printable(text));
    return out;
}

Json counts(const darkroom::NonFinite& counts) { return {{"nan", counts.nan}, {"infinite", counts.infinite}}; }

Json json_of(const ComparedLayer& layer) {
    Json out{{"layer", darkroom::one_printable_line(layer.name)},
             {"channels", layer.channels},
             {"max_error", json_number(layer.errors.max_error)},
             {"mean_error", json_number(layer.errors.mean_error)},
             {"psnr", json_number(layer.errors.psnr)},
             {"differing_pixels", layer.errors.differing_pixels}};
    if (layer.alpha) out["max_alpha_error"] = json_number(layer.alpha->max_error);
    const darkroom::SampleErrors::Place& worst = layer.errors.worst;
    out["worst"] = nullptr;
    if (layer.errors.max_error > 0)
        out["worst"] = {{"x", worst.x},
                        {"y", worst.y},
                        {"channel", layer.channels[worst.channel]},
                        {"reference", json_number(worst.reference)},
                        {"test", json_number(worst.test)}};
    out["reference"] = counts(layer.reference_counts());
    out["test"] = counts(layer.test_counts());
    out["non_finite_differences"] = layer.non_finite_differences();
    if (layer.flip)
        out["flip"] = {{"kind", layer.flip->is_hdr ? "HDR" : "LDR"},
                       {"mean", layer.flip->mean},
                       {"weighted_median", layer.flip->weighted_median},
                       {"max", layer.flip->max}};
    return out;
}

std::string text_of(const ComparedLayer& layer) {
    const darkroom::SampleErrors& errors = layer.errors;
    if (layer.is_integer) {
        std::string out = fmt::format("differing pixels {} of {}\n", errors.differing_pixels, errors.pixels);
        if (errors.differing_pixels > 0)
            out += fmt::format("worst pixel      {},{}  {}: {} and {}\n", errors.worst.x, errors.worst.y,
                               layer.channels[errors.worst.channel], errors.worst.reference, errors.worst.test);
        return out;
    }
    std::string out =
        fmt::format("max error        {:.6g}\nmean error       {:.6g}\n", errors.max_error, errors.mean_error);
    if (layer.alpha) out += fmt::format("max alpha error  {:.6g}\n", layer.alpha->max_error);
    out += fmt::format("PSNR             {:.3f} dB\n", errors.psnr);
    if (errors.max_error > 0)
        out += fmt::format("worst pixel      {},{}  {}: {:.6g} and {:.6g}\n", errors.worst.x, errors.worst.y,
                           layer.channels[errors.worst.channel], errors.worst.reference, errors.worst.test);
    const darkroom::NonFinite a = layer.reference_counts(), b = layer.test_counts();
    out +=
        fmt::format("NaN              {} and {}\ninfinite         {} and {}\n", a.nan, b.nan, a.infinite, b.infinite);
    if (layer.flip) {
        const char* const kind = layer.flip->is_hdr ? "HDR" : "LDR";
        out += fmt::format("{} FLIP mean    {:.6f}\n{} FLIP median  {:.6f}\n{} FLIP max     {:.6f}\n", kind,
                           layer.flip->mean, kind, layer.flip->weighted_median, kind, layer.flip->max);
    }
    return out;
}

std::string file_name(const std::string& path) { return printable(std::filesystem::path(path).filename().string()); }

/// One number of all layers of a set: the worst, whose it is, and the mean.
struct Extreme {
    double worst = 0, sum = 0;
    std::size_t count = 0;
    std::string whose;

    void add(double value, bool is_worse, const std::string& name) {
        sum += value;
        if (count++ == 0 || is_worse) {
            worst = value;
            whose = name;
        }
    }
    [[nodiscard]] double mean() const { return sum / static_cast<double>(count); }
    [[nodiscard]] Json json() const {
        if (count == 0) return nullptr;
        return {{"worst", json_number(worst)}, {"pair", whose}, {"mean", json_number(mean())}};
    }
};

struct Extremes {
    Extreme max_error, psnr, flip;

    explicit Extremes(const ComparedSet& set) {
        for (const ComparedFiles& files : set.pairs)
            for (const ComparedLayer& layer : files.layers) {
                const std::string name = file_name(files.test);
                max_error.add(layer.max_error(), layer.max_error() > max_error.worst, name);
                psnr.add(layer.errors.psnr, layer.errors.psnr < psnr.worst, name);
                if (layer.flip) flip.add(layer.flip->mean, layer.flip->mean > flip.worst, name);
            }
    }
};

}  // namespace

std::size_t ComparedSet::failed() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(pairs, [](const ComparedFiles& files) { return !files.failures.empty(); }));
}

Json json_of(const ComparedFiles& files) {
    Json layers = Json::array();
    for (const ComparedLayer& layer : files.layers) layers.push_back(json_of(layer));
    return {{"reference", printable(files.reference)},
            {"test", printable(files.test)},
            {"passes", files.failures.empty()},
            {"failures", texts(files.failures)},
            {"layers", std::move(layers)}};
}

Json json_of(const ComparedSet& set) {
    Json pairs = Json::array();
    for (const ComparedFiles& files : set.pairs) pairs.push_back(json_of(files));
    const Extremes extremes(set);
    return {{"passes", set.failed() == 0 && set.missing() == 0 && set.errors.empty()},
            {"failed", set.failed()},
            {"only_in_reference", texts(set.only_in_reference)},
            {"only_in_test", texts(set.only_in_test)},
            {"errors", texts(set.errors)},
            {"max_error", extremes.max_error.json()},
            {"psnr", extremes.psnr.json()},
            {"flip_mean", extremes.flip.json()},
            {"sheet_rows", texts(set.sheet_rows)},
            {"pairs", std::move(pairs)}};
}

std::string text_of(const ComparedFiles& files) {
    std::string out;
    for (const ComparedLayer& layer : files.layers) {
        if (files.layers.size() > 1)
            out += fmt::format("{}{}\n", out.empty() ? "" : "\n", darkroom::one_printable_line(layer.name));
        out += text_of(layer);
    }
    return out;
}

std::string table_head(std::size_t width) {
    return fmt::format("{:<{}}  {:<10} {:>12} {:>12} {:>10} {:>10} {:>10}\n", "file", width, "layer", "max error",
                       "mean error", "PSNR dB", "FLIP", "NaN/inf");
}

std::string table_lines(const ComparedFiles& files, std::size_t width) {
    std::string out;
    for (const ComparedLayer& layer : files.layers)
        out += fmt::format("{:<{}}  {:<10} {:>12.6g} {:>12.6g} {:>10.3f} {:>10} {:>10}{}\n", file_name(files.test),
                           width, darkroom::one_printable_line(layer.name), layer.max_error(), layer.errors.mean_error,
                           layer.errors.psnr, layer.flip ? fmt::format("{:.6f}", layer.flip->mean) : "-",
                           layer.non_finite_differences(), files.failures.empty() ? "" : "  differs");
    return out;
}

std::string summary(const ComparedSet& set) {
    std::string out;
    for (const std::string& path : set.only_in_reference)
        out += fmt::format("only in the reference: {}\n", printable(path));
    for (const std::string& path : set.only_in_test) out += fmt::format("only in the test: {}\n", printable(path));
    const Extremes extremes(set);
    const auto say = [&](const char* what, const Extreme& extreme, int digits) {
        if (extreme.count > 0)
            out += fmt::format("{:<10} worst {:.{}f} ({}), mean {:.{}f}\n", what, extreme.worst, digits, extreme.whose,
                               extreme.mean(), digits);
    };
    say("max error", extremes.max_error, 6);
    say("PSNR dB", extremes.psnr, 3);
    say("FLIP", extremes.flip, 6);
    for (std::size_t i = 0; i < set.sheet_rows.size(); ++i)
        out += fmt::format("sheet row {}: {}\n", i + 1, printable(set.sheet_rows[i]));
    out += fmt::format("{} compared, {} differ, {} missing, {} cannot be compared\n", set.pairs.size(), set.failed(),
                       set.missing(), set.errors.size());
    return out;
}

}  // namespace app
