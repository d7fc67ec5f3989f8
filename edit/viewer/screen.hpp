// SPDX-License-Identifier: MIT
#pragma once
// What a viewer's window shows: the picture, messages, the console, and the panels of `edit`. It is drawn anew in every
// frame.

#include <chrono>
#include <darkroom/console.hpp>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viewer/input/command_line.hpp"
#include "viewer/panels/edit_panels.hpp"
#include "viewer/source/look_view.hpp"

namespace app {

class Screen {
  public:
    /// `document`: is edited by panels; null: there are none.
    explicit Screen(darkroom::edit::LookDocument* document = nullptr);

    struct Input {
        LiveSource& source;
        LookView& view;
        darkroom::ImageRef picture, compared, watched;  ///< those that are to be shown
        darkroom::window::PaneTransfer transfer{}, compared_transfer{};
        VkExtent2D extent{};  ///< of the picture
        double lines = 1;     ///< of what is drawn now to those of the picture
        VkExtent2D window{};
        float scale = 1;
        double passed = 0;        ///< seconds since the last frame
        bool is_counted = false;  ///< it is these that lines are shown for, and not those of a clock
        std::size_t number = 0;
        Playback& playback;
        bool is_paused = false;
        const darkroom::Inspection* inspection = nullptr;
        std::string_view camera;               ///< how it moves, in a word
        double frames_a_second = 0;            ///< 0: nothing changes
        darkroom::Console* console = nullptr;  ///< whose names are completed
    };
    void draw(const Input& input);
    /// Where the picture lies in a window of this extent.
    [[nodiscard]] VkRect2D picture_area(VkExtent2D window, float scale, bool has_timeline) const;

    /// A short line for two seconds.
    void tell(std::string line);
    /// All that is wrong with a source now; what is new is printed, once.
    void say(std::string_view source, std::span<const darkroom::panels::Messages::Said> all);
    void tell_error(std::string_view source, std::string line);
    void clear_error(std::string_view source) { messages().clear(source); }
    [[nodiscard]] darkroom::panels::Messages& messages() { return panels_ ? panels_->look().messages() : messages_; }
    void print(std::string line);  ///< to the console
    /// Has something been said, or stopped to be true, since this was last asked?
    [[nodiscard]] bool take_change();
    /// Has a line been seen for long enough, so that it goes with the next frame?
    [[nodiscard]] bool is_over() const;

    void toggle_panels() { has_panels_ = !has_panels_; }
    void toggle_console() { has_console_ = !has_console_; }
    [[nodiscard]] bool has_console() const { return has_console_; }
    void toggle_key_sheet() { has_key_sheet_ = !has_key_sheet_; }
    [[nodiscard]] bool has_key_sheet() const { return has_key_sheet_; }
    /// Null: there are none, or they are hidden.
    [[nodiscard]] EditPanels* panels() { return panels_ && has_panels_ ? &*panels_ : nullptr; }
    [[nodiscard]] const EditPanels* panels() const { return panels_ && has_panels_ ? &*panels_ : nullptr; }
    /// The panels even where they are hidden.
    [[nodiscard]] EditPanels* editor() { return panels_ ? &*panels_ : nullptr; }
    [[nodiscard]] const PictureView& picture() const { return picture_; }

    [[nodiscard]] bool is_comparing() const { return panels_ && panels_->is_comparing(); }
    [[nodiscard]] Side left() const { return is_comparing() ? panels_->left() : Side::Look; }
    [[nodiscard]] Side right() const { return is_comparing() ? panels_->right() : Side::Look; }
    /// What was typed into the console.
    [[nodiscard]] std::vector<std::string> take_commands() { return std::exchange(commands_, {}); }

  private:
    void draw_picture(const Input& input, const VkRect2D& area);
    void draw_lines(const Input& input, const VkRect2D& area);
    void draw_errors(const Input& input, const VkRect2D& area);
    void draw_key_sheet(const Input& input) const;
    void draw_console(const VkRect2D& area, darkroom::Console* console);
    void print_new();

    using Clock = std::chrono::steady_clock;
    struct Line {
        std::string text;
        double until = 0;
        Clock::time_point over{};  ///< the same for who looks at a clock
    };
    std::optional<EditPanels> panels_;
    bool has_panels_ = true, has_console_ = false, has_key_sheet_ = false;
    PictureView picture_;
    darkroom::panels::Messages messages_;  ///< where no panels show them
    std::deque<Line> lines_;
    std::string last_line_;
    bool is_changed_ = true;
    std::uint64_t seen_messages_ = 0;
    std::deque<std::string> printed_;
    std::vector<std::string> commands_;
    CommandLine typed_;
    double now_ = 0;
};

}  // namespace app
