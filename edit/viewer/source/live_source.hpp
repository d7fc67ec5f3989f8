// SPDX-License-Identifier: MIT
#pragma once
// Where a viewer's raw frames come from: a scene that is drawn, or frames of files. One interface, so that what shows
// them knows no difference.

#include <darkroom/composer.hpp>
#include <darkroom/device.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/renderer.hpp"
#include "scene/pose/snapshot.hpp"

namespace app {

/// When a frame is, and from where it is seen.
struct LiveMoment {
    double time = 0, previous_time = 0;  ///< seconds
    std::size_t number = 0;              ///< of a sequence
    darkroom::scene::OrbitOverride orbit;
    std::optional<darkroom::scene::OrbitOverride> previous_orbit;  ///< of the frame before
    darkroom::render::DrawOptions draw;
    darkroom::render::FrameJitter jitter;  ///< of a scene
    float aspect = 1;                      ///< of its picture
    bool is_post_off = false;              ///< a picture by the scene's own shaders is wanted
    double scale = 1;                      ///< of the sides that frames of a size of their own are wanted with
};

class LiveSource {
  public:
    LiveSource() = default;
    LiveSource(const LiveSource&) = delete;
    LiveSource& operator=(const LiveSource&) = delete;
    virtual ~LiveSource() = default;

    /// Of the frames where they have a size of their own, however small prepare() makes them; else what it is told.
    [[nodiscard]] virtual std::optional<VkExtent2D> extent() const = 0;
    /// Would prepare() replace images that unfinished frames may use?
    [[nodiscard]] virtual bool must_wait(const LiveMoment& moment, VkExtent2D extent) const = 0;
    /// Would it be another frame than the last one, whatever its size?
    [[nodiscard]] virtual bool is_another(const LiveMoment& moment) const = 0;
    /// Makes the next frame ready to be recorded. Where must_wait() says so, no frame is unfinished.
    [[nodiscard]] virtual darkroom::Result<> prepare(const LiveMoment& moment, VkExtent2D extent) = 0;
    /// Will record() leave the images as they are?
    [[nodiscard]] virtual bool is_kept() const = 0;
    [[nodiscard]] virtual darkroom::Result<> record(VkCommandBuffer commands) = 0;
    /// As record() leaves it, without target and interface; images may be recorded with more than once, since each is
    /// left as it was.
    [[nodiscard]] virtual darkroom::Frame frame() const = 0;
    /// What all frames will be like, for frames of at most this extent.
    [[nodiscard]] virtual darkroom::CompileDesc compile_desc(VkExtent2D most) const = 0;
    /// The picture of the scene's own shaders, in TRANSFER_SRC_OPTIMAL; nothing: the effects make the picture.
    [[nodiscard]] virtual std::optional<darkroom::ImageRef> display_picture() const { return std::nullopt; }

    /// Frames of a sequence; 0: there is nothing to scrub through.
    [[nodiscard]] virtual std::size_t frames() const { return 0; }
    [[nodiscard]] virtual std::string shown_frame(std::size_t) const { return {}; }
    /// Is the frame that was asked for still being read?
    [[nodiscard]] virtual bool is_coming() const { return false; }
    [[nodiscard]] virtual std::vector<std::filesystem::path> files() const = 0;
    /// Looks for files that are others than they were when they were read, and reads them again beside the frames.
    virtual void look_again() {}
    /// What is wrong with its frames now.
    [[nodiscard]] virtual std::vector<std::string> warnings() const { return {}; }
};

/// The frame with each image left in the layout that it is in, so that it can be recorded with again.
[[nodiscard]] darkroom::Frame as_reusable(darkroom::Frame frame);

}  // namespace app
