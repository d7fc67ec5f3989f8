// SPDX-License-Identifier: MIT
#pragma once
// The interface that commands put over their pictures: an image, or an SVG document, drawn at each picture's size; what
// the game says to it, how it lags behind the head, and the controllers that move it.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <darkroom/controllers.hpp>
#include <darkroom/look.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <darkroom/hud_document.hpp>
#include "timeline.hpp"

namespace app {

/// Of a look as LookFlags gives it: with the controllers that its document names, behind its own. A document that
/// cannot be read names none; drawing it says why.
[[nodiscard]] darkroom::LookUi interface_of(const darkroom::Look& look);
/// What the interface of a look, as LookFlags gives it, is read from.
[[nodiscard]] std::vector<std::filesystem::path> ui_files(const darkroom::Look& look);
/// That they can be opened.
[[nodiscard]] darkroom::Result<> check_ui_files(const darkroom::Look& look);

/// As documents have it.
[[nodiscard]] darkroom::HudValue hud_value(const darkroom::GameValue& value);
/// Lets the interface lag behind by this, on top of where the look has it: an override. Nothing where no entry has a
/// place.
[[nodiscard]] darkroom::Result<> move_interface(darkroom::Composer& composer, darkroom::Vec2 offset);

/// What the game says at this time, on top of what it said at first.
[[nodiscard]] darkroom::GameTable game_at(darkroom::GameTable game, const std::vector<GameEvent>& events, double time);
/// How far the interface lags behind where the view looks at this time by events.
[[nodiscard]] darkroom::Vec2 inertia_at(const std::vector<GameEvent>& events, double time);

class UiSource {
  public:
    UiSource() = default;
    /// Of a look as LookFlags gives it.
    UiSource(const darkroom::Look& look, const Timeline& timeline)
        : ui_(interface_of(look)), events_(timeline.game()), game_(ui_.game) {}
    [[nodiscard]] bool has_controllers() const { return !ui_.controllers.empty(); }
    /// Loads the controllers for this Composer, which advance() does as well. Errors: of scripts.
    [[nodiscard]] darkroom::Result<> start(darkroom::Composer& composer);
    /// Of the controllers, once they are loaded: see Controllers::pre_roll.
    [[nodiscard]] std::optional<double> pre_roll() const { return controllers_->pre_roll(); }
    /// True: what scripts print, and their errors, are not told from now on. Gives what was the case.
    bool silence(bool is_silent) { return std::exchange(*is_silent_, is_silent); }
    /// Before a frame: the game at this time, the offset of the interface, and one call of each controller. Values are
    /// overrides. Frames come in order; a frame at an earlier time starts anew.
    [[nodiscard]] darkroom::Result<> advance(darkroom::Composer& composer, double time);
    /// As DevelopInput::ui has it; empty: there is none.
    [[nodiscard]] darkroom::Result<std::shared_ptr<const std::vector<std::uint8_t>>> picture(VkExtent2D extent);

  private:
    /// Once, where the interface is a document.
    [[nodiscard]] darkroom::Result<> load_document();

    darkroom::LookUi ui_;
    std::vector<GameEvent> events_;
    darkroom::GameTable game_;
    const darkroom::Composer* composer_ = nullptr;  ///< that the controllers move
    std::unique_ptr<darkroom::Console> console_;
    std::optional<darkroom::Controllers> controllers_;
    double last_time_ = 0;
    std::shared_ptr<bool> is_silent_ = std::make_shared<bool>(false);  ///< what the controllers' sink looks at

    VkExtent2D extent_{};
    std::shared_ptr<darkroom::HudDocument> document_;  ///< of controllers as well, which set its classes
    std::shared_ptr<const std::vector<std::uint8_t>> picture_ = std::make_shared<const std::vector<std::uint8_t>>();
};

}  // namespace app
