// SPDX-License-Identifier: MIT
// The names of parameters: keys, flags, suggestions, and text that is fit to be printed.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "core/text/param_text.hpp"

namespace darkroom {

namespace {

// Wagner and Fischer, "The String-to-String Correction Problem", 1974, and a swap of neighbours as one edit
// (Damerau, "A technique for computer detection and correction of spelling errors", 1964).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
            const bool is_swap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (is_swap) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

// Length of the UTF-8 sequence at the start of `text`, 0 if it is none that may be printed.
std::size_t sequence_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
    const std::size_t size = first >= 0xc2 && first < 0xe0   ? 2
                             : first >= 0xe0 && first < 0xf0 ? 3
                             : first >= 0xf0 && first < 0xf5 ? 4
                                                             : 0;
    if (size == 0 || text.size() < size) return 0;
    for (std::size_t i = 1; i < size; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    if (first == 0xc2 && byte(1) < 0xa0) return 0;                                          // C1 controls
    if ((first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) >= 0xa0)) return 0;  // overlong, surrogates
    if ((first == 0xf0 && byte(1) < 0x90) || (first == 0xf4 && byte(1) >= 0x90)) return 0;
    // Line and paragraph separators, and the marks that turn the direction of what follows.
    const bool is_e2_80 = first == 0xe2 && byte(1) == 0x80;
    if (is_e2_80 && ((byte(2) >= 0xa8 && byte(2) <= 0xae) || byte(2) == 0x8e || byte(2) == 0x8f)) return 0;
    if (first == 0xe2 && byte(1) == 0x81 && byte(2) >= 0xa6 && byte(2) <= 0xa9) return 0;
    return size;
}

}  // namespace

std::string flat_key(std::string_view effect, std::string_view member) {
    if (member == effect) return std::string(effect);
    return fmt::format("{}_{}", effect, member);
}

std::string flag_name(std::string_view key) {
    std::string out = fmt::format("--{}", key);
    std::replace(out.begin(), out.end(), '_', '-');
    return out;
}

std::string nearest(std::string_view wrong, std::span<const std::string> names) {
    constexpr std::size_t longest = 64;  // a name longer than this is no slip of the hand
    if (wrong.size() > longest) return {};
    std::string_view best;
    std::size_t smallest = std::max<std::size_t>(2, wrong.size() / 3) + 1;
    for (const std::string& name : names) {
        const std::size_t distance = edit_distance(wrong, name);
        if (distance < smallest && distance < name.size()) {
            smallest = distance;
            best = name;
        }
    }
    // "tonemap" of "tonemap_curve": the first that goes on behind it.
    for (const std::string& name : names)
        if (best.empty() && wrong.size() > 1 && name.starts_with(wrong) && name.find_first_of("_-", 2) == wrong.size())
            best = name;
    return std::string(best);
}

std::string suggestion(std::string_view wrong, std::span<const std::string> names) {
    const std::string name = nearest(wrong, names);
    return name.empty() ? std::string() : fmt::format(", did you mean '{}'?", name);
}

std::string some_of(std::span<const std::string> names, std::string_view last) {
    constexpr std::size_t most = 12;
    // A list is not cut for the sake of one name.
    const std::size_t count = names.size() <= most + 1 ? names.size() : most;
    if (count < names.size())
        return fmt::format("{} and {} more", fmt::join(names.first(count), ", "), names.size() - count);
    if (count < 2) return names.empty() ? "none" : names.front();
    return fmt::format("{} {} {}", fmt::join(names.first(count - 1), ", "), last, names.back());
}

std::string alternatives(std::string_view wrong, std::span<const std::string> names, std::string_view lead) {
    const std::string near = suggestion(wrong, names);
    return fmt::format("{} {} {}", near.empty() ? ":" : near, lead,
                       some_of(names, lead.starts_with("allowed") ? "or" : "and"));
}

std::string printable(std::string_view text) {
    constexpr std::size_t longest = 200;
    std::string out;
    while (!text.empty() && out.size() < longest) {
        const std::size_t size = sequence_length(text);
        if (size == 0) {
            out += fmt::format("\\x{:02X}", static_cast<unsigned char>(text[0]));
            text.remove_prefix(1);
            continue;
        }
        out += text.substr(0, size);
        text.remove_prefix(size);
    }
    if (!text.empty()) out += "...";
    return out;
}

}  // namespace darkroom
