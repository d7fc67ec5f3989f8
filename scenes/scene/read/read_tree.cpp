// SPDX-License-Identifier: MIT
#include "read_values.hpp"

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

namespace {

// Bounds on what prefabs multiply, and on the depth that copies and destructors of trees recurse to.
constexpr std::size_t max_members = 1'000'000;
constexpr int deepest = 8;

}  // namespace

const Value* find(const Value& table, std::string_view key) {
    const auto found = std::lower_bound(table.members.begin(), table.members.end(), key,
                                        [](const Member& member, std::string_view name) { return member.key < name; });
    return found != table.members.end() && found->key == key ? &found->value : nullptr;
}

std::size_t member_count(const Value& table) {
    std::size_t count = table.members.size();
    for (const Member& member : table.members) count += member_count(member.value);
    return count;
}

void merge(Value& base, const Value& over) {
    if (!base.is_table() || !over.is_table()) {
        base = over;
        return;
    }
    std::vector<Member> merged;
    merged.reserve(base.members.size() + over.members.size());
    auto below = base.members.begin();
    for (const Member& member : over.members) {
        while (below != base.members.end() && below->key < member.key) merged.push_back(std::move(*below++));
        if (below == base.members.end() || below->key != member.key) {
            merged.push_back(member);
            continue;
        }
        merged.push_back(std::move(*below++));
        merge(merged.back().value, member.value);
        merged.back().place = member.place;
    }
    std::move(below, base.members.end(), std::back_inserter(merged));
    base.members = std::move(merged);
}

std::string show(const Value& value) {
    constexpr std::size_t max_numbers = 4;
    if (value.node == nullptr) return "nothing";
    const toml::array* const array = value.node->as_array();
    if (array == nullptr || array->empty() || array->size() > max_numbers) return darkroom::show(*value.node);
    std::vector<std::string> elements;
    for (const toml::node& element : *array) {
        if (element.is_array() || element.is_table()) return darkroom::show(*value.node);
        elements.push_back(darkroom::show(element));
    }
    return fmt::format("[{}]", fmt::join(elements, ", "));
}

std::string with_prefix(std::string_view text, std::string_view prefix) {
    std::string out;
    while (true) {
        const std::size_t mark = text.find(prefix_mark);
        out += text.substr(0, mark);
        if (mark == std::string_view::npos) return out;
        out += prefix;
        text.remove_prefix(mark + prefix_mark.size());
    }
}

std::string_view TreeBuilder::keep(std::string text) { return texts_.emplace_back(std::move(text)); }

bool TreeBuilder::charge(std::size_t members, Place place) {
    if (members > max_members - members_) {
        report_.error(place, [] { return fmt::format("the scene holds more than {} values", max_members); });
        return false;
    }
    members_ += members;
    return true;
}

Value TreeBuilder::build(const toml::node& node, std::uint32_t file, const std::string* prefix) {
    return build(node, file, prefix, 0);
}

Value TreeBuilder::build(const toml::node& node, std::uint32_t file, const std::string* prefix, int depth) {
    Value value{.node = &node, .place = place_of(node.source(), file)};
    if (const auto* const text = node.as_string()) {
        value.text = text->get();
        if (prefix != nullptr && value.text.find(prefix_mark) != std::string_view::npos)
            value.text = keep(with_prefix(value.text, *prefix));
    }
    const toml::table* const table = node.as_table();
    if (table == nullptr || depth == deepest) return value;
    if (!charge(table->size(), value.place)) return value;
    value.members.reserve(table->size());
    for (const auto& [key, child] : *table)
        value.members.push_back({key.str(), place_of(key.source(), file), build(child, file, prefix, depth + 1)});
    return value;
}

}  // namespace darkroom::scene::reading
