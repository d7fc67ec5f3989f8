// SPDX-License-Identifier: MIT
#pragma once
// Which frames of a sequence are meant, as people write it: 12, 1-100, 1-100x2 (every second one), -10--5, and several
// of these with commas between them.

#include <string>
#include <string_view>
#include <vector>

#include "core/try.hpp"

namespace darkroom {

class FrameSet {
  public:
    static constexpr long long max_number = 1'000'000'000;
    /// Lists of more ranges than this are refused.
    static constexpr std::size_t max_ranges = 10'000;

    /// Errors name what is expected, and not the text.
    [[nodiscard]] static Result<FrameSet> parse(std::string_view text);

    [[nodiscard]] bool contains(long long number) const;
    /// All numbers from one to another?
    [[nodiscard]] bool is_range() const { return ranges_.size() == 1 && ranges_.front().step == 1; }
    /// How many, those of several ranges as often.
    [[nodiscard]] std::size_t count() const;
    /// In ascending order, each once.
    [[nodiscard]] std::vector<long long> numbers() const;

  private:
    struct Range {
        long long first = 0, last = 0, step = 1;
        [[nodiscard]] bool contains(long long number) const {
            return number >= first && number <= last && (number - first) % step == 0;
        }
    };
    [[nodiscard]] static Result<Range> parse_range(std::string_view text);

    std::vector<Range> ranges_;
};

/// The shortest text of these numbers that FrameSet::parse reads back: ascending, each once, at least one.
[[nodiscard]] std::string frame_set_text(const std::vector<long long>& numbers);

}  // namespace darkroom
