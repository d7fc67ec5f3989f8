// SPDX-License-Identifier: MIT
#pragma once
// Reads GLSL as tokens, for all that changes or asks a kernel's text: it knows words, comments and directives, and no
// grammar.

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace darkroom::gpu {

struct Token {
    enum class Kind : std::uint8_t {
        End,
        Blank,      ///< a comment, or white space
        Directive,  ///< from # to the end of its line, without it
        Word,       ///< a name or keyword
        Member,     ///< a word after a dot
        Number,     ///< 1, 0x1f, 1e5; of a fraction each half is one
        Mark,       ///< one other character
    };
    Kind kind = Kind::End;
    std::string_view text;
};

/// Calling next() until End gives every character of the text once, in order.
class GlslScanner {
  public:
    explicit GlslScanner(std::string_view text) : text_(text) {}
    Token next();
    /// The next Word, or End.
    Token next_word();
    /// The next token that is not Blank, without taking it.
    [[nodiscard]] Token peek() const;
    /// Where that token begins.
    [[nodiscard]] std::size_t place() const { return at_; }

  private:
    std::string_view text_;
    std::size_t at_ = 0;
    bool is_after_dot_ = false;
};

}  // namespace darkroom::gpu
