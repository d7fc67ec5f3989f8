// SPDX-License-Identifier: MIT
#include "image/frame/sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "image/frame/frame_set.hpp"

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

// before%04dafter, before####after, before@@@@after, before$F4after
struct Pattern {
    std::string before;
    std::string after;
    int width = 0;

    [[nodiscard]] std::string name(long long number) const {
        return fmt::format("{}{:0{}}{}", before, number, width, after);
    }
    /// Below 0 some count the sign among the digits, as printf does, and others write it before them.
    [[nodiscard]] std::vector<std::string> names(long long number) const {
        if (number >= 0) return {name(number)};
        return {name(number), fmt::format("{}{:0{}}{}", before, number, width + 1, after)};
    }
};

constexpr int widest = 18;

// Houdini's, with at most one digit behind it.
std::optional<Pattern> parse_dollar(const std::string& name) {
    const std::size_t begin = name.find("$F");
    if (begin == std::string::npos) return std::nullopt;
    const std::size_t end = begin + 2 < name.size() && is_digit(name[begin + 2]) ? begin + 3 : begin + 2;
    return Pattern{name.substr(0, begin), name.substr(end), end == begin + 3 ? name[begin + 2] - '0' : 1};
}

std::optional<Pattern> parse(const std::string& name) {
    for (std::size_t percent = name.find('%'); percent != std::string::npos; percent = name.find('%', percent + 1)) {
        std::size_t end = percent + 1;
        while (end < name.size() && is_digit(name[end])) ++end;
        if (end == name.size() || name[end] != 'd' || end - percent > 4) continue;
        const auto width = whole_number(std::string_view(name).substr(percent + 1, end - percent - 1)).value_or(0);
        return Pattern{name.substr(0, percent), name.substr(end + 1),
                       static_cast<int>(std::min<long long>(width, widest))};
    }
    // As many digits as there are signs; a single one is a name like any other.
    for (std::size_t begin = name.find_first_of("#@"); begin != std::string::npos;) {
        const std::size_t end = std::min(name.find_first_not_of(name[begin], begin), name.size());
        if (end - begin >= 2 && end - begin <= widest)
            return Pattern{name.substr(0, begin), name.substr(end), static_cast<int>(end - begin)};
        begin = name.find_first_of("#@", end);
    }
    return parse_dollar(name);
}

/// No frames in brackets: all.
Result<std::optional<FrameSet>> take_frames(std::string& input) {
    const std::size_t open = input.rfind('[');
    if (open == std::string::npos || !input.ends_with(']')) return std::optional<FrameSet>();
    Result<FrameSet> frames = FrameSet::parse(std::string_view(input).substr(open + 1, input.size() - open - 2));
    if (!frames) return user_error(fmt::format("{}: {}", input, frames.error().text));
    input.resize(open);
    return std::optional(std::move(*frames));
}

/// Of files whose numbers nobody has told.
struct Found {
    fs::path path;
    std::optional<long long> number;
};

std::vector<std::string_view> digits_of(std::string_view text) {
    std::vector<std::string_view> out;
    for (std::size_t begin = 0; begin < text.size();) {
        std::size_t end = begin;
        while (end < text.size() && is_digit(text[end])) ++end;
        if (end > begin) out.push_back(text.substr(begin, end - begin));
        begin = std::max(end, begin + 1);
    }
    return out;
}

/// The text without its digits: names that differ in numbers alone have the same.
std::string without_digits(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (!is_digit(text[i]))
            out += text[i];
        else if (i == 0 || !is_digit(text[i - 1]))
            out += '\0';
    }
    return out;
}

