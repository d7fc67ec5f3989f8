// SPDX-License-Identifier: MIT
#pragma once
// The images of histories, shared by the plans that follow each other: a plan that is made while another runs takes
// over the images of every history that both have, so what moves on the screen leaves its trail across an edit. The
// Physicals own them, the pool finds them; it records nothing.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "gpu/resource/resources.hpp"
#include "graph/graph.hpp"

namespace darkroom::graph {

/// A history in one view. It holds what a frame may read if the view's last recording wrote it.
struct HistoryImages {
    enum class Resampling : std::uint8_t { None, Nearest, Linear };
    static constexpr std::uint64_t never = ~std::uint64_t{0};
    std::shared_ptr<gpu::Memory> memory;       ///< of all histories that one plan was the first to declare
    std::array<gpu::Image, 2> images;          ///< by Slot::history_parity
    gpu::Buffer buffer;                        ///< of a lasting buffer, in place of the images
    Resampling resampling = Resampling::None;  ///< where the extent changes; else they are copied
    /// Of the same history, used in other ways: the first recording goes on with what they hold.
    std::weak_ptr<HistoryImages> older{};
    // Recording alone touches what follows.
    std::uint64_t last_written = never;  ///< number of the view's recording that wrote it
    std::uint64_t before = never;        ///< the same before the view's last recording
    bool is_valid = false;               ///< for the recording in hand
};

/// What the histories of a view have in common. Recording alone touches it.
struct HistoryView {
    struct State {
        std::uint64_t recordings = 0;    ///< what Schedule::derive takes as the next frame: its parity is that of all
        Extents extents;                 ///< of the last frame
        std::array<float, 16> camera{};  ///< for the caller: world to camera, of the last frame
    };
    State now, staged;
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
    /// as the plan wants, else new ones, whose images share one allocation; they go on with what those there hold. For
    /// one thread at a time; another one may meanwhile record.
    [[nodiscard]] Result<Histories> acquire(gpu::Context& context, std::span<const Slot> slots, std::uint32_t views);
    [[nodiscard]] std::shared_ptr<HistoryView> view(std::uint32_t index);

  private:
    /// Of the same kind and size, if a Physical uses it; else null.
    [[nodiscard]] std::shared_ptr<HistoryImages> find(const Slot& slot, std::uint32_t view_index) const;

    /// By key and view, the newest last: one that a failed compile made is gone with it, and the one before is found.
    std::map<std::pair<HistoryKey, std::uint32_t>, std::vector<std::weak_ptr<HistoryImages>>> images_;
    std::vector<std::shared_ptr<HistoryView>> views_;
};

}  // namespace darkroom::graph
