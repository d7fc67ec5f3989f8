// SPDX-License-Identifier: MIT
#include "image/frame/frame_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>

namespace darkroom {
namespace {

constexpr std::string_view expected = "expected A, A-B or A-BxSTEP, several with commas";

/// Takes a number off the front of a text.
std::optional<long long> take_number(std::string_view& text) {
    long long number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

}  // namespace

Result<FrameSet::Range> FrameSet::parse_range(std::string_view text) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    const std::optional<long long> first = take_number(text);
    if (!first) return user_error(std::string(expected));
    Range range{.first = *first, .last = *first};
    if (text.starts_with('-')) {
        text.remove_prefix(1);
        const std::optional<long long> last = take_number(text);
        if (!last) return user_error(std::string(expected));
        range.last = *last;
        if (text.starts_with('x')) {
            text.remove_prefix(1);
            const std::optional<long long> step = take_number(text);
            if (!step) return user_error(std::string(expected));
            range.step = *step;
        }
    }
    if (!text.empty()) return user_error(std::string(expected));
    for (const long long number : {range.first, range.last})
        if (std::abs(number) > max_number)
            return user_error(fmt::format("{}: whole numbers in [-{}, {}]", expected, max_number, max_number));
    if (range.step < 1 || range.step > max_number)
        return user_error(fmt::format("a step of {}: [1, {}] is allowed", range.step, max_number));
    if (range.last < range.first) return user_error("the last frame is before the first");
    return range;
}

Result<FrameSet> FrameSet::parse(std::string_view text) {
    FrameSet out;
    for (;;) {
        const std::size_t comma = text.find(',');
        DARKROOM_TRY_VALUE(const Range range, parse_range(text.substr(0, comma)));
        out.ranges_.push_back(range);
        if (out.ranges_.size() > max_ranges) return user_error(fmt::format("at most {} ranges", max_ranges));
        if (comma == std::string_view::npos) return out;
        text.remove_prefix(comma + 1);
    }
}

bool FrameSet::contains(long long number) const {
    return std::ranges::any_of(ranges_, [&](const Range& range) { return range.contains(number); });
}

std::size_t FrameSet::count() const {
    std::size_t out = 0;
    for (const Range& range : ranges_) out += static_cast<std::size_t>((range.last - range.first) / range.step) + 1;
    return out;
}

std::vector<long long> FrameSet::numbers() const {
    std::set<long long> out;
    for (const Range& range : ranges_)
        for (long long number = range.first; number <= range.last; number += range.step) out.insert(number);
    return {out.begin(), out.end()};
}

std::string frame_set_text(const std::vector<long long>& numbers) {
    std::string out;
    for (std::size_t i = 0; i < numbers.size();) {
        std::size_t last = i;
        const long long step = i + 1 < numbers.size() ? numbers[i + 1] - numbers[i] : 1;
        while (last + 1 < numbers.size() && numbers[last + 1] - numbers[last] == step) ++last;
        // Two numbers are no progression, unless they are neighbours.
        if (last == i + 1 && step > 1) last = i;
        if (!out.empty()) out += ',';
        out += fmt::format("{}", numbers[i]);
        if (last > i) out += fmt::format("-{}", numbers[last]);
        if (last > i && step > 1) out += fmt::format("x{}", step);
        i = last + 1;
    }
    return out;
}

}  // namespace darkroom
