// SPDX-License-Identifier: MIT
#pragma once
// What a viewer's window shows: the picture, messages, the console, and the panels of `edit`. It is drawn anew in every
// frame.

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/source/look_view.hpp"
#include "edit_panels.hpp"

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
        VkExtent2D window{};
        float scale = 1;
        double passed = 0;  ///< seconds since the last frame
        std::size_t number = 0;
        bool is_paused = false;
        const darkroom::Inspection* inspection = nullptr;
    };
    void draw(const Input& input);
    /// Where the picture lies in a window of this extent.
    [[nodiscard]] VkRect2D picture_area(VkExtent2D window, float scale, bool has_timeline) const;

    /// A short line for two seconds.
    void tell(std::string line);
    /// A line that stays until it is dealt with, or until its source has nothing to say.
    void tell_error(std::string_view source, std::string line);
    void clear_error(std::string_view source);
    void print(std::string line);  ///< to the console

    void toggle_panels() { has_panels_ = !has_panels_; }
    void toggle_console() { has_console_ = !has_console_; }
    [[nodiscard]] bool has_console() const { return has_console_; }
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
    void draw_console(const VkRect2D& area);

    struct Line {
        std::string text;
        double until = 0;
    };
    std::optional<EditPanels> panels_;
    bool has_panels_ = true, has_console_ = false;
    PictureView picture_;
    darkroom::panels::Messages messages_;      ///< where no panels show them
    std::map<std::string, std::string> said_;  ///< by source: what is told once, however often it is found
    std::deque<Line> lines_;
    std::deque<std::string> printed_;
    std::vector<std::string> commands_;
    std::string typed_;
    double now_ = 0;
};

}  // namespace app
