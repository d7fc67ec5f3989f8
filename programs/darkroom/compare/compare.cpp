// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>

#include "compare_files.hpp"
#include "compare_page.hpp"
#include "compare_pairs.hpp"
#include "compare_report.hpp"
#include "core/own_file.hpp"
#include "core/text/param_text.hpp"
#include "image/compare/contact_sheet.hpp"
#include "image/picture/write.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/flags.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace {

using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

/// They were compared, and are too far apart.
constexpr int exit_differ = 3;

struct Options {
    std::string a, b, diff, sheet, html, layers = "color";
    bool is_json = false, makes_folders = false;
    NumberFlag fail_max{"--fail-max", {.least = 0, .most = 1e30}};
    NumberFlag fail_psnr{"--fail-psnr", {.least = -1000, .most = 1000, .unit = "dB"}};
    NumberFlag fail_flip{"--fail-flip", {.least = 0, .most = 1}};
    NumberFlag fail_above{"--fail-above", {.least = 0, .most = 1}};  ///< what --fail-flip was called first
};

Result<CompareRequest> parse_layers(const std::string& list) {
    CompareRequest request{.layers = {}};
    for (std::size_t start = 0; start <= list.size();) {
        const std::size_t end = std::min(list.find(',', start), list.size());
        const std::string name = list.substr(start, end - start);
        if (name.empty()) return user_error(fmt::format("--layers {}: a name is empty", printable(list)));
        if (std::ranges::find(request.layers, name) == request.layers.end()) request.layers.push_back(name);
        start = end + 1;
    }
    request.has_all_layers = std::ranges::find(request.layers, "all") != request.layers.end();
    return request;
}

Result<CompareRequest> request_of(const Options& options) {
    DARKROOM_TRY_VALUE(CompareRequest request, parse_layers(options.layers));
    Thresholds& most = request.thresholds;
    for (const auto& [flag, to] :
         {std::pair(&options.fail_max, &most.max), std::pair(&options.fail_psnr, &most.psnr),
          std::pair(&options.fail_above, &most.flip), std::pair(&options.fail_flip, &most.flip)})
        DARKROOM_TRY(flag->read_to(*to));
    const bool has_color = request.has_all_layers || std::ranges::find(request.layers, "color") != request.layers.end();
    for (const auto& [is_given, name] :
         {std::pair(most.flip.has_value(), "--fail-flip"), std::pair(!options.diff.empty(), "--diff"),
          std::pair(!options.sheet.empty(), "--sheet"), std::pair(!options.html.empty(), "--html")})
        if (is_given && !has_color)
            return user_error(fmt::format("{}: needs the layer color, which --layers {} leaves out", name,
                                          printable(options.layers)));
    return request;
}

// Before any work is done.
Result<> check_written(const std::string& path, const FilePairs& pairs, bool makes_folders) {
    if (path.empty()) return {};
    std::vector<std::filesystem::path> inputs;
    for (const FilePairs::Pair& pair : pairs.pairs) inputs.insert(inputs.end(), {pair.reference, pair.test});
    const MissingFolders folders = makes_folders ? MissingFolders::Made : MissingFolders::Told;
    return check_report(path, FileSet(inputs), folders);
}

Result<> check_picture(const std::string& path) {
    if (path.empty()) return {};
    DARKROOM_TRY(darkroom::sample_kind(path, {}));
    return {};
}

const darkroom::WriteOptions as_report{.follows_links = false};

Result<> add_to(darkroom::ContactSheet& sheet, const std::string& name, const std::optional<ComparedColor>& color) {
    if (!color) return {};
    return sheet.add(name, color->reference.picture, color->test.picture, color->comparison, color->reference.encoding);
}

void tell_lines(std::string_view lines) { answer_unless_quiet(lines.substr(0, lines.find_last_not_of('\n') + 1)); }

void print(const Options& options, const Json& document, const std::string& text) {
    if (options.is_json)
        fmt::print("{}\n", document.dump(2));
    else
        tell_lines(text);
}

Result<> write_page(const ComparePage& page, const ComparedSet& set, const Options& options) {
    if (options.html.empty()) return {};
    const std::string text = page.html(set, options.a, options.b);
    return darkroom::write_own_file(options.html, std::as_bytes(std::span(text)), darkroom::FileOwner::Anyone);
}

int compare_one(const FilePairs::Pair& pair, const CompareRequest& request, const Options& options) {
    std::optional<ComparedColor> color;
    const Result<ComparedFiles> files = compare_files(pair.reference, pair.test, request, &color);
    if (!files) return fail(files.error());
    if (!options.diff.empty() && color)
        if (Result<> done = darkroom::write_picture(options.diff, color->comparison.flip_map, as_report); !done)
            return fail(done.error());
    if (!options.sheet.empty()) {
        darkroom::ContactSheet sheet;
        if (Result<> done = add_to(sheet, files->test, color); !done) return fail(done.error());
        if (Result<> done = darkroom::write_picture(options.sheet, sheet.picture(), as_report); !done)
            return fail(done.error());
    }
    if (!options.html.empty()) {
        ComparePage page;
        if (color)
            if (Result<> done = page.add(0, *files, *color); !done) return fail(done.error());
        if (Result<> done = write_page(page, {.pairs = {*files}}, options); !done) return fail(done.error());
    }
    print(options, json_of(*files), text_of(*files));
    if (files->failures.empty()) return exit_ok;
    complain(
        fmt::format("{} and {}: {}", printable(options.a), printable(options.b), fmt::join(files->failures, "; ")));
    return exit_differ;
}

