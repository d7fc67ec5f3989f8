// SPDX-License-Identifier: MIT
#pragma once
// AMD's machine code, as RADV shows it, as far as counting needs it: instructions, and how often each is run.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace darkroom {

class MachineCode {
  public:
    struct Instruction {
        std::string_view name;  ///< "v_fma_f32"
        std::vector<std::string_view> operands;
    };
    /// First and last instruction.
    struct Loop {
        std::size_t begin = 0, end = 0;
    };

    /// Views `text`: blocks begin with "BB3:", comments with a semicolon.
    explicit MachineCode(std::string_view text);
    [[nodiscard]] std::span<const Instruction> instructions() const { return instructions_; }
    /// By their begins; a loop within another one follows it.
    [[nodiscard]] std::span<const Loop> loops() const { return loops_; }
    /// Where a scalar counter from one number to another decides. Breaks that depend on pixels do not count: most.
    [[nodiscard]] std::optional<std::uint32_t> trips(const Loop& loop) const;

  private:
    std::vector<Instruction> instructions_;
    std::map<std::string_view, std::size_t> blocks_;  ///< to their first instruction
    std::vector<Loop> loops_;
};

}  // namespace darkroom
