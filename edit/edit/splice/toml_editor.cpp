// SPDX-License-Identifier: MIT
#include "edit/splice/toml_editor.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <map>

#include "core/text/param_text.hpp"
#include "looks/apply/look_resources.hpp"
#include "toml/toml_text.hpp"

namespace darkroom::edit {

namespace {

TomlPath joined(const TomlPath& table, std::string_view key) {
    TomlPath out = table;
    out.emplace_back(key);
    return out;
}

std::string shown(const TomlPath& path) { return printable(fmt::format("{}", fmt::join(path, "."))); }

/// Numbers and the like in a value, by their place in it: those of a vector written as a table have its letters.
using Leaves = std::map<TomlPath, std::pair<std::size_t, std::size_t>>;
Leaves leaves_of(std::span<const TomlItem> items, const TomlPath& path) {
    Leaves out;
    for (const TomlItem& item : items) {
        if (item.kind != TomlItem::Kind::Value || !is_within(item.path, path)) continue;
        const TomlPath own(item.path.begin() + static_cast<std::ptrdiff_t>(path.size()), item.path.end());
        if (!own.empty()) out.erase(TomlPath(own.begin(), own.end() - 1));
        out[own] = {item.value_begin, item.end};
    }
    return out;
}

/// The letters of vectors and colours as numbers.
TomlPath numbered(TomlPath path) {
    constexpr std::string_view letters = "xyzwrgb";
    for (std::string& part : path)
        if (const std::size_t at = letters.find(part); part.size() == 1 && at != std::string_view::npos)
            part = std::to_string(at % 4);
    return path;
}

/// Do both read as the same value of a parameter?
bool reads_same(std::string_view a, std::string_view b) {
    const toml::parse_result parsed = toml::parse(fmt::format("a = {}\nb = {}", a, b));
    if (!parsed) return false;
    const toml::node_view x = parsed.table()["a"], y = parsed.table()["b"];
    if (!x.is_number() || !y.is_number()) return a == b;
    const auto bits = [](double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value)); };
    return bits(*x.value<double>()) == bits(*y.value<double>());
}

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r\n") == std::string_view::npos; }

}  // namespace

std::string toml_key(std::string_view name) {
    constexpr std::string_view bare = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    const bool is_bare = !name.empty() && name.find_first_not_of(bare) == std::string_view::npos;
    return is_bare ? std::string(name) : toml_string(name);
}

Result<TomlEditor> TomlEditor::of(std::string text) {
    TomlEditor out;
    out.text_ = std::move(text);
    DARKROOM_TRY(out.rescan());
    return out;
}

Result<> TomlEditor::rescan() {
    DARKROOM_TRY_VALUE(items_, items_of(text_));
    return {};
}

Result<> TomlEditor::replace(std::size_t begin, std::size_t end, std::string_view with) {
    text_.replace(begin, end - begin, with);
    return rescan();
}

const TomlItem* TomlEditor::find(const TomlPath& path) const {
    const auto found = std::ranges::find_if(
        items_, [&](const TomlItem& item) { return item.kind == TomlItem::Kind::Value && item.path == path; });
    return found == items_.end() ? nullptr : &*found;
}

bool TomlEditor::contains(const TomlPath& path) const {
    return std::ranges::any_of(items_, [&](const TomlItem& item) { return is_within(item.path, path); });
}

std::string_view TomlEditor::line_end() const {
    const std::size_t at = text_.find('\n');
    return at != std::string::npos && at > 0 && text_[at - 1] == '\r' ? "\r\n" : "\n";
}

std::size_t TomlEditor::line_begin(std::size_t at) const {
    const std::size_t before = at == 0 ? std::string::npos : text_.rfind('\n', at - 1);
    if (before != std::string::npos) return before + 1;
    return text_.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
}

std::size_t TomlEditor::line_end_at(std::size_t at) const {
    const std::size_t next = text_.find('\n', at);
    return next == std::string::npos ? text_.size() : next + 1;
}

Result<> TomlEditor::set(const TomlPath& table, std::string_view key, std::string_view value,
                         std::span<const std::string> neighbours) {
    const TomlPath path = joined(table, key);
    if (contains(path)) return replace_value(path, value);
    return add(table, fmt::format("{} = {}", toml_key(key), value), neighbours);
}

Result<> TomlEditor::replace_value(const TomlPath& path, std::string_view value) {
    const std::string next = fmt::format("v = {}", value);
    DARKROOM_TRY_VALUE(const auto wanted, items_of(next));
    const Leaves old = leaves_of(items_, path), now = leaves_of(wanted, {"v"});
    Leaves old_numbered;
    for (const auto& [own, span] : old) old_numbered[numbered(own)] = span;
    const auto path_of = [](const Leaves::value_type& leaf) { return leaf.first; };
    if (!std::ranges::equal(old_numbered, now, {}, path_of, path_of)) {
        const TomlItem* const whole = find(path);
        if (whole == nullptr)
            return user_error(fmt::format("{}: this value cannot be rewritten in its place", shown(path)));
        return replace(whole->value_begin, whole->end, value);
    }
    // From the last to the first, so that places stay true.
    std::vector<std::pair<std::size_t, std::pair<std::size_t, std::string_view>>> changes;
    for (const auto& [own, span] : old_numbered) {
        const auto [begin, end] = now.at(own);
        const std::string_view text = std::string_view(next).substr(begin, end - begin);
        if (!reads_same(std::string_view(text_).substr(span.first, span.second - span.first), text))
            changes.push_back({span.first, {span.second, text}});
    }
    std::ranges::sort(changes, std::greater<>());
    for (const auto& [begin, change] : changes) text_.replace(begin, change.first - begin, change.second);
    return rescan();
}

