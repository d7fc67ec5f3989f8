// SPDX-License-Identifier: MIT
#include "gpu/rewrite.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

namespace darkroom::gpu {

namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool starts_word(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool continues_word(char c) { return starts_word(c) || is_digit(c); }
bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

enum class Kind { Blank, Word, Number, Mark };
struct Token {
    Kind kind = Kind::Mark;
    std::size_t end = 0;
};

/// The token at `at`: a comment or one space, a word, a number (or its part before a dot), or one other character.
Token token_at(std::string_view text, std::size_t at) {
    if (text.substr(at, 2) == "//") return {Kind::Blank, std::min(text.find('\n', at), text.size())};
    if (text.substr(at, 2) == "/*") {
        const std::size_t close = text.find("*/", at + 2);
        return {Kind::Blank, close == std::string_view::npos ? text.size() : close + 2};
    }
    if (is_space(text[at])) return {Kind::Blank, at + 1};
    if (!continues_word(text[at])) return {Kind::Mark, at + 1};
    std::size_t end = at;
    while (end < text.size() && continues_word(text[end])) ++end;
    return {is_digit(text[at]) ? Kind::Number : Kind::Word, end};
}

std::size_t skip_blank(std::string_view text, std::size_t at) {
    while (at < text.size()) {
        const Token token = token_at(text, at);
        if (token.kind != Kind::Blank) break;
        at = token.end;
    }
    return at;
}

char character_at(std::string_view text, std::size_t at) { return at < text.size() ? text[at] : '\0'; }

bool contains(std::span<const std::string_view> words, std::string_view word) {
    return std::ranges::find(words, word) != words.end();
}

struct Call {
    std::string_view image;  ///< empty: not a call to rewrite
    std::size_t image_begin = 0;
    std::size_t image_end = 0;
    std::size_t next = 0;  ///< the comma or parenthesis after the image
};

/// A call of the function whose name ends at `at`.
Call read_call(std::string_view text, std::size_t at, std::span<const std::string_view> images) {
    const std::size_t open = skip_blank(text, at);
    if (character_at(text, open) != '(') return {};
    const std::size_t begin = skip_blank(text, open + 1);
    if (begin >= text.size()) return {};
    const std::size_t end = token_at(text, begin).end;
    const std::string_view image = text.substr(begin, end - begin);
    const std::size_t next = skip_blank(text, end);
    const bool ends_argument = character_at(text, next) == ',' || character_at(text, next) == ')';
    if (!contains(images, image) || !ends_argument) return {};
    return {image, begin, end, next};
}

}  // namespace

std::string rewrite_image_calls(std::string_view body, std::span<const std::string_view> functions,
                                std::span<const std::string_view> images) {
    std::string result;
    std::size_t at = 0;
    bool is_member = false;  // after a dot: a field, not a function
    while (at < body.size()) {
        const Token token = token_at(body, at);
        const std::string_view text = body.substr(at, token.end - at);
        const bool may_call = token.kind == Kind::Word && !is_member && contains(functions, text);
        const Call call = may_call ? read_call(body, token.end, images) : Call{};
        if (token.kind != Kind::Blank) is_member = text == ".";
        result += text;
        at = token.end;
        if (call.image.empty()) continue;
        result += '_';
        result += call.image;
        result += body.substr(token.end, call.image_begin - token.end);
        result += body.substr(call.image_end, call.next - call.image_end);
        at = call.next;
        if (body[at] != ',') continue;
        ++at;
        while (character_at(body, at) == ' ') ++at;
    }
    return result;
}

std::string rewrite_indexing(std::string_view body, std::span<const std::string> arrays) {
    std::string result;
    std::vector<bool> brackets;  // of those open now: whether it was rewritten
    bool is_member = false;
    for (std::size_t at = 0; at < body.size();) {
        const Token token = token_at(body, at);
        const std::string_view text = body.substr(at, token.end - at);
        at = token.end;
        const bool is_array = token.kind == Kind::Word && !is_member &&
                              std::ranges::find(arrays, text) != arrays.end() && character_at(body, at) == '[';
        if (token.kind != Kind::Blank) is_member = text == ".";
        if (is_array) {
            result += text;
            result += "_at(";
            brackets.push_back(true);
            ++at;
        } else if (text == "]" && !brackets.empty()) {
            result += brackets.back() ? ')' : ']';
            brackets.pop_back();
        } else {
            if (text == "[") brackets.push_back(false);
            result += text;
        }
    }
    return result;
}

}  // namespace darkroom::gpu
