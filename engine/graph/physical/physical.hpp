// SPDX-License-Identifier: MIT
#pragma once
// The Vulkan images behind the slots of a compiled graph: transients in one shared allocation, two images a history and
// view, and the host's images, lent frame by frame. It records barriers, resets and resampling; it decides nothing.
//
// Per recording of a view:
// 1. prepare(): what each history holds is worked out. Until end() all of it is staged: who gives up leaves no trace.
// 2. Schedule::derive(..., frame(view)).
// 3. begin(), barriers, passes, final barriers, end().

#include "gpu/resource/resources.hpp"
#include "graph/physical/history_pool.hpp"
#include "graph/schedule.hpp"

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
/// its own histories, and goes on with those of `pool`. The context must outlive it, the pool need not.
class Physical {
  public:
    Physical() = default;
    [[nodiscard]] static Result<Physical> create(gpu::Context& context, const Compiled& compiled, std::uint32_t views,
                                                 HistoryPool& pool);
    /// With histories of its own.
    [[nodiscard]] static Result<Physical> create(gpu::Context& context, const Compiled& compiled,
                                                 std::uint32_t views = 1);

    /// Lends a host's image until the next call. Copies the handles, allocates nothing.
    void bind(std::uint32_t import_index, const LentImage& image);

    [[nodiscard]] VkImage handle(std::uint32_t slot, std::uint32_t view_index = 0) const;
    /// All mip levels.
    [[nodiscard]] VkImageView view(std::uint32_t slot, std::uint32_t view_index = 0) const;
    [[nodiscard]] VkImageView mip_view(std::uint32_t slot, std::uint32_t mip_level, std::uint32_t view_index = 0) const;
    struct BufferRange {
        VkBuffer handle = VK_NULL_HANDLE;
        VkDeviceSize offset = 0, size = 0;
    };
    [[nodiscard]] BufferRange buffer(std::uint32_t slot, std::uint32_t view_index = 0) const;
    [[nodiscard]] VkFormat format(std::uint32_t slot) const { return entries_[slot].format; }
    /// Of the whole image; a frame may use its top left part only.
    [[nodiscard]] VkExtent2D extent(std::uint32_t slot) const { return entries_[slot].extent; }
    [[nodiscard]] std::uint32_t mip_levels(std::uint32_t slot) const { return entries_[slot].mip_levels; }

    /// Barriers of one step, or the final ones. No allocation.
    void record_barriers(VkCommandBuffer commands, const gpu::Dispatch& vk, std::span<const Barrier> barriers,
                         std::uint32_t view_index = 0) const;

    [[nodiscard]] HistoryView& histories(std::uint32_t view_index = 0) const { return *views_[view_index]; }
    /// By Slot::history_index; null if the graph does not use it.
    [[nodiscard]] HistoryImages* history(std::uint32_t history_index, std::uint32_t view_index = 0) const;
    [[nodiscard]] std::uint32_t history_count() const { return static_cast<std::uint32_t>(histories_.size()); }

    /// Begins a recording of the view, without commands. A history is valid if `is_related` (the frame goes on from the
    /// last one) and the view's last recording wrote it.
    void prepare(const Extents& extents, bool is_related, std::uint32_t view_index = 0);
    /// For Schedule::derive.
    [[nodiscard]] std::uint64_t frame(std::uint32_t view_index = 0) const {
        return histories(view_index).staged.recordings;
    }
    /// Orders the recording after all that another Physical, an older or a newer one, did to the view's histories. Of
    /// those that the schedule reads, it resets what is not valid, and if an extent that one of them is a fraction of
    /// is not the last frame's, or one of them lies in images of an older plan, resamples the others.
    void begin(VkCommandBuffer commands, const gpu::Dispatch& vk, const Schedule& schedule,
               std::uint32_t view_index = 0);
    /// The recording of the view is complete.
    void end(const Schedule& schedule, std::uint32_t view_index = 0);
    /// Takes back the view's last recording, which was this one's.
    void abandon(std::uint32_t view_index = 0);
    /// From now on what lies in images of an older plan is lost: they are held no longer.
    void forget_older();
    /// Clears a history to zero and brings it to its rest layout.
    void record_reset(VkCommandBuffer commands, const gpu::Dispatch& vk, std::uint32_t view_index,
                      std::uint32_t history_index) const;
    /// Of a valid history, resamples what the frame gets as previous, from one of the extents `from`, each the top left
    /// of its image: a copy where its own extent stays, else linearly where its format allows, by the nearest texel
    /// where it does not.
    void record_resample(VkCommandBuffer commands, const gpu::Dispatch& vk, std::uint32_t view_index,
                         std::uint32_t history_index, const Extents& from, const Extents& to) const;

  private:
    struct Entry {
        Slot::Kind kind = Slot::Kind::Transient;
        VkFormat format = VK_FORMAT_UNDEFINED;
        VkExtent2D extent{};
        Size size{};
        std::uint32_t mip_levels = 1, array_layers = 1;
        VkImageLayout rest_layout = VK_IMAGE_LAYOUT_UNDEFINED;
        std::uint32_t import_index = ~0u;
        std::uint32_t base_mip_level = 0, base_array_layer = 0;
        BufferRange buffer;                  ///< its size is 0 of an image
        std::uint32_t history = ~0u;         ///< of a lasting buffer
        std::vector<VkImage> handles;        ///< one, or one a view
        std::vector<VkImageView> views;      ///< the same
        std::vector<VkImageView> mip_views;  ///< view after view
    };
    /// Imports, constants and transients are the same in all views.
    [[nodiscard]] static std::size_t instance(const Entry& entry, std::uint32_t view_index) {
        return entry.handles.size() > 1 ? view_index : 0;
    }
    /// A history: its slots by parity, and its images in each view.
    struct History {
        std::array<std::uint32_t, 2> slots{~0u, ~0u};
        std::vector<std::shared_ptr<HistoryImages>> views;
    };
    static void adopt(Entry& entry, const gpu::Image& image);
    void adopt_history(const Slot& slot, std::uint32_t index);
    /// Is a history as large in both frames?
    [[nodiscard]] bool has_same_extent(std::uint32_t history_index, const Extents& a, const Extents& b) const;
    /// The images that the last recording left it in.
    [[nodiscard]] std::shared_ptr<const HistoryImages> source_of(const HistoryImages& images) const;
    void record_padding(VkCommandBuffer commands, const gpu::Dispatch& vk, const Entry& entry, VkImage image,
                        const Extents& from, const Extents& to) const;

    gpu::Buffer buffers_;  ///< all transient ones
    gpu::Memory memory_;   ///< before the images, so that they are destroyed first
    std::vector<gpu::Image> images_;
    std::vector<Entry> entries_;
    std::vector<History> histories_;  ///< by Slot::history_index
    std::vector<std::shared_ptr<HistoryView>> views_;
    std::vector<std::uint64_t> last_recordings_;  ///< per view: the number of this one's last
    bool is_resampled_ = false;                   ///< in the recording in hand
};

}  // namespace darkroom::graph
