// SPDX-License-Identifier: MIT
#include "image/frame/sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

namespace darkroom {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::optional<long long> whole_number(std::string_view text) {
    long long value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || code != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

// before%04dafter, before####after, before@@@@after
struct Pattern {
    std::string before;
    std::string after;
    int width = 0;

    [[nodiscard]] std::string name(long long number) const {
        return fmt::format("{}{:0{}}{}", before, number, width, after);
    }
};

std::optional<Pattern> parse(const std::string& name) {
    for (std::size_t percent = name.find('%'); percent != std::string::npos; percent = name.find('%', percent + 1)) {
        std::size_t end = percent + 1;
        while (end < name.size() && is_digit(name[end])) ++end;
        if (end == name.size() || name[end] != 'd' || end - percent > 4) continue;
        const auto width = whole_number(std::string_view(name).substr(percent + 1, end - percent - 1)).value_or(0);
        return Pattern{name.substr(0, percent), name.substr(end + 1), static_cast<int>(std::min<long long>(width, 18))};
    }
    // As many digits as there are signs; a single one is a name like any other.
    for (std::size_t begin = name.find_first_of("#@"); begin != std::string::npos;) {
        const std::size_t end = std::min(name.find_first_not_of(name[begin], begin), name.size());
        if (end - begin >= 2 && end - begin <= 18)
            return Pattern{name.substr(0, begin), name.substr(end), static_cast<int>(end - begin)};
        begin = name.find_first_of("#@", end);
    }
    return std::nullopt;
}

struct Range {
    long long first = 0;
    long long last = std::numeric_limits<long long>::max();
};

Result<Range> take_range(std::string& input) {
    const std::size_t open = input.rfind('[');
    if (open == std::string::npos || !input.ends_with(']')) return Range{};
    const std::string_view inside = std::string_view(input).substr(open + 1, input.size() - open - 2);
    const std::size_t dash = inside.find('-');
    const auto first = whole_number(inside.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : whole_number(inside.substr(dash + 1));
    if (!first || !last || *first > *last)
        return user_error(fmt::format("{}: the range needs two numbers in order, as in [1-20]", input));
    const Range range{*first, *last};
    input.resize(open);
    return range;
}

Result<> expand(std::string input, std::vector<fs::path>& files) {
    const std::string given = input;
    std::error_code code;
    if (!has_number_pattern(input) || fs::exists(input, code)) {
        files.emplace_back(std::move(input));
        return {};
    }
    auto range = take_range(input);
    if (!range) return failure(std::move(range));
    const fs::path path(input);
    const Pattern pattern = *parse(path.filename().string());
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::vector<std::pair<long long, fs::path>> found;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        const std::string name = entry->path().filename().string();
        if (name.size() <= pattern.before.size() + pattern.after.size()) continue;
        if (!name.starts_with(pattern.before) || !name.ends_with(pattern.after)) continue;
        const auto number = whole_number(std::string_view(name).substr(
            pattern.before.size(), name.size() - pattern.before.size() - pattern.after.size()));
        if (!number || *number < range->first || *number > range->last || pattern.name(*number) != name) continue;
        found.emplace_back(*number, path.has_parent_path() ? folder / name : fs::path(name));
    }
    if (code) return user_error(fmt::format("{}: cannot list the folder: {}", given, code.message()));
    if (found.empty()) return user_error(fmt::format("{}: no file matches", given));
    std::sort(found.begin(), found.end());
    for (auto& [number, file] : found) files.push_back(std::move(file));
    return {};
}

}  // namespace

bool has_number_pattern(const fs::path& path) { return parse(path.filename().string()).has_value(); }

fs::path numbered(const fs::path& pattern, long long number) {
    const auto parsed = parse(pattern.filename().string());
    return parsed ? pattern.parent_path() / parsed->name(number) : pattern;
}

std::optional<long long> frame_number(const fs::path& path) {
    const std::string stem = path.stem().string();
    std::size_t end = stem.size();
    while (end > 0 && !is_digit(stem[end - 1])) --end;
    std::size_t begin = end;
    while (begin > 0 && is_digit(stem[begin - 1])) --begin;
    return whole_number(std::string_view(stem).substr(begin, end - begin));
}

Result<std::vector<fs::path>> expand_inputs(std::span<const std::string> inputs) {
    std::vector<fs::path> files;
    for (const std::string& input : inputs)
        if (auto expanded = expand(input, files); !expanded) return failure(std::move(expanded));
    return files;
}

}  // namespace darkroom