/// Of files that differ in one group of digits alone, that is the number.
std::optional<std::size_t> group_that_differs(const std::vector<Found>& files) {
    const std::string first = files.front().path.stem().string();
    const std::vector<std::string_view> groups = digits_of(first);
    std::optional<std::size_t> out;
    for (const Found& file : files) {
        const std::string stem = file.path.stem().string();
        if (without_digits(stem) != without_digits(first)) return std::nullopt;
        const std::vector<std::string_view> theirs = digits_of(stem);
        for (std::size_t i = 0; i < groups.size(); ++i) {
            if (theirs[i] == groups[i]) continue;
            if (out && *out != i) return std::nullopt;
            out = i;
        }
    }
    return out;
}

void number_by_names(std::vector<Found>& files) {
    const bool is_told = std::ranges::any_of(files, [](const Found& file) { return file.number.has_value(); });
    const std::optional<std::size_t> group = is_told || files.size() < 2 ? std::nullopt : group_that_differs(files);
    for (Found& file : files) {
        if (file.number) continue;
        const std::string stem = file.path.stem().string();
        file.number = group ? whole_number(digits_of(stem)[*group]) : frame_number(file.path);
    }
}

Result<> expand(std::string input, std::vector<Found>& files) {
    const std::string given = input;
    std::error_code code;
    if (!has_number_pattern(input) || fs::exists(input, code)) {
        files.push_back({std::move(input), std::nullopt});
        return {};
    }
    DARKROOM_TRY_VALUE(const std::optional<FrameSet> frames, take_frames(input));
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
        if (!number || (frames && !frames->contains(*number))) continue;
        const std::vector<std::string> names = pattern.names(*number);
        if (std::ranges::find(names, name) == names.end()) continue;
        found.emplace_back(*number, path.has_parent_path() ? folder / name : fs::path(name));
    }
    if (code) return user_error(fmt::format("{}: cannot list the folder: {}", given, code.message()));
    if (found.empty()) return user_error(fmt::format("{}: no file matches", given));
    std::sort(found.begin(), found.end());
    const auto twice = std::ranges::adjacent_find(found, {}, &std::pair<long long, fs::path>::first);
    if (twice != found.end())
        return user_error(fmt::format("{}: {} and {} are both frame {}", given, twice->second.filename().string(),
                                      std::next(twice)->second.filename().string(), twice->first));
    for (auto& [number, file] : found) files.push_back({std::move(file), number});
    return {};
}

}  // namespace

bool has_number_pattern(const fs::path& path) { return parse(path.filename().string()).has_value(); }

fs::path numbered(const fs::path& pattern, long long number) {
    const auto parsed = parse(pattern.filename().string());
    return parsed ? pattern.parent_path() / parsed->name(number) : pattern;
}

std::vector<fs::path> spellings(const fs::path& pattern, long long number) {
    const auto parsed = parse(pattern.filename().string());
    if (!parsed) return {pattern};
    std::vector<fs::path> out;
    for (const std::string& name : parsed->names(number)) out.push_back(pattern.parent_path() / name);
    return out;
}

std::optional<long long> frame_number(const fs::path& path) {
    const std::string stem = path.stem().string();
    std::string_view last;
    for (const std::string_view group : digits_of(stem)) {
        const std::size_t at = static_cast<std::size_t>(group.data() - stem.data());
        const bool is_version = at > 0 && (stem[at - 1] == 'v' || stem[at - 1] == 'V') &&
                                (at == 1 || std::isalpha(static_cast<unsigned char>(stem[at - 2])) == 0);
        if (!is_version || last.empty()) last = group;
    }
    return whole_number(last);
}

Result<std::vector<NumberedFile>> expand_inputs(std::span<const std::string> inputs) {
    std::vector<Found> files;
    for (const std::string& input : inputs) DARKROOM_TRY(expand(input, files));
    number_by_names(files);
    std::vector<NumberedFile> out;
    std::set<long long> seen;
    for (Found& file : files)
        if (file.number && seen.insert(*file.number).second) out.push_back({file.path, *file.number});
    if (out.size() == files.size()) return out;
    out.clear();
    for (Found& file : files) out.push_back({std::move(file.path), static_cast<long long>(out.size()) + 1});
    return out;
}

}  // namespace darkroom
