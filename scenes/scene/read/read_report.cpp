// SPDX-License-Identifier: MIT
#include "scene/read/read_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/text/param_text.hpp"

namespace darkroom::scene::reading {

std::uint32_t Report::add_file(std::string shown_name) {
    shown_names_.push_back(std::move(shown_name));
    return static_cast<std::uint32_t>(shown_names_.size() - 1);
}

std::string Report::show(Place place) const {
    return fmt::format("{}:{}:{}", shown_names_[place.file], place.line, place.column);
}

std::string Report::suggestion(std::string_view wrong, std::span<const std::string> names) {
    constexpr std::size_t max_names = 2000;
    if (++suggestions_ > max_suggestions) return {};
    return darkroom::suggestion(wrong, names.first(std::min(names.size(), max_names)));
}

std::vector<std::string> Report::lines(Problems& problems) const {
    std::stable_sort(problems.kept.begin(), problems.kept.end(),
                     [](const Problem& a, const Problem& b) { return a.place < b.place; });
    std::vector<std::string> out;
    for (const Problem& problem : problems.kept) {
        if (out.size() == max_shown) break;
        out.push_back(fmt::format("{}: {}", show(problem.place), problem.text));
    }
    if (problems.count > out.size())
        out.push_back(fmt::format("{}: and {} more", shown_names_.front(), problems.count - out.size()));
    return out;
}

Result<> Report::finish(std::vector<std::string>* warnings) {
    const std::vector<std::string> slips = lines(warnings_), errors = lines(errors_);
    if (warnings != nullptr) warnings->insert(warnings->end(), slips.begin(), slips.end());
    if (!errors.empty()) return user_error(fmt::format("{}", fmt::join(errors, "; ")));
    return {};
}

}  // namespace darkroom::scene::reading
