// SPDX-License-Identifier: MIT
#pragma once
// One frame of a compiled graph: which passes run, and every barrier. Of Schedule's steps record the barriers, then the
// pass; then the final barriers.

#include <optional>

#include "graph/graph.hpp"

namespace darkroom::graph {

/// Where the host's image is when the frame starts, and where it shall be left.
struct ImportState {
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    /// Of the host's last use; NONE: the host has waited for it, so that Slot::uses see it.
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkAccessFlags2 access = VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkImageLayout final_layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< UNDEFINED: leave it where it is
    /// For these it is made ready whether a pass uses it or not. NONE: the host waits for Slot::uses itself.
    VkPipelineStageFlags2 final_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkAccessFlags2 final_access = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
};

struct Barrier {
    std::uint32_t slot = 0;
    MipRange mips{};
    VkPipelineStageFlags2 source_stages = 0, target_stages = 0;
    VkAccessFlags2 source_access = 0, target_access = 0;
    VkImageLayout old_layout = VK_IMAGE_LAYOUT_UNDEFINED, new_layout = VK_IMAGE_LAYOUT_UNDEFINED;
    /// The host keeps the layouts of depth and stencil apart: the stencil, if there is one, stays as it is.
    bool is_depth_alone = false;
};

/// What leaves an image that no pass uses as its host asks; none: it is so already. `uses`: those that the plan has for
/// it in other frames, if any.
[[nodiscard]] std::optional<Barrier> barrier_of_unused(const ImportState& host, const ImageUses& uses = {});

struct Step {
    std::uint32_t pass = 0;  ///< index into Compiled::passes()
    std::uint32_t first_barrier = 0, barrier_count = 0;
};

/// The commands of one frame as plain data: what the checker walks.
struct Recording {
    std::span<const Step> steps;
    std::span<const Barrier> barriers, final_barriers;
    std::span<const std::uint8_t> gates;          ///< 0: off; gates beyond the span are on
    std::span<const VkImageLayout> read_layouts;  ///< per slot: what sampling passes find it in
    std::uint64_t frame = 0;
};

/// One frame's order of work. Its storage is made for the worst case by the constructor, so derive() allocates nothing.
/// It refers to what `compiled` owns: `compiled` must outlive it, but may be moved.
///
/// The state of images between frames: transients hold nothing and start in UNDEFINED, ordered after whatever any pass
/// may have done to their memory. Histories rest in Slot::rest_layout. Imports are where their ImportState says.
class Schedule {
  public:
    using Step = graph::Step;
    explicit Schedule(const Compiled& compiled);
    ~Schedule();
    Schedule(Schedule&&) noexcept;
    Schedule& operator=(Schedule&&) noexcept;

    /// Works out which passes run, what every version resolves to, and all barriers. `gates[i]` switches the passes
    /// that name gate i; those beyond the span are on. `imports` holds one state per import, in the order they were
    /// imported; those beyond the span have the default state. `frame` tells the parity of histories. Barriers against
    /// the previous frame on the same queue are included: on aliased memory, too.
    void derive(std::span<const bool> gates, std::span<const ImportState> imports, std::uint64_t frame);
    [[nodiscard]] std::span<const Step> steps() const;
    [[nodiscard]] std::span<const Barrier> barriers() const;        ///< of all steps
    [[nodiscard]] std::span<const Barrier> final_barriers() const;  ///< after the last step: the host's layouts
    [[nodiscard]] Recording recording() const;
    [[nodiscard]] bool runs(std::uint32_t pass) const;  ///< is this kept pass among the steps?
    /// Does a pass that runs read what the last frame left in this history?
    [[nodiscard]] bool reads_history(std::uint32_t history_index) const;
    /// Do the passes that run leave in it all that the next frame may read?
    [[nodiscard]] bool writes_history(std::uint32_t history_index) const;
    /// The slot that a reader of `version` gets in this frame, after fall-backs (`instead`: Read::instead). ~0u: the
    /// version was culled, or its producer is off and has no fall-back (then nothing that runs reads it).
    [[nodiscard]] std::uint32_t slot_of(Version version, Version instead = {}) const;
    /// The layout in which SampledCompute and SampledFragment find a slot in this frame. A host's image that is only
    /// read stays where it is, if it can be sampled there: depth that the host goes on testing, for one.
    [[nodiscard]] VkImageLayout read_layout(std::uint32_t slot) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace darkroom::graph
