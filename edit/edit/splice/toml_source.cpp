// SPDX-License-Identifier: MIT
#include "edit/splice/toml_source.hpp"

#include <algorithm>
#include <map>

#include "toml/toml_text.hpp"

namespace darkroom::edit {

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
