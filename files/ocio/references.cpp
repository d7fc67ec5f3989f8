// SPDX-License-Identifier: MIT
#include "ocio/references.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

/// Of all tables together.
constexpr std::size_t max_bytes = std::size_t{32} << 20, max_tables = 64;

struct Found {
    XML_Parser parser = nullptr;
    std::vector<std::pair<std::size_t, std::string>> names;  // with their lines
    std::optional<std::pair<std::size_t, std::string>> wrong;
};

std::size_t line_of(XML_Parser parser) {
#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9
    return XML_GetCurrentLineNumber64(parser);
#else
    return XML_GetCurrentLineNumber(parser);
#endif
}

void on_element(void* user, const char* name, const char** attributes) {
    if (lower(name) != "reference") return;
    Found& found = *static_cast<Found*>(user);
    const std::size_t line = line_of(found.parser);
    for (; *attributes != nullptr; attributes += 2) {
        const std::string attribute = lower(attributes[0]);
        if (attribute == "path") found.names.emplace_back(line, attributes[1]);
        if ((attribute == "basepath" || attribute == "alias") && !found.wrong)
            found.wrong.emplace(
                line, fmt::format("<Reference {} = \"{}\">: allowed is a path", attribute, printable(attributes[1])));
    }
}

Found references_of(std::span<const std::byte> text) {
    const std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser(
        XML_ParserCreate(nullptr), &XML_ParserFree);
    Found found{.parser = parser.get()};
    XML_SetUserData(parser.get(), &found);
    XML_SetStartElementHandler(parser.get(), on_element);
    // A table that is no XML has no references; its faults are told by who reads it.
    XML_Parse(parser.get(), reinterpret_cast<const char*>(text.data()), static_cast<int>(text.size()), XML_TRUE);
    return found;
}

/// The file that OpenColorIO takes for this name, whose working folder is that of the table.
Result<fs::path> file_of(const fs::path& folder, const std::string& name) {
    const fs::path path(name);
    const auto refuse = [](const char* what) { return user_error(what); };
    if (name.empty()) return refuse("is not a file's name");
    // These it would take for variables of the environment.
    if (name.find_first_of("$%") != std::string::npos) return refuse("allowed is a name without $ and %");
    if (std::ranges::any_of(path, [](const fs::path& part) { return part == ".."; }))
        return refuse("allowed is a file of the table's folder, or below");
    if (!path.is_absolute()) return folder / path;
    const auto [folder_end, path_end] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    if (folder_end != folder.end() || path_end == path.end())
        return refuse("allowed is a file of the table's folder, or below");
    return path;
}

/// What a table and all that it names come to, with those that are named twice counted twice: OpenColorIO makes every
/// one of them a step of the whole.
struct Total {
    std::size_t bytes = 0, tables = 1;
};

class Walk {
  public:
    explicit Walk(fs::path folder) : folder_(std::move(folder)) {}

    Result<Total> total(const fs::path& file) {
        if (const auto known = totals_.find(file); known != totals_.end()) return known->second;
        DARKROOM_TRY_VALUE(const auto text, read_file(file, {.max_size = max_bytes, .is_path_in_errors = false}));
        open_.push_back(file);
        const Found found = references_of(text);
        const bool is_first = open_.size() == 1;
        const auto place = [&](std::size_t line) {
            return is_first ? fmt::format("line {}", line)
                            : fmt::format("{}, line {}", printable(file.lexically_relative(folder_).string()), line);
        };
        if (found.wrong) return user_error(fmt::format("{}: {}", place(found.wrong->first), found.wrong->second));
        Total out{.bytes = text.size()};
        for (const auto& [line, name] : found.names) {
            const Result<Total> next = total_of(name);
            // Of one further down the place is told already.
            if (!next && is_placed_) return next;
            is_placed_ = true;
            if (!next)
                return user_error(
                    fmt::format("{}: <Reference path = \"{}\">: {}", place(line), printable(name), next.error().text));
            is_placed_ = false;
            out.bytes += next->bytes;
            out.tables += next->tables;
            if (out.bytes > max_bytes || out.tables > max_tables)
                return user_error(fmt::format("{} tables of {} bytes in all that it names, at most {} of {} are read",
                                              out.tables, out.bytes, max_tables, max_bytes));
        }
        open_.pop_back();
        totals_.emplace(file, out);
        return out;
    }

  private:
    Result<Total> total_of(const std::string& name) {
        DARKROOM_TRY_VALUE(fs::path file, file_of(folder_, name));
        file = file.lexically_normal();
        if (std::ranges::find(open_, file) != open_.end())
            return user_error("refers to a table that refers back to this one");
        return total(file);
    }

    fs::path folder_;
    std::vector<fs::path> open_;  // a table, one that it names, one that this one names, ...
    std::map<fs::path, Total> totals_;
    bool is_placed_ = false;
};

}  // namespace

Result<> check_references(const fs::path& table) {
    std::error_code error;
    const fs::path whole = fs::absolute(table, error).lexically_normal();
    const Result<Total> total = Walk(whole.parent_path()).total(whole);
    return total ? Result<>() : failure(total.error());
}

}  // namespace darkroom
