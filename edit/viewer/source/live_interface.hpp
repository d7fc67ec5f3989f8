// SPDX-License-Identifier: MIT
#pragma once
// The interface over a viewer's picture: its document, the game that it shows, inertia and controllers, frame by frame.

#include <darkroom/controllers.hpp>
#include <darkroom/hud_inertia.hpp>
#include <darkroom/look.hpp>
#include <memory>
#include <optional>
#include <vector>

#include <darkroom/hud_document.hpp>
#include "gpu/resource/resources.hpp"
#include "programs/darkroom/run/timeline.hpp"

namespace app {

/// Of who wears it.
struct HeadMotion {
    double delta_time = 0, yaw = 0, velocity_up = 0;
    bool is_on_ground = true;
};

class LiveInterface {
  public:
    /// `is_headless`: the document is drawn before it is shown, so that frames can be repeated. `print`: of scripts.
    /// `folder`: that the console's files are in.
    LiveInterface(darkroom::Device& device, bool is_headless, std::uint32_t slots, darkroom::LogSink print,
                  std::filesystem::path folder);

    /// The interface of this look, over this Composer, which outlives it. Errors are those of its files; what was there
    /// before is gone.
    [[nodiscard]] darkroom::Result<> start(const darkroom::Look& look, const Timeline& timeline,
                                           darkroom::Composer& composer);
    /// Before a frame: what the game says, one call of each controller, the offset. `is_menu_open`: the keys are not
    /// the game's. An error is why the picture is not that of its files; what was there before stays.
    [[nodiscard]] darkroom::Result<> advance(double time, const HeadMotion& motion, bool is_menu_open);
    /// What the game says at first, from now on.
    void set_game(const darkroom::GameTable& game) { ui_.game = game; }
    /// Reads scripts again that have changed. Documents do so by themselves.
    void reload_changed();
    /// Brings its image up to date. Where must_wait() says so, no frame is unfinished. What Frame::ui takes. `scale`:
    /// the window's, see HudDocument::picture. It is drawn for the first extent, and scaled to that of the frame.
    [[nodiscard]] darkroom::Result<darkroom::ImageRef> record(VkCommandBuffer commands, std::uint32_t slot,
                                                              VkExtent2D extent, VkExtent2D of_frame, float scale);
    [[nodiscard]] bool must_wait(VkExtent2D extent, VkExtent2D of_frame) const;
    /// Is there another picture of it than the one that was recorded last, or another error than advance() told?
    [[nodiscard]] bool is_new() const;
    [[nodiscard]] bool has_controllers() const { return controllers_.has_value(); }
    [[nodiscard]] bool is_given() const { return !ui_.document.empty(); }
    /// UNDEFINED: there is none.
    [[nodiscard]] VkFormat format() const { return is_given() ? image_format : VK_FORMAT_UNDEFINED; }
    [[nodiscard]] darkroom::Console* console() { return console_.get(); }

  private:
    static constexpr VkFormat image_format = VK_FORMAT_R8G8B8A8_UNORM;
    using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;
    [[nodiscard]] darkroom::Result<Bytes> picture(VkExtent2D& extent, float scale);
    [[nodiscard]] darkroom::Result<> resize(VkExtent2D extent);
    [[nodiscard]] darkroom::Result<> scale_to(VkCommandBuffer commands, VkExtent2D of_frame);
    [[nodiscard]] darkroom::ImageRef reference_to(const darkroom::gpu::Image& image) const;

    darkroom::Device& device_;
    bool is_headless_;
    darkroom::LogSink print_;
    std::filesystem::path folder_;
    darkroom::LookUi ui_;
    std::vector<GameEvent> events_;
    darkroom::GameTable game_;
    darkroom::Composer* composer_ = nullptr;
    std::unique_ptr<darkroom::Console> console_;
    std::optional<darkroom::Controllers> controllers_;
    std::unique_ptr<darkroom::HudDocument> document_;
    darkroom::HudInertia inertia_;
    std::string failed_;  ///< why its picture could not be read

    Bytes shown_, uploaded_;  ///< of a file; on the device
    std::string told_error_;
    VkExtent2D recorded_extent_{};
    float recorded_scale_ = 1;
    VkExtent2D shown_extent_{};
    darkroom::gpu::Image image_, scaled_;
    std::vector<darkroom::gpu::Buffer> staging_;  ///< one a slot
    VkImageLayout layout_ = VK_IMAGE_LAYOUT_UNDEFINED;
};

}  // namespace app
