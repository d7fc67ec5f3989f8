// SPDX-License-Identifier: MIT
#pragma once
// The panels of `edit`: the stack to the left, the selected effect to the right, what can be seen of a frame below.

#include <darkroom/composer.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "develop/inspect/inspector.hpp"
#include "panels/panels.hpp"
#include "panels/show/scopes.hpp"
#include "panels/show/timings.hpp"
#include "viewer/panels/panel_layout.hpp"
#include "viewer/playback.hpp"
#include "viewer/source/live_source.hpp"
#include "viewer/source/picture_view.hpp"

namespace app {

/// What can be seen of a frame: through the look that is edited, as its file has it, without any, through another look.
enum class Side : std::uint8_t { Look, Saved, Off, Other };
inline constexpr std::size_t side_count = 4;

class EditPanels {
  public:
    /// The document outlives them.
    explicit EditPanels(darkroom::edit::LookDocument& document) : look_(document) {}

    [[nodiscard]] PanelAreas layout(VkExtent2D window, float scale, bool has_timeline) const;
    /// What their user has made of them, and of a former time.
    [[nodiscard]] const PanelSizes& sizes() const { return sizes_; }
    void set_sizes(const PanelSizes& sizes) { sizes_ = sizes; }
    /// Is a line between them being dragged?
    [[nodiscard]] bool is_sizing() const { return dragged_.has_value(); }
    /// The picture has the whole window, and they lie over it.
    void set_over(bool is_over) { is_over_ = is_over; }

    /// What there is to be shown.
    struct Input {
        LiveSource& source;
        Playback& playback;
        darkroom::Composer& composer;
        VkExtent2D window{};
        float scale = 1;
        std::size_t number = 0;  ///< of a sequence
        bool is_paused = false;
        const darkroom::Inspection* inspection = nullptr;  ///< of the pixel that was chosen
        darkroom::WatchState watch_state = darkroom::WatchState::NotInPlan;
        VkExtent2D extent{};              ///< of the picture
        double lines = 1;                 ///< of what is drawn now to those of the picture
        std::string_view camera;          ///< how it moves; empty: there is none
        double frames_a_second = 0;       ///< 0: nothing changes
        std::string_view last_line = {};  ///< that was said
    };
    void draw(const Input& input, PictureView& picture);
    void measure(const darkroom::panels::ScopePicture& picture) { scopes_.set(darkroom::panels::measure(picture)); }

    [[nodiscard]] darkroom::panels::LookPanels& look() { return look_; }

    // What its user wants.
    [[nodiscard]] bool is_comparing() const { return is_comparing_; }
    void toggle_compare() { is_comparing_ = !is_comparing_; }
    [[nodiscard]] Side left() const { return there(left_); }
    [[nodiscard]] Side right() const { return there(right_); }
    /// What a side is called in the picture.
    [[nodiscard]] std::string name_of(Side side) const;
    /// The file of another look, or of a picture, to compare with.
    [[nodiscard]] std::optional<std::filesystem::path> take_other() {
        return std::exchange(wanted_other_, std::nullopt);
    }
    /// It is there from now on; empty: it is not.
    void set_other(std::string name) { other_ = std::move(name); }
    [[nodiscard]] bool wants_scopes() const { return tab_ == Tab::Scopes; }
    /// The pixel whose way through the stack is shown; nothing: nobody asks.
    [[nodiscard]] std::optional<VkOffset2D> pixel() const { return tab_ == Tab::Pixel ? pixel_ : std::nullopt; }
    void choose(VkOffset2D pixel) { pixel_ = pixel; }
    [[nodiscard]] bool is_choosing() const { return tab_ == Tab::Pixel; }
    /// The image of the plan that is shown in place of the picture, and its mip level.
    [[nodiscard]] const darkroom::PlanImage* watched(const darkroom::Plan* plan) const;
    [[nodiscard]] std::uint32_t watched_level() const { return level_; }
    /// How it is shown; the image is whoever's has it.
    [[nodiscard]] const darkroom::window::PaneView& watched_view() const { return image_view_; }
    /// The file that is to be shown in place of the present scene or frame.
    [[nodiscard]] std::optional<std::filesystem::path> take_opened() { return std::exchange(opened_, std::nullopt); }
    [[nodiscard]] bool take_fullscreen() { return std::exchange(is_fullscreen_wanted_, false); }
    [[nodiscard]] bool take_key_sheet() { return std::exchange(is_key_sheet_wanted_, false); }
    [[nodiscard]] bool take_pause() { return std::exchange(is_pause_wanted_, false); }

  private:
    enum class Tab : std::uint8_t { Plan, Times, Scopes, Images, Pixel, Messages };
    // view_menu.cpp
    void draw_bar();
    void draw_view_menu();
    void draw_open_button();
    void draw_splitters(const PanelAreas& areas);
    void draw_splitter(Splitter which, const VkRect2D& area);
    /// A panel with its name and a button that closes it.
    void begin_panel(const char* name, const VkRect2D& area, bool& is_there);
    void end_panel(const char* name);

    // timeline.cpp
    void draw_timeline(const Input& input);

    // edit_panels.cpp
    void draw_view_bar(PictureView& picture);
    void draw_status(const Input& input, const PictureView& picture);
    void draw_below(const Input& input, PictureView& picture);
    void draw_images(const Input& input);
    void draw_pixel(const Input& input);

    darkroom::panels::LookPanels look_;
    darkroom::panels::TimingHistory times_;
    darkroom::panels::TimingsPanel timings_;
    darkroom::panels::ScopesPanel scopes_;
    Tab tab_ = Tab::Plan;
    PanelSizes sizes_;
    PanelRoom room_;  ///< of the frame that is drawn
    std::optional<Splitter> dragged_;
    bool is_over_ = false, is_fullscreen_wanted_ = false, is_key_sheet_wanted_ = false;
    std::uint32_t view_rows_ = 1;
    bool is_messages_wanted_ = false;  ///< their tab comes to the front
    std::optional<std::filesystem::path> opened_;
    bool is_comparing_ = false, is_pause_wanted_ = false;
    /// Until another look has been chosen, what is saved stands for it.
    [[nodiscard]] Side there(Side side) const { return side == Side::Other && other_.empty() ? Side::Saved : side; }
    void choose_other();

    Side left_ = Side::Look, right_ = Side::Off;
    std::string other_;  ///< the name of the other look's file
    std::optional<std::filesystem::path> wanted_other_;
    std::string image_;
    std::uint32_t level_ = 0;
    darkroom::window::PaneView image_view_{.transfer = darkroom::window::PaneTransfer::SceneLinear};
    std::optional<VkOffset2D> pixel_;
};

}  // namespace app
