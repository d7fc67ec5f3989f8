// SPDX-License-Identifier: MIT
#include "c_tokens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "core/text/param_text.hpp"

namespace app {

namespace {

using darkroom::Result;

constexpr std::size_t max_size = std::size_t{1} << 20;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Takes what begins `text` and is all `is_part`.
template <class IsPart>
std::string_view take(std::string_view& text, const IsPart& is_part) {
    const auto end = std::ranges::find_if_not(text, is_part);
    const std::string_view taken = text.substr(0, static_cast<std::size_t>(end - text.begin()));
    text.remove_prefix(taken.size());
    return taken;
}

class Lines {
  public:
    [[nodiscard]] std::vector<CToken> tokens() && { return std::move(tokens_); }
    /// What is wrong with the line.
    [[nodiscard]] std::optional<std::string> add(std::string_view line) {
        ++line_;
        line = trimmed(line);
        if (line.starts_with('#')) return add_directive(trimmed(line.substr(1)));
        if (depth_ > 0) return {};
        if (line.starts_with("/*"))
            return line.find("*/") == line.size() - 2 ? std::nullopt
                                                      : std::optional("a comment of this kind takes one line");
        return add_words(line);
    }
    [[nodiscard]] std::optional<std::string> end() {
        if (depth_ > 0 || is_guard_open_) return "a #if has no #endif";
        add(CToken::Kind::End, "");
        return {};
    }

  private:
    void add(CToken::Kind kind, std::string_view text) { tokens_.push_back({kind, std::string(text), line_}); }

    [[nodiscard]] std::optional<std::string> add_directive(std::string_view line) {
        const std::string_view name = take(line, is_letter);
        line = trimmed(line);
        if (name.starts_with("if")) {
            if (depth_ == 0 && guard_.empty() && name == "ifndef") {
                guard_ = line;
                is_guard_open_ = true;
            } else {
                ++depth_;
            }
            return {};
        }
        if (name == "endif") {
            if (depth_ == 0 && !is_guard_open_) return "a #endif has no #if";
            if (depth_ > 0)
                --depth_;
            else
                is_guard_open_ = false;
            return {};
        }
        if (depth_ > 0 || name == "include") return {};
        if (name != "define") return "expected #if, #endif, #include or #define";
        if (line == guard_) return {};
        return add_define(line);
    }
    [[nodiscard]] std::optional<std::string> add_define(std::string_view line) {
        const auto is_part = [](char c) { return is_letter(c) || is_digit(c); };
        const std::string_view name = take(line, is_part);
        line = trimmed(line);
        constexpr std::string_view wide = "UINT64_C(";
        const bool is_wide = line.starts_with(wide) && line.ends_with(')');
        if (is_wide) line = line.substr(wide.size(), line.size() - wide.size() - 1);
        if (name.empty() || line.empty() || !std::ranges::all_of(line, is_digit))
            return "expected #define NAME NUMBER, the number as digits or UINT64_C(digits)";
        add(CToken::Kind::Define, name);
        if (is_wide) add(CToken::Kind::Name, wide.substr(0, wide.size() - 1));
        add(CToken::Kind::Number, line);
        return {};
    }
    [[nodiscard]] std::optional<std::string> add_words(std::string_view line) {
        while (!line.empty()) {
            if (line.starts_with("//")) {
                if (line.starts_with("///<"))
                    add(CToken::Kind::DocBehind, trimmed(line.substr(4)));
                else if (line.starts_with("///"))
                    add(CToken::Kind::Doc, trimmed(line.substr(3)));
                return {};
            }
            if (is_letter(line.front())) {
                add(CToken::Kind::Name, take(line, [](char c) { return is_letter(c) || is_digit(c); }));
            } else if (is_digit(line.front())) {
                add(CToken::Kind::Number, take(line, is_digit));
            } else if (std::string_view("{}()[];,*=").find(line.front()) != std::string_view::npos) {
                add(CToken::Kind::Sign, line.substr(0, 1));
                line.remove_prefix(1);
            } else {
                return fmt::format("expected a name, a number or one of {{}}()[];,*= and not '{}'",
                                   darkroom::printable(line.substr(0, 1)));
            }
            line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        }
        return {};
    }

    std::vector<CToken> tokens_;
    std::size_t line_ = 0;
    std::size_t depth_ = 0;  // of #if that are passed over
    std::string guard_;
    bool is_guard_open_ = false;
};

}  // namespace

darkroom::Failure c_error(std::string_view text, std::string_view shown, std::size_t line, std::string_view fault) {
    for (std::size_t i = 1; i < line; ++i) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    const std::string_view there = trimmed(text.substr(0, text.find('\n')));
    return darkroom::user_error(
        fmt::format("{}:{}: '{}': {}", darkroom::printable(shown), line, darkroom::printable(there), fault));
}

Result<std::vector<CToken>> c_tokens(std::string_view text, std::string_view shown) {
    if (text.size() > max_size)
        return darkroom::user_error(
            fmt::format("{}: {} bytes, allowed are at most {}", darkroom::printable(shown), text.size(), max_size));
    Lines lines;
    std::size_t number = 0;
    std::string_view rest = text;
    while (!rest.empty()) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
        ++number;
        if (const auto fault = lines.add(line)) return c_error(text, shown, number, *fault);
    }
    if (const auto fault = lines.end()) return c_error(text, shown, number, *fault);
    return std::move(lines).tokens();
}

}  // namespace app
