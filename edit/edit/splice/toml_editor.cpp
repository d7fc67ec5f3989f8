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

namespace {

/// What a key in quotes says.
std::string unquoted(std::string_view token) {
    const toml::parse_result parsed = toml::parse("v = " + std::string(token));
    return parsed ? parsed.table()["v"].value_or(std::string()) : std::string();
}

class Scanner {
  public:
    explicit Scanner(std::string_view text) : text_(text) {}

    Result<std::vector<TomlItem>> run() {
        if (text_.starts_with(byte_order_mark)) at_ = byte_order_mark.size();
        for (skip_lines(); at_ < text_.size() && !is_wrong_; skip_lines()) {
            if (text_[at_] == '[')
                read_header();
            else
                read_pair(table_, false);
        }
        if (is_wrong_) return user_error("the text is not TOML");
        return std::move(items_);
    }

  private:
    [[nodiscard]] char peek(std::size_t ahead = 0) const {
        return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
    }
    void expect(char c) {
        if (peek() == c)
            ++at_;
        else
            is_wrong_ = true;
    }
    void skip_blanks() {
        while (peek() == ' ' || peek() == '\t') ++at_;
    }
    void skip_comment() {
        if (peek() == '#') at_ = std::min(text_.find('\n', at_), text_.size());
    }
    /// Blanks, ends of lines and comments.
    void skip_lines() {
        for (;;) {
            while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) ++at_;
            if (peek() != '#') return;
            skip_comment();
        }
    }

    std::string read_key_part() {
        const std::size_t begin = at_;
        if (peek() == '"' || peek() == '\'') {
            skip_string();
            return unquoted(text_.substr(begin, at_ - begin));
        }
        at_ = std::min(text_.find_first_of(" \t.=]\r\n#", at_), text_.size());
        is_wrong_ |= at_ == begin;
        return std::string(text_.substr(begin, at_ - begin));
    }
    TomlPath read_key() {
        TomlPath out;
        for (;;) {
            skip_blanks();
            out.push_back(read_key_part());
            skip_blanks();
            if (peek() != '.' || is_wrong_) return out;
            ++at_;
        }
    }

    void read_header() {
        const std::size_t begin = at_++;
        const bool is_array = peek() == '[';
        if (is_array) ++at_;
        const TomlPath key = read_key();
        expect(']');
        if (is_array) expect(']');
        table_.clear();
        for (const std::string& part : key) {
            table_.push_back(part);
            const bool is_new = is_array && &part == &key.back();
            const auto found = is_new ? counts_.try_emplace(table_, 0).first : counts_.find(table_);
            if (found == counts_.end()) continue;
            if (is_new) ++found->second;
            table_.push_back(std::to_string(found->second - 1));
        }
        items_.push_back({.kind = is_array ? TomlItem::Kind::ArrayTable : TomlItem::Kind::Table,
                          .path = table_,
                          .begin = begin,
                          .value_begin = begin,
                          .end = at_,
                          .header_size = table_.size()});
    }

    void read_pair(const TomlPath& table, bool is_inside) {
        const std::size_t begin = at_;
        TomlPath path = table;
        for (std::string& part : read_key()) path.push_back(std::move(part));
        expect('=');
        skip_blanks();
        read_value(path, begin, table.size(), is_inside);
    }

    void read_value(const TomlPath& path, std::size_t begin, std::size_t header_size, bool is_inside) {
        if (is_wrong_) return;
        const std::size_t place = items_.size(), value_begin = at_;
        items_.push_back({.path = path,
                          .begin = begin,
                          .value_begin = value_begin,
                          .header_size = header_size,
                          .is_inside = is_inside});
        if (peek() == '[')
            read_array(path);
        else if (peek() == '{')
            read_inline_table(path);
        else if (peek() == '"' || peek() == '\'')
            skip_string();
        else
            skip_scalar();
        items_[place].end = at_;
        is_wrong_ |= at_ == value_begin;
    }

    void read_array(const TomlPath& path) {
        ++at_;
        skip_lines();
        for (std::size_t number = 0; peek() != ']' && !is_wrong_ && at_ < text_.size(); ++number) {
            TomlPath own = path;
            own.push_back(std::to_string(number));
            read_value(own, at_, own.size(), true);
            skip_lines();
            if (peek() == ',') ++at_;
            skip_lines();
        }
        expect(']');
    }

    void read_inline_table(const TomlPath& path) {
        ++at_;
        skip_lines();
        while (peek() != '}' && !is_wrong_ && at_ < text_.size()) {
            read_pair(path, true);
            skip_lines();
            if (peek() == ',') ++at_;
            skip_lines();
        }
        expect('}');
    }

    void skip_string() {
        const char quote = peek();
        const bool is_long = peek(1) == quote && peek(2) == quote;
        at_ += is_long ? 3 : 1;
        for (; at_ < text_.size(); ++at_) {
            if (text_[at_] == '\\' && quote == '"') {
                ++at_;
            } else if (text_[at_] == quote && (!is_long || (peek(1) == quote && peek(2) == quote))) {
                at_ += is_long ? 3 : 1;
                // Up to two quotes of a long string's own may stand in front of those that end it.
                for (int i = 0; is_long && i < 2 && peek() == quote; ++i) ++at_;
                return;
            }
        }
        is_wrong_ = true;
    }

    /// A number, a boolean, or a date, which may hold a blank.
    void skip_scalar() {
        const std::size_t begin = at_;
        at_ = std::min(text_.find_first_of(",]}#\r\n", at_), text_.size());
        while (at_ > begin && (text_[at_ - 1] == ' ' || text_[at_ - 1] == '\t')) --at_;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    bool is_wrong_ = false;
    TomlPath table_;                          ///< of the header above
    std::map<TomlPath, std::size_t> counts_;  ///< of the elements of arrays of tables
    std::vector<TomlItem> items_;
};

}  // namespace

bool is_within(const TomlPath& path, const TomlPath& of) {
    return path.size() >= of.size() && std::equal(of.begin(), of.end(), path.begin());
}

Result<std::vector<TomlItem>> items_of(std::string_view text) { return Scanner(text).run(); }

}  // namespace darkroom::edit
