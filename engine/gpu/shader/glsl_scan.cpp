// SPDX-License-Identifier: MIT
#include "gpu/shader/glsl_scan.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace darkroom::gpu {

namespace {

// A kernel's text is read several times on the way to its pipeline: what a character is, is looked up.
constexpr std::uint8_t space = 1, digit = 2, letter = 4;
constexpr std::array<std::uint8_t, 256> kinds = [] {
    std::array<std::uint8_t, 256> out{};
    for (const char c : {' ', '\n', '\t', '\r', '\v', '\f'}) out[static_cast<std::size_t>(c)] = space;
    for (std::size_t c = '0'; c <= '9'; ++c) out[c] = digit;
    for (std::size_t c = 'a'; c <= 'z'; ++c) out[c] = letter;
    for (std::size_t c = 'A'; c <= 'Z'; ++c) out[c] = letter;
    out['_'] = letter;
    return out;
}();

bool is(char c, std::uint8_t wanted) { return (kinds[static_cast<unsigned char>(c)] & wanted) != 0; }

std::size_t end_of(std::string_view text, std::size_t at, std::uint8_t wanted) {
    while (at < text.size() && is(text[at], wanted)) ++at;
    return at;
}

}  // namespace

Token GlslScanner::next() {
    using enum Token::Kind;
    if (at_ >= text_.size()) return {};
    const char first = text_[at_], second = at_ + 1 < text_.size() ? text_[at_ + 1] : '\0';
    Token::Kind kind = Mark;
    std::size_t end = at_ + 1;
    if (is(first, letter | digit)) {
        kind = is(first, digit) ? Number : is_after_dot_ ? Member : Word;
        end = end_of(text_, end, letter | digit);
    } else if (is(first, space)) {
        kind = Blank;
        end = end_of(text_, end, space);
    } else if (first == '#' || (first == '/' && second == '/')) {
        kind = first == '#' ? Directive : Blank;
        end = std::min(text_.find('\n', at_), text_.size());
    } else if (first == '/' && second == '*') {
        kind = Blank;
        const std::size_t close = text_.find("*/", at_ + 2);
        end = close == std::string_view::npos ? text_.size() : close + 2;
    }
    if (kind != Blank) is_after_dot_ = kind == Mark && first == '.';
    const Token token{kind, text_.substr(at_, end - at_)};
    at_ = end;
    return token;
}

Token GlslScanner::next_word() {
    while (at_ < text_.size()) {
        const char first = text_[at_];
        if (is(first, space)) {
            ++at_;
        } else if (is(first, letter) && !is_after_dot_) {
            return next();
        } else if (is(first, letter | digit)) {
            at_ = end_of(text_, at_, letter | digit);
            is_after_dot_ = false;
        } else if (first == '#' || first == '/') {
            next();
        } else {
            is_after_dot_ = first == '.';
            ++at_;
        }
    }
    return {};
}

Token GlslScanner::peek() const {
    GlslScanner ahead = *this;
    Token token = ahead.next();
    while (token.kind == Token::Kind::Blank) token = ahead.next();
    return token;
}

}  // namespace darkroom::gpu
