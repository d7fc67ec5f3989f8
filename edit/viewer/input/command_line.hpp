// SPDX-License-Identifier: MIT
#pragma once
// The line that a console's commands are typed into: Tab completes a word, arrows go through what was typed before.

#include <darkroom/result.hpp>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct ImGuiInputTextCallbackData;

namespace app {

/// What a word becomes: the longest beginning that all of `names`, which begin so, have in common, and a blank where
/// there is one alone. Nothing: there are none.
[[nodiscard]] std::optional<std::string> completed(const std::vector<std::string>& names);

class CommandLine {
  public:
    static constexpr std::size_t longest = 512, max_kept = 200;

    /// All words that begin so, in alphabetical order.
    using Names = std::function<std::vector<std::string>(std::string_view begin)>;
    using Print = std::function<void(std::string)>;
    /// Into the present ImGui window. Returns the command that was entered. Where several names are possible, `print`
    /// is told them.
    [[nodiscard]] std::optional<std::string> draw(const Names& names, const Print& print);

  private:
    struct Call {
        CommandLine& own;
        const Names& names;
        const Print& print;
    };
    static int on_key(ImGuiInputTextCallbackData* data);
    void complete(ImGuiInputTextCallbackData& data, const Call& call) const;
    void recall(ImGuiInputTextCallbackData& data, bool is_back);

    std::string typed_, begun_;     ///< now; before arrows went elsewhere
    std::deque<std::string> kept_;  ///< the newest last
    std::size_t recalled_ = 0;      ///< how far back; 0: what is typed
};

// Lines of standard input as they come, for a loop that does not wait for them.

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
