// SPDX-License-Identifier: MIT
#pragma once
// The images of histories, shared by the plans that follow each other: a plan that is made while another runs takes
// over the images of every history that both have, so what moves on the screen leaves its trail across an edit. The
// pool owns them together with the Physicals that use them; it records nothing.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "gpu/resource/resources.hpp"
#include "graph/graph.hpp"

namespace darkroom::graph {

/// What is known of a history in one view between its frames. Recording alone touches it.
struct HistoryState {
    std::uint64_t recordings = 0;  ///< HistoryView::recordings after the last frame that it was a part of
    bool was_on = false;           ///< for the caller: did that frame write it?
    bool needs_reset = true;       ///< it holds nothing that a frame may read
    bool was_reset = false;        ///< for the caller: the present frame finds zero in it
};

/// A history in one view.
struct HistoryImages {
    enum class Resampling : std::uint8_t { None, Nearest, Linear };
    std::shared_ptr<gpu::Memory> memory;  ///< of all histories that one plan was the first to declare
    std::array<gpu::Image, 2> images;     ///< by Slot::history_parity
    gpu::Buffer buffer;                   ///< of a lasting buffer, in place of the images
    Resampling resampling = Resampling::None;
    HistoryState state;
};

/// What the histories of a view have in common. Recording alone touches it.
struct HistoryView {
    std::uint64_t recordings = 0;    ///< what Schedule::derive takes as the next frame: its parity is that of all
    Extents extents;                 ///< of the last frame
    std::uint64_t recorder = 0;      ///< number of the Physical that recorded last
    std::array<float, 16> camera{};  ///< for the caller: world to camera, of the last frame
};

/// How buffers of the graph are made: for whatever passes do with them.
inline constexpr VkBufferUsageFlags buffer_usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                   VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                                                   VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

/// By Slot::history_index and view.
using Histories = std::vector<std::vector<std::shared_ptr<HistoryImages>>>;

class HistoryPool {
  public:
    /// The histories that a plan declares: those that are there, if they are of the same kind and size and can be used
    /// as the plan wants, else new ones, whose images share one allocation. For one thread at a time; another one may
    /// meanwhile record.
    [[nodiscard]] Result<Histories> acquire(gpu::Context& context, std::span<const Slot> slots, std::uint32_t views);
    [[nodiscard]] std::shared_ptr<HistoryView> view(std::uint32_t index);
    /// A number for whoever records, never 0.
    [[nodiscard]] std::uint64_t next_recorder() { return ++last_recorder_; }
    /// Drops the images that no Physical uses. For the thread that acquires.
    void trim();
    [[nodiscard]] std::size_t size() const { return images_.size(); }

  private:
    /// Null: it is to be made.
    [[nodiscard]] std::shared_ptr<HistoryImages> find(const Slot& slot, std::uint32_t view_index) const;

    std::map<std::pair<HistoryKey, std::uint32_t>, std::shared_ptr<HistoryImages>> images_;  ///< by key and view
    std::vector<std::shared_ptr<HistoryView>> views_;
    std::uint64_t last_recorder_ = 0;
};

}  // namespace darkroom::graph
