// SPDX-License-Identifier: MIT
#pragma once
// The Vulkan images behind the slots of a compiled graph: transients in one shared allocation, two images a history and
// view, and the host's images, lent frame by frame. It records barriers and resets; it decides nothing.

#include "gpu/resources.hpp"
#include "graph/graph.hpp"

namespace darkroom::graph {

/// Asks the device for the requirements of images. The context must outlive it.
[[nodiscard]] Measure measure_on(gpu::Context& context);

/// An image of the host, as it is lent for a frame.
struct LentImage {
    VkImage handle = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;       ///< of all mip levels
    std::span<const VkImageView> mip_views;  ///< one a level; may be empty if there is only one
    std::uint32_t base_mip_level = 0;        ///< of the host's image, that level 0 here is
    std::uint32_t base_array_layer = 0;
    std::uint32_t array_layers = 1;
};

/// Transients are shared by all views (the cameras that one graph is recorded for, one after the other); every view has
/// its own histories. The context must outlive it.
class Physical {
  public:
    Physical() = default;
    [[nodiscard]] static Result<Physical> create(gpu::Context& context, const Compiled& compiled,
                                                 std::uint32_t views = 1);

    /// Lends a host's image until the next call. Copies the handles, allocates nothing.
    void bind(std::uint32_t import_index, const LentImage& image);

    [[nodiscard]] VkImage handle(std::uint32_t slot, std::uint32_t view_index = 0) const;
    /// All mip levels.
    [[nodiscard]] VkImageView view(std::uint32_t slot, std::uint32_t view_index = 0) const;
    [[nodiscard]] VkImageView mip_view(std::uint32_t slot, std::uint32_t mip_level, std::uint32_t view_index = 0) const;
    [[nodiscard]] VkFormat format(std::uint32_t slot) const { return entries_[slot].format; }
    /// Of the whole image; a frame may use its top left part only.
    [[nodiscard]] VkExtent2D extent(std::uint32_t slot) const { return entries_[slot].extent; }
    [[nodiscard]] std::uint32_t mip_levels(std::uint32_t slot) const { return entries_[slot].mip_levels; }

    /// Barriers of one step, or the final ones. No allocation.
    void record_barriers(VkCommandBuffer commands, const gpu::Dispatch& vk, std::span<const Barrier> barriers,
                         std::uint32_t view_index = 0) const;
    /// Clears the histories of a view to zero and brings them to their rest layout: before the view's first frame,
    /// after a cut, and whenever a pass that writes one was off.
    void record_reset(VkCommandBuffer commands, const gpu::Dispatch& vk, std::uint32_t view_index = 0) const;

  private:
    struct Entry {
        Slot::Kind kind = Slot::Kind::Transient;
        VkFormat format = VK_FORMAT_UNDEFINED;
        VkExtent2D extent{};
        std::uint32_t mip_levels = 1, array_layers = 1;
        VkImageLayout rest_layout = VK_IMAGE_LAYOUT_UNDEFINED;
        std::uint32_t import_index = ~0u;
        std::uint32_t base_mip_level = 0, base_array_layer = 0;
        std::vector<VkImage> handles;        ///< one, or one a view
        std::vector<VkImageView> views;      ///< the same
        std::vector<VkImageView> mip_views;  ///< view after view
    };
    /// Imports, constants and transients are the same in all views.
    [[nodiscard]] static std::size_t instance(const Entry& entry, std::uint32_t view_index) {
        return entry.handles.size() > 1 ? view_index : 0;
    }
    static void adopt(Entry& entry, const gpu::Image& image);

    gpu::Memory memory_;  ///< before the images, so that they are destroyed first
    std::vector<gpu::Image> images_;
    std::vector<Entry> entries_;
    std::uint32_t view_count_ = 1;
};

}  // namespace darkroom::graph
