// SPDX-License-Identifier: MIT
#include "ocio/reader_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {
namespace {

void remove_all(std::string& from, std::string_view what) {
    for (std::size_t at = 0; !what.empty() && (at = from.find(what)) != std::string::npos;) from.erase(at, what.size());
}

void remove_up_to(std::string& from, std::string_view mark) {
    if (const std::size_t at = from.rfind(mark); at != std::string::npos) from.erase(0, at + mark.size());
}

/// "At line (1)", "At line 7:" and "(line 7)" go out of the text; the number comes back, or nothing.
std::string take_line(std::string& from) {
    for (const std::string_view mark : {"At line ", "at line ", "line "}) {
        const std::size_t at = from.find(mark);
        if (at == std::string::npos) continue;
        std::size_t end = at + mark.size();
        if (end < from.size() && from[end] == '(') ++end;
        const std::size_t number = end;
        while (end < from.size() && std::isdigit(static_cast<unsigned char>(from[end])) != 0) ++end;
        if (end == number) continue;
        std::string out = from.substr(number, end - number);
        while (end < from.size() && (from[end] == ')' || from[end] == ':')) ++end;
        from.erase(at, end - at);
        return out;
    }
    return {};
}

}  // namespace

std::string words_of_reader(std::string_view said, const std::filesystem::path& table) {
    std::string text(said);
    // The reason that the file's own format gave; what other formats said of it is left out.
    remove_up_to(text, " failed with: ");
    if (const std::size_t next = text.find("    '"); next != std::string::npos) text.erase(next);
    for (const std::string& name : {std::filesystem::absolute(table).lexically_normal().string(), table.string()}) {
        remove_all(text, "File " + name + " ");
        remove_all(text, "(" + name + ")");
        remove_all(text, name);
    }
    for (const std::string_view mark :
         {"Error is: ", "parsing error: ", "with this error: ", " file . ", "yaml-cpp: error "})
        if (!text.ends_with(mark)) remove_up_to(text, mark);
    // What it says of a configuration that is newer than itself names no file a second time.
    remove_all(text, "profile '' ");
    std::ranges::replace(text, '\n', ' ');
    const std::string line = take_line(text);
    constexpr std::string_view ends = " .:,\n\t";
    text.erase(0, std::min(text.find_first_not_of(ends), text.size()));
    text.erase(text.find_last_not_of(ends) + 1);
    const std::string extension = printable(lower(table.extension().string()));
    return fmt::format("{}cannot be read as {}{}{}", line.empty() ? "" : fmt::format("line {}: ", line), extension,
                       text.empty() ? "" : ": ", printable(text));
}

}  // namespace darkroom
