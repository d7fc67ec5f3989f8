// SPDX-License-Identifier: MIT
#pragma once
// The grammar of consoles, as Quake has it: commands end at a line's end or at `;`, words at blanks, "..." is one word
// without escapes, which ends at the line's end at the latest, and `//` where a word may begin is a comment up to the
// line's end.

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace darkroom::script {

struct Command {
    std::size_t line = 1;
    std::vector<std::string_view> words;  ///< at least one; of the text that was read
};

class CommandReader {
  public:
    explicit CommandReader(std::string_view text) : rest_(text) {}
    [[nodiscard]] std::optional<Command> next();

  private:
    /// The next word of this command; nothing at its end, which is passed.
    [[nodiscard]] std::optional<std::string_view> word();

    std::string_view rest_;
    std::size_t line_ = 1;
};

}  // namespace darkroom::script
