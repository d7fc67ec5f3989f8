// SPDX-License-Identifier: MIT
#pragma once
// A look on the device: a Composer that follows it, and the picture that it makes of frames.

#include <darkroom/composer.hpp>
#include <darkroom/look.hpp>
#include <optional>
#include <string>

#include "gpu/resource/resources.hpp"
#include "live_source.hpp"
#include "programs/darkroom/run/timeline.hpp"
#include "window/pane.hpp"

namespace app {

class LookView {
  public:
    struct Desc {
        std::uint32_t frames_in_flight = 2;
        darkroom::KernelStage kernels = darkroom::KernelStage::Auto;
        bool fuse = true;
        bool makes_light = false;       ///< in place of code values of sRGB, for a window of high range
        bool keeps_what_is_off = true;  ///< so that a key switches it on in the next frame
        bool enlarges = false;          ///< frames may be smaller than the pictures of them
        Timeline timeline;              ///< what happens to the look
    };
    LookView(darkroom::Device& device, Desc desc);

    /// From now on it is this one. Values and switches are seen by the next record; what needs a compile is compiled
    /// beside the frames, which go on with the plan there is.
    [[nodiscard]] darkroom::Result<> show(const darkroom::Look& look);
    /// Makes room for frames of this source and extent: the first time at once, later beside the frames. To be called
    /// in every frame. `ui`: of the interface's image; UNDEFINED: there is none. `is_kept`: the picture is one to keep,
    /// bit for bit what develop makes: a plan of this very extent, without a wait for other sizes, and of what is on.
    [[nodiscard]] darkroom::Result<> fit(const LiveSource& source, VkExtent2D extent, VkFormat ui,
                                         bool is_kept = false);
    /// The largest that frames may be now, whichever of the plans under way the next record takes.
    [[nodiscard]] VkExtent2D most() const;
    /// A picture of this extent. Where it has another, no frame is unfinished.
    [[nodiscard]] darkroom::Result<> resize(VkExtent2D extent);
    [[nodiscard]] bool must_wait(VkExtent2D extent) const;
    /// Makes the picture, and leaves it to be sampled by fragment shaders.
    [[nodiscard]] darkroom::Result<> record(VkCommandBuffer commands, darkroom::Frame frame);
    /// Copies somebody else's picture there, code values, which is in TRANSFER_SRC_OPTIMAL, and enlarges it.
    void copy(VkCommandBuffer commands, const darkroom::ImageRef& picture);
    /// Would record() make the same picture again of the same frame? Never of a look that remembers frames.
    [[nodiscard]] bool is_current() const;
    /// The picture, scaled, into an image that was created for copies, which is left in TRANSFER_DST_OPTIMAL.
    void copy_to(VkCommandBuffer commands, const darkroom::gpu::Image& image) const;
    /// Shows an image of the plan, too, at its own size, as record() makes it; nothing: no more.
    [[nodiscard]] darkroom::Result<> watch(const darkroom::PlanImage* image, std::uint32_t mip_level);
    [[nodiscard]] bool must_wait_to_watch(const darkroom::PlanImage* image, std::uint32_t mip_level) const;
    /// Of the last record; not given where it shows nothing.
    [[nodiscard]] darkroom::ImageRef watched() const;
    [[nodiscard]] darkroom::WatchState watch_state() const;
    /// As record() and copy() leave it; not given where neither has made one of its present size.
    [[nodiscard]] darkroom::ImageRef picture() const;
    /// What its numbers mean.
    [[nodiscard]] darkroom::window::PaneTransfer transfer() const { return transfer_; }
    [[nodiscard]] VkExtent2D extent() const { return {picture_.info.extent.width, picture_.info.extent.height}; }
    /// An error: why the look on the screen is not the newest.
    [[nodiscard]] darkroom::Result<> planned() const;
    /// Will the same frame make another picture: does it wait for a plan of its size, or of its look?
    [[nodiscard]] bool is_coming() const { return is_settling_ || composer_.pending().is_pending; }
    [[nodiscard]] darkroom::Composer& composer() { return composer_; }
    [[nodiscard]] const darkroom::CompileDesc& compile_desc() const { return compiled_; }

  private:
    [[nodiscard]] darkroom::ImageRef reference() const;
    [[nodiscard]] darkroom::Result<> follow(const darkroom::Look& look);
    [[nodiscard]] darkroom::Result<> compile(const darkroom::CompileDesc& desc);
    void change_layout(VkCommandBuffer commands, VkImageLayout from, VkImageLayout to) const;

    darkroom::Device& device_;
    Desc desc_;
    darkroom::Composer composer_;
    darkroom::Look shown_;
    bool keeps_what_is_off_ = true;   ///< else the plan is the one that develop makes
    darkroom::CompileDesc compiled_;  ///< asked for last
    bool is_compiled_ = false;
    VkExtent2D last_extent_{};
    VkExtent2D least_pending_{};  ///< of what was asked for since no plan was under way
    std::uint32_t frames_alike_ = 0;
    bool is_settling_ = false;  ///< the plan is for another extent
    darkroom::gpu::Image picture_, watched_;
    bool is_drawn_ = false, is_of_look_ = false;  ///< the picture is there; it is that of the look as it is
    darkroom::window::PaneTransfer transfer_ = darkroom::window::PaneTransfer::Encoded;
    std::vector<darkroom::Watch> watches_;
};

}  // namespace app
