// SPDX-License-Identifier: MIT
#pragma once
// What went wrong, in the window, until it is dealt with: one line for each source, which goes when the source succeeds
// or the user puts it away.

#include <darkroom/result.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom::panels {

class Messages {
  public:
    /// In the place of what this source ("save", "reload", a file) said before. Of more than 16 sources the oldest
    /// goes.
    void report(std::string_view source, const Error& error);
    /// The source has succeeded.
    void clear(std::string_view source);
    /// Reports an error, or clears what the source said before; returns whether there is none.
    bool settle(std::string_view source, const Result<>& result);

    [[nodiscard]] bool is_empty() const { return shown_.empty(); }
    /// Newest last.
    [[nodiscard]] std::vector<std::string> texts() const;
    /// Of what draw() takes in a window of this inner width; 0: nothing to say.
    [[nodiscard]] float height(float width) const;
    /// Into the present ImGui window, wrapped, each with a button that puts it away.
    void draw();

  private:
    struct Message {
        std::string source, text;
    };
    std::vector<Message> shown_;
};

}  // namespace darkroom::panels
