// SPDX-License-Identifier: MIT
#pragma once
// Frames into a window: a ring of command buffers, and the swapchain that they end in. A swapchain that no longer fits
// is replaced without waiting for the frames that use it; what it was is freed when they have finished.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <darkroom/device.hpp>
#include <functional>
#include <memory>
#include <optional>

#include "core/try.hpp"
#include "window/surface_format.hpp"

namespace darkroom::window {

/// When pictures are shown: with the display; with it, the newest one; at once, torn. What a surface does not have
/// becomes Vsync, which all have.
enum class Presentation : std::uint32_t { Vsync, Mailbox, Immediate };

struct PresenterDesc {
    Presentation presentation = Presentation::Vsync;
    std::uint32_t frames_in_flight = 2;
    /// High needs VK_EXT_swapchain_colorspace; where VK_EXT_hdr_metadata is, the display is told of it.
    DynamicRange range = DynamicRange::Standard;
    float peak_nits = 1000;  ///< of pictures of high range
    /// Makes a surface for the window: at first, and after one was lost.
    std::function<Result<VkSurfaceKHR>(VkInstance)> make_surface;
};

/// A frame that is being recorded.
struct PresentFrame {
    std::uint64_t number = 0;  ///< counts from 0
    std::uint32_t slot = 0;    ///< number modulo frames_in_flight: whatever the slot's last frame used is free
    VkCommandBuffer commands = VK_NULL_HANDLE;
    /// To be drawn on. It is in COLOR_ATTACHMENT_OPTIMAL, and back in it when end() is called.
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkExtent2D extent{};
    /// So many frames ago the image was shown, and has what that frame drew; 0: its content is unknown.
    std::uint64_t age = 0;
};

struct PresenterCounters {
    std::uint64_t swapchains = 0, surfaces = 0;  ///< made so far
    std::size_t retired = 0;                     ///< swapchains that wait to be freed
};

class Presenter {
  public:
    static constexpr const char* device_extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;

    /// On a device that was made with the window's extensions and this one. Errors: the queue cannot show pictures in
    /// the window, VkResult.
    [[nodiscard]] static Result<Presenter> create(Device& device, PresenterDesc desc);
    Presenter(Presenter&&) noexcept;
    Presenter& operator=(Presenter&&) noexcept;
    ~Presenter();  ///< waits for all frames

    /// Waits until the slot is free and begins a frame for a window of this extent. Nothing: there is nothing to draw
    /// on now, as the window is minimised or has changed meanwhile; the next call may find more.
    [[nodiscard]] Result<std::optional<PresentFrame>> begin(VkExtent2D window);
    /// Submits the frame that was begun, and shows it.
    [[nodiscard]] Result<> end();
    /// Waits for all frames that were submitted.
    [[nodiscard]] Result<> wait();
    /// Has the frame of this number finished? Never waits.
    [[nodiscard]] bool is_finished(std::uint64_t number) const;

    /// Of the images: an UNORM one where the surface has one, so that encoded pictures are shown as they are.
    [[nodiscard]] VkFormat format() const;
    /// What their numbers mean.
    [[nodiscard]] const ColorState& color() const;
    /// Can the images be copied from?
    [[nodiscard]] bool can_copy() const;
    [[nodiscard]] const PresenterCounters& counters() const;

  private:
    struct State;
    explicit Presenter(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace darkroom::window
