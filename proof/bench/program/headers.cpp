// SPDX-License-Identifier: MIT
#include "headers.hpp"

#include <fmt/format.h>

#include <unistd.h>
#include <cstdio>

#include <regex>
#include <set>

#include "child.hpp"
#include "core/files.hpp"

namespace darkroom::bench {

namespace {

namespace fs = std::filesystem;

/// Adds what `header` includes of others' headers, itself and through ours. libexpected is part of our price.
void add_foreign(const std::string& header, std::set<std::string>& seen, std::set<std::string>& foreign) {
    if (!seen.insert(header).second) return;
    if (!header.starts_with("darkroom/")) {
        if (!header.starts_with("tl/")) foreign.insert(header);
        return;
    }
    for (const char* const folder : {DARKROOM_SOURCE_FOLDER "/include", DARKROOM_GENERATED_HEADERS}) {
        const auto bytes = read_file(fs::path(folder) / header);
        if (!bytes) continue;
        const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
        static const std::regex include("#include <([^>]+)>");
        for (auto match = std::sregex_iterator(text.begin(), text.end(), include); match != std::sregex_iterator();
             ++match)
            add_foreign((*match)[1], seen, foreign);
    }
}

std::string text_of(const std::set<std::string>& headers) {
    std::string text;
    for (const std::string& header : headers) text += fmt::format("#include <{}>\n", header);
    return text;
}

/// Milliseconds of the CPU; nothing: there is no compiler.
Result<std::optional<double>> compile(const std::string& text, const fs::path& folder) {
    const fs::path file = folder / "host.cpp", log = folder / "log";
    DARKROOM_TRY(write_file(file, std::as_bytes(std::span(text))));
    DARKROOM_TRY_VALUE(auto sample,
                       run_program({DARKROOM_COMPILER, "-std=c++20", "-fsyntax-only", "-I",
                                    DARKROOM_SOURCE_FOLDER "/include", "-I", DARKROOM_GENERATED_HEADERS, file.string()},
                                   log));
    if (!sample) return std::optional<double>();
    return std::optional<double>(sample->cpu_ms);
}

struct Header {
    const char* name;
    double most;  ///< times the same without ours
};

}  // namespace

Result<std::vector<Figure>> header_figures(std::uint32_t rounds) {
    std::error_code error;
    const fs::path folder = fs::temp_directory_path(error) / fmt::format("darkroom_headers_{}", getpid());
    fs::create_directories(folder, error);
    struct Cleaner {
        const fs::path& folder;
        ~Cleaner() {
            std::error_code ignored;
            fs::remove_all(folder, ignored);
        }
    } const cleaner{folder};
    std::vector<Figure> figures;
    for (const Header& header : {Header{"darkroom/darkroom.hpp", 1.7}, Header{"darkroom/composer.hpp", 1.3}}) {
        std::set<std::string> seen, foreign;
        add_foreign(header.name, seen, foreign);
        const std::string own = fmt::format("#include <{}>\n", header.name), floor = text_of(foreign);
        std::vector<double> own_ms, ratios;
        for (std::uint32_t round = 0; round <= rounds; ++round) {
            const auto without = compile(floor, folder);
            if (!without) {
                fmt::print(stderr, "headers: left out, Vulkan's do not compile here\n");
                return figures;
            }
            DARKROOM_TRY_VALUE(const auto with, compile(own, folder));
            if (!with || !*without) return figures;
            if (round == 0) continue;
            own_ms.push_back(*with);
            ratios.push_back(*with / **without);
        }
        figures.push_back({fmt::format("headers: {}", header.name), median(own_ms), "ms"});
        figures.push_back({fmt::format("headers: {} / Vulkan and the same of the standard library", header.name),
                           median(ratios), "", header.most});
    }
    return figures;
}

}  // namespace darkroom::bench
