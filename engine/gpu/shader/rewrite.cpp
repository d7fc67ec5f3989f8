// SPDX-License-Identifier: MIT
#include "gpu/shader/rewrite.hpp"

#include <algorithm>

#include "gpu/shader/word_set.hpp"

namespace darkroom::gpu {

namespace {

using enum Token::Kind;

template <class Range>
bool contains(const Range& words, std::string_view word) {
    return std::ranges::find(words, word) != words.end();
}

/// Takes tokens up to one that is not blank, which it returns; what was blank is added to `blanks`.
Token take_solid(GlslScanner& scanner, std::string& blanks) {
    Token token = scanner.next();
    for (; token.kind == Blank; token = scanner.next()) blanks += token.text;
    return token;
}

struct Call {
    std::string_view image;   ///< empty: not a call to rewrite
    std::string before_open;  ///< blanks between the function and its parenthesis
    std::string inside;       ///< blanks around the image
    GlslScanner after;        ///< behind what follows the image, a comma or parenthesis
    bool has_more = false;    ///< it was a comma
};

/// A call of the function whose name `scanner` has just passed.
Call read_call(GlslScanner scanner, std::span<const std::string_view> images) {
    Call call{.after = scanner};
    if (take_solid(scanner, call.before_open).text != "(") return call;
    const Token image = take_solid(scanner, call.inside);
    if (image.kind != Word || !contains(images, image.text)) return call;
    const std::string_view mark = take_solid(scanner, call.inside).text;
    if (mark != "," && mark != ")") return call;
    call.has_more = mark == ",";
    call.image = image.text;
    call.after = scanner;
    return call;
}

}  // namespace

std::string rewrite_image_calls(std::string_view body, std::span<const std::string_view> functions,
                                std::span<const std::string_view> images) {
    std::string result;
    result.reserve(body.size() + body.size() / 4);
    WordSet names;
    for (const std::string_view function : functions) names.insert(function);
    std::size_t copied = 0;  // up to where the body is in the result
    GlslScanner scanner(body);
    for (Token token = scanner.next_word(); token.kind != End; token = scanner.next_word()) {
        if (!names.contains(token.text)) continue;
        const Call call = read_call(scanner, images);
        if (call.image.empty()) continue;
        result.append(body.substr(copied, scanner.place() - copied));
        result.append("_").append(call.image).append(call.before_open).append("(").append(call.inside);
        if (!call.has_more) result += ')';
        scanner = call.after;
        copied = scanner.place();
        // Behind the comma that went.
        if (call.has_more) copied = std::min(body.find_first_not_of(' ', copied), body.size());
    }
    return result.append(body.substr(copied));
}

}  // namespace darkroom::gpu