Result<> TomlEditor::add(const TomlPath& table, std::string_view pair, std::span<const std::string> neighbours) {
    if (const TomlItem* const whole = find(table)) return add_inside(*whole, pair);
    const TomlItem *last = nullptr, *near = nullptr, *header = nullptr;
    for (const TomlItem& item : items_) {
        if (item.kind != TomlItem::Kind::Value && item.path == table) header = &item;
        // Behind what stands in a table of its own below this one, a key would be that one's.
        const bool is_own = item.kind == TomlItem::Kind::Value && !item.is_inside && is_within(item.path, table) &&
                            item.header_size <= table.size();
        if (!is_own) continue;
        last = &item;
        if (std::ranges::count(neighbours, item.path[table.size()]) > 0) near = &item;
    }
    for (const TomlItem* const behind : {near, last, header})
        if (behind != nullptr) {
            std::string dotted;
            for (std::size_t i = behind->header_size; i < table.size(); ++i) dotted += toml_key(table[i]) + ".";
            return add_line(*behind, dotted + std::string(pair));
        }
    if (table.empty()) return add_first(pair);
    if (table.size() > 1) return user_error(fmt::format("{}: there is no such table", shown(table)));
    DARKROOM_TRY(add_table(table[0]));
    return add_line(items_.back(), pair);
}

Result<> TomlEditor::add_inside(const TomlItem& table, std::string_view pair) {
    if (text_[table.value_begin] != '{') return user_error(fmt::format("{}: is not a table", shown(table.path)));
    const TomlItem* last = nullptr;
    for (const TomlItem& item : items_)
        if (item.is_inside && item.path.size() > table.path.size() && is_within(item.path, table.path) &&
            item.header_size == table.path.size())
            last = &item;
    if (last != nullptr) return replace(last->end, last->end, fmt::format(", {}", pair));
    return replace(table.value_begin, table.end, fmt::format("{{ {} }}", pair));
}

Result<> TomlEditor::add_line(const TomlItem& behind, std::string_view pair) {
    const std::size_t first = line_begin(behind.begin), at = line_end_at(behind.end);
    const std::string_view before = std::string_view(text_).substr(first, behind.begin - first);
    const std::string_view indent = is_blank(before) ? before : std::string_view();
    const bool has_end = at > 0 && text_[at - 1] == '\n';
    const std::string line =
        has_end ? fmt::format("{}{}{}", indent, pair, line_end()) : fmt::format("{}{}{}", line_end(), indent, pair);
    return replace(at, at, line);
}

Result<> TomlEditor::add_first(std::string_view pair) {
    if (items_.empty()) {
        const std::string_view before = text_.empty() || text_.ends_with('\n') ? std::string_view() : line_end();
        return replace(text_.size(), text_.size(), fmt::format("{}{}{}", before, pair, line_end()));
    }
    const std::size_t at = line_begin(items_.front().begin);
    return replace(at, at, fmt::format("{}{}{}", pair, line_end(), line_end()));
}

Result<> TomlEditor::add_table(std::string_view name) {
    std::string out;
    if (!text_.empty() && !text_.ends_with('\n')) out += line_end();
    if (!is_blank(text_)) out += line_end();
    return replace(text_.size(), text_.size(), fmt::format("{}[{}]{}", out, toml_key(name), line_end()));
}

Result<> TomlEditor::remove(const TomlPath& table, std::string_view key) {
    const TomlItem* const item = find(joined(table, key));
    if (item == nullptr) return {};
    if (!item->is_inside) return replace(line_begin(item->begin), line_end_at(item->end), {});
    std::size_t begin = item->begin, end = text_.find_first_not_of(" \t\r\n", item->end);
    if (text_[end] == ',') {
        end = text_.find_first_not_of(" \t", end + 1);
    } else {
        end = item->end;
        const std::size_t comma = text_.find_last_not_of(" \t\r\n", begin - 1);
        if (text_[comma] == ',') begin = comma;
    }
    return replace(begin, end, {});
}

Result<std::size_t> TomlEditor::remove_table(const TomlPath& table) {
    std::size_t place = std::string::npos;
    for (std::size_t i = items_.size(); i-- > 0;) {
        const TomlItem& item = items_[i];
        if (item.is_inside || !is_within(item.path, table)) continue;
        const std::size_t begin = line_begin(item.begin);
        const std::size_t size = line_end_at(item.end) - begin;
        text_.erase(begin, size);
        if (item.kind != TomlItem::Kind::Value)
            place = begin;
        else if (place != std::string::npos && begin < place)
            place -= size;
    }
    DARKROOM_TRY(rescan());
    return std::min(place, text_.size());
}

}  // namespace darkroom::edit
