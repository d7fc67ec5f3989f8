// SPDX-License-Identifier: MIT
#pragma once
// What is wrong, in the window, for as long as it is: each source ("save", "reload", a file) says all that it has to
// say, and what it does not say any more goes into a history. The same text of several sources is one message.

#include <darkroom/log.hpp>
#include <darkroom/result.hpp>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom::panels {

/// Where a message points to.
struct TextPlace {
    std::filesystem::path file;
    std::size_t line = 0, column = 0;  ///< from 1; column 0: none is named
    bool operator==(const TextPlace&) const = default;
};
/// The place that a text begins with: "FILE:LINE: ..." or "FILE:LINE:COLUMN: ...".
[[nodiscard]] std::optional<TextPlace> place_in(std::string_view text);

class Messages {
  public:
    static constexpr std::size_t max_present = 16, max_kept = 200;

    struct Said {
        Severity severity = Severity::Error;
        std::string text;
        bool operator==(const Said&) const = default;
    };
    /// All that is wrong with this source now. Of more than 16 messages together the oldest goes.
    void say(std::string_view source, std::span<const Said> all);
    void report(std::string_view source, const Error& error);
    /// The source has succeeded.
    void clear(std::string_view source) { say(source, {}); }
    /// Reports an error, or clears what the source said before; returns whether there is none.
    bool settle(std::string_view source, const Result<>& result);
    /// What has happened and is over: into the history alone.
    void note(std::string_view text);

    /// Is there nothing wrong, or all of it put away?
    [[nodiscard]] bool is_empty() const;
    /// Newest last.
    [[nodiscard]] std::vector<std::string> texts() const;
    [[nodiscard]] std::size_t count(Severity severity) const;  ///< those of now, also where they were put away
    /// What has come since the last call, for who prints it: each message once, however often it is said.
    [[nodiscard]] std::vector<Said> take_new() { return std::exchange(new_, {}); }

    /// Another number after every change.
    [[nodiscard]] std::uint64_t version() const { return version_; }

    struct Entry {
        Severity severity = Severity::Error;
        std::string text;
        std::size_t count = 1;             ///< how often it has come
        std::vector<std::string> sources;  ///< that say it now; empty: it is over
        bool is_put_away = false;
    };
    /// Those of now and what is over, the oldest first.
    [[nodiscard]] const std::deque<Entry>& history() const { return entries_; }

    /// That relative names in messages belong to, where the working directory has no such file.
    void set_folder(std::filesystem::path folder) { folder_ = std::move(folder); }
    /// The place of a message that was clicked.
    [[nodiscard]] std::optional<TextPlace> take_chosen() { return std::exchange(chosen_, std::nullopt); }

    using Note = std::function<void(std::string_view)>;  ///< told the name of the item that was drawn last
    /// Of what draw() takes in a window of this inner width; 0: nothing to say.
    [[nodiscard]] float height(float width) const;
    /// Into the present ImGui window, wrapped, each with a button that puts it away.
    void draw(const Note& note = {});
    /// Newest first, with how often each has come; what is over is dim.
    void draw_history(const Note& note = {});

  private:
    [[nodiscard]] static bool is_shown(const Entry& entry) { return !entry.sources.empty() && !entry.is_put_away; }
    [[nodiscard]] std::optional<TextPlace> file_of(const Entry& entry) const;
    /// The last item is the text of this message: a click on it chooses its place.
    void offer_place(const Entry& entry);

    std::deque<Entry> entries_;
    std::uint64_t version_ = 0;
    std::vector<Said> new_;
    std::filesystem::path folder_;
    std::optional<TextPlace> chosen_;
};

}  // namespace darkroom::panels
