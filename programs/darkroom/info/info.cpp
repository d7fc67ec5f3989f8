// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <system_error>

#include "core/files.hpp"
#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"
#include "image/picture/picture_source.hpp"
#include "image/table/table_file.hpp"
#include "info_documents.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/effects/named_effects.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace {

namespace fs = std::filesystem;
using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

struct Options {
    std::vector<std::string> files;
    bool is_json = false;
    bool has_no_custom_effects = false;
    bool has_own_files = false;
};

/// The start of a file, and its extension in lower case for kinds that have no mark.
struct Head {
    std::string start;
    std::string extension;

    /// The first line that is neither empty nor a comment of TOML; of a file with bytes of zero: nothing.
    [[nodiscard]] std::string_view first_line() const {
        if (start.find('\0') != std::string::npos) return {};
        for (std::size_t at = start.find_first_not_of(" \t\r\n"); at != std::string::npos;) {
            const std::string_view line = std::string_view(start).substr(at, start.find('\n', at) - at);
            if (!line.starts_with('#')) return line;
            at = start.find_first_not_of(" \t\r\n", at + line.size());
        }
        return {};
    }
};

bool is_picture(const Head& head) { return darkroom::format_of_file(std::as_bytes(std::span(head.start))).has_value(); }

bool is_model(const Head& head) { return head.start.starts_with("glTF") || head.first_line().starts_with('{'); }

bool is_toml(const Head& head) {
    const std::string_view line = head.first_line();
    return head.extension == ".toml" || line.starts_with('[') || line.find('=') != std::string_view::npos;
}

bool is_table(const Head& head) {
    const std::vector<std::string> extensions = darkroom::table_extensions();
    std::string_view line = head.first_line();
    if (line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
    const auto begins = [&](std::string_view word) { return line.starts_with(word); };
    return std::ranges::find(extensions, head.extension) != extensions.end() ||
           std::ranges::any_of(std::array{"TITLE ", "LUT_1D_", "LUT_3D_", "DOMAIN_M"}, begins);
}

struct Kind {
    std::string name;
    bool (*is)(const Head& head);
    std::function<Result<Json>(const fs::path& path)> tell;
};

/// A file is the first of them that it looks like.
std::array<Kind, 4> kinds_of(const Options& options) {
    const auto named = options.has_own_files ? darkroom::scene::NamedFiles::Own : darkroom::scene::NamedFiles::Any;
    const auto toml = [allows = !options.has_no_custom_effects, named](const fs::path& path) {
        return info::toml(path, allows, named);
    };
    const auto model = [named](const fs::path& path) { return info::model(path, named); };
    return {
        Kind{fmt::format("a picture ({})", darkroom::format_names()), is_picture, info::picture},
        Kind{"a model (glTF)", is_model, model},
        Kind{fmt::format("a colour table ({})", fmt::join(darkroom::table_extensions(), ", ")), is_table, info::table},
        Kind{"a scene or a look (TOML)", is_toml, toml}};
}

Result<Head> head_of(const fs::path& path) {
    const std::string shown = printable(path.string());
    std::error_code error;
    if (!fs::exists(path, error)) return user_error(fmt::format("{}: there is no such file", shown));
    DARKROOM_TRY_VALUE(const auto start, darkroom::read_file(path, {.max_size = 4096, .takes_start = true}));
    return Head{.start = std::string(reinterpret_cast<const char*>(start.data()), start.size()),
                .extension = darkroom::lower(path.extension().string())};
}

Result<Json> document_of(const fs::path& path, const Options& options) {
    DARKROOM_TRY_VALUE(const Head head, head_of(path));
    const auto kinds = kinds_of(options);
    const auto kind = std::ranges::find_if(kinds, [&](const Kind& known) { return known.is(head); });
    if (kind != kinds.end()) return kind->tell(path);
    std::vector<std::string_view> names;
    for (const Kind& known : kinds) names.push_back(known.name);
    return user_error(fmt::format("{}: is not a file of a known kind; known are {}", printable(path.string()),
                                  fmt::join(names, ", ")));
}

int run(const Options& options) {
    Json documents = Json::array();
    int code = exit_ok;
    for (const std::string& file : options.files) {
        const Result<Json> found = document_of(file, options);
        if (!found) {
            code = std::max(code, fail(found.error()));
            continue;
        }
        Json document{{"file", file}};
        document.update(*found);
        if (!options.is_json) fmt::print("{}{}", documents.empty() ? "" : "\n", info::text_of(document));
        documents.push_back(std::move(document));
    }
    if (!options.is_json || documents.empty()) return code;
    const Json& out = options.files.size() > 1 ? documents : documents.elements().front();
    fmt::print("{}\n", out.dump(2));
    return code;
}

}  // namespace

static Command add_info(CommandFlags program) {
    const CommandFlags command = program.add_command(
        "info", "Tells what is in files: pictures and frames, models, scenes, looks and colour tables");
    const auto options = std::make_shared<Options>();
    command.examples(
        "darkroom info frame.exr\n"
        "darkroom info scene.toml my.toml\n"
        "darkroom info frame.exr --json");
    command
        .add_option("FILE", options->files,
                    "Files of any known kind, which is told by their content; looks that ship, by name")
        .names_look()
        .required();
    command.add_flag("--json", options->is_json, "For programs: a document, or an array of them for several files");
    command.add_flag("--own-files", options->has_own_files,
                     "Refuses files that a scene, its prefabs or models name outside of their folders");
    command.add_flag(no_custom_effects, options->has_no_custom_effects,
                     "Refuses a look that names the file of an effect");
    return {command, [options] { return run(*options); }};
}

CommandRow info_command() {
    return {.names = {"info"}, .place = 50, .add = [](const CommandHost& host) {
                return std::vector{add_info(host.program)};
            }};
}

}  // namespace app
