// SPDX-License-Identifier: MIT
#pragma once
// Lines of standard input as they come, for a loop that does not wait for them.

#include <darkroom/result.hpp>
#include <string>
#include <vector>

namespace app {

class LineInput {
  public:
    static constexpr std::size_t longest_line = 512;

    /// Those that have come since the last call. An error, once: a line is too long, and no more are read.
    [[nodiscard]] darkroom::Result<std::vector<std::string>> take();

  private:
    std::string begun_;
    bool is_open_ = true;
};

}  // namespace app