int compare_many(const FilePairs& pairs, const CompareRequest& request, const Options& options) {
    ComparedSet set;
    for (const auto& path : pairs.only_in_reference) set.only_in_reference.push_back(path.string());
    for (const auto& path : pairs.only_in_test) set.only_in_test.push_back(path.string());
    std::size_t width = 4;
    for (const FilePairs::Pair& pair : pairs.pairs)
        width = std::max(width, printable(pair.test.filename().string()).size());
    if (!options.is_json) tell_lines(table_head(width));
    darkroom::ContactSheet sheet;
    ComparePage page;
    const bool has_pictures = !options.sheet.empty() || !options.html.empty();
    int worst = exit_ok;
    for (const FilePairs::Pair& pair : pairs.pairs) {
        std::optional<ComparedColor> color;
        Result<ComparedFiles> files =
            compare_files(pair.reference, pair.test, request, has_pictures ? &color : nullptr);
        if (!files) {
            worst = std::max(worst, fail(files.error()));
            set.errors.push_back(files.error().text);
            continue;
        }
        if (!options.is_json) tell_lines(table_lines(*files, width));
        if (!options.sheet.empty())
            if (Result<> done = add_to(sheet, pair.test.filename().string(), color); !done) return fail(done.error());
        if (!options.html.empty() && color)
            if (Result<> done = page.add(set.pairs.size(), *files, *color); !done) return fail(done.error());
        set.pairs.push_back(std::move(*files));
    }
    if (!options.sheet.empty()) {
        set.sheet_rows = sheet.names();
        if (Result<> done = darkroom::write_picture(options.sheet, sheet.picture(), as_report); !done)
            return fail(done.error());
    }
    if (Result<> done = write_page(page, set, options); !done) return fail(done.error());
    print(options, json_of(set), summary(set));
    if (worst != exit_ok) return worst;
    if (set.failed() + set.missing() == 0) return exit_ok;
    complain(fmt::format("{} and {}: {} of {} pairs differ, {} files are missing", printable(options.a),
                         printable(options.b), set.failed(), set.pairs.size(), set.missing()));
    return exit_differ;
}

int run(const Options& options) {
    const Result<CompareRequest> request = request_of(options);
    if (!request) return fail(request.error());
    const Result<FilePairs> pairs = find_pairs(options.a, options.b);
    if (!pairs) return fail(pairs.error());
    if (!pairs->is_single && !options.diff.empty())
        return fail_user(fmt::format("--diff {}: works for two pictures; --sheet and --html show the worst of many",
                                     printable(options.diff)));
    if (!options.html.empty())
        if (const Result<> done = check_page_name(options.html); !done) return fail(done.error());
    for (const std::string& path : {options.diff, options.sheet})
        if (const Result<> done = check_picture(path); !done) return fail(done.error());
    const auto place = [](const std::string& path) { return std::filesystem::absolute(path).lexically_normal(); };
    if (!options.diff.empty() && !options.sheet.empty() && place(options.diff) == place(options.sheet))
        return fail_user(fmt::format("{}: --diff and --sheet name the same file", printable(options.sheet)));
    for (const std::string& path : {options.diff, options.sheet, options.html})
        if (const Result<> done = check_written(path, *pairs, options.makes_folders); !done) return fail(done.error());
    return pairs->is_single ? compare_one(pairs->pairs.front(), *request, options)
                            : compare_many(*pairs, *request, options);
}

}  // namespace

static Command add_compare(CommandFlags program) {
    const CommandFlags command = program.add_command(
        "compare", "Compares pictures, folders or sequences: errors, PSNR and FLIP; exit code 3: they differ");
    const auto options = std::make_shared<Options>();
    command.examples(
        "darkroom compare frame.exr frame.exr --fail-max 0\n"
        "darkroom compare reference.png changed.png --fail-flip 0.9 --diff difference.png\n"
        "darkroom compare expected/ pictures/ --fail-max 0 --html review.html");
    command.add_option("A", options->a, "The reference: a file, a folder or a sequence").required();
    command.add_option("B", options->b, "The pictures under test, of the same kind").required();
    options->fail_max.add_to(command, "Fails if a channel differs by more anywhere").type_name("X");
    options->fail_psnr.add_to(command, "Fails if the PSNR is below this").type_name("DB");
    options->fail_flip.add_to(command, "Fails if the mean FLIP is above this").type_name("X");
    options->fail_above.add_to(command, "Another name of --fail-flip").type_name("X");
    command
        .add_option("--layers", options->layers,
                    "color, depth, normals, velocity, layers or channels as the file names them, or all")
        .type_name("LIST");
    command.add_option("--diff", options->diff, "Writes the FLIP errors of two files as a picture")
        .type_name("OUT.png");
    command.add_option("--sheet", options->sheet, "Writes the worst: reference, test and FLIP errors side by side")
        .type_name("OUT.png");
    command.add_option("--html", options->html, "Writes a page of the worst: before, after, difference and FLIP errors")
        .type_name("OUT.html");
    command.add_flag("--mkdir", options->makes_folders, "Makes the folders of these files where they are not there");
    command.add_flag("--json", options->is_json, "For programs");
    return {command, [options] { return run(*options); }};
}

CommandRow compare_command() {
    return {.names = {"compare"}, .place = 40, .add = [](const CommandHost& host) {
                return std::vector{add_compare(host.program)};
            }};
}

}  // namespace app
