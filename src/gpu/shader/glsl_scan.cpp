// SPDX-License-Identifier: MIT
#include "gpu/shader/glsl_scan.hpp"

#include <algorithm>

namespace darkroom::gpu {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool starts_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool continues_word(char c) { return starts_word(c) || is_digit(c); }
bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

std::size_t while_true(std::string_view text, std::size_t at, bool (*holds)(char)) {
    while (at < text.size() && holds(text[at])) ++at;
    return at;
}

}  // namespace

Token GlslScanner::next() {
    using enum Token::Kind;
    if (at_ >= text_.size()) return {};
    const std::string_view rest = text_.substr(at_);
    Token::Kind kind = Mark;
    std::size_t end = at_ + 1;
    if (rest.starts_with("//") || rest.front() == '#') {
        kind = rest.front() == '#' ? Directive : Blank;
        end = std::min(text_.find('\n', at_), text_.size());
    } else if (rest.starts_with("/*")) {
        kind = Blank;
        const std::size_t close = text_.find("*/", at_ + 2);
        end = close == std::string_view::npos ? text_.size() : close + 2;
    } else if (is_space(rest.front())) {
        kind = Blank;
        end = while_true(text_, at_, is_space);
    } else if (continues_word(rest.front())) {
        kind = is_digit(rest.front()) ? Number : is_after_dot_ ? Member : Word;
        end = while_true(text_, at_, continues_word);
    }
    if (kind != Blank) is_after_dot_ = kind == Mark && rest.front() == '.';
    const Token token{kind, text_.substr(at_, end - at_)};
    at_ = end;
    return token;
}

Token GlslScanner::peek() const {
    GlslScanner ahead = *this;
    Token token = ahead.next();
    while (token.kind == Token::Kind::Blank) token = ahead.next();
    return token;
}

}  // namespace darkroom::gpu
