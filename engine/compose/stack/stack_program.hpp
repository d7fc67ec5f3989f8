// SPDX-License-Identifier: MIT
#pragma once
// A planned stack with its kernels, and what it was planned from: a resize, and a compile of what has not changed, take
// the one that is there and make neither text nor graph.

#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "compose/chain/pass_kernels.hpp"
#include "compose/chain/tables.hpp"

namespace darkroom::compose {

/// All but what the frames bring, and the largest extent and the views, which a program is independent of, as far as
/// its answers are the same.
[[nodiscard]] inline auto facts_of(const CompileDesc& desc) {
    return std::tie(desc.target, desc.target_extent.width, desc.target_extent.height, desc.target_domain,
                    desc.target_color, desc.is_color_associated, desc.encodes_target, desc.kernels, desc.fuse,
                    desc.intermediate, desc.watches);
}

/// Of all chains of a composer, one after the other: by it kernels and uploads know which recordings have finished.
/// Recording alone touches it.
struct Clock {
    std::uint64_t recordings = 0;
    std::uint32_t max_unfinished = 1;
};

struct StackProgram {
    plan::Program program;
    std::vector<std::unique_ptr<PassKernels>> kernels;  ///< per pass
    std::vector<plan::Entry> stack;
    CompileDesc desc;
    std::optional<Tables> tables;  ///< made with the first chain
    LitShadowMap lit;              ///< where a kernel reads shadows

    /// The constant images, unless they are there; as far as they are those of `older`, that one's. May be null.
    [[nodiscard]] Result<> make_tables(gpu::Context& context, const StackProgram* older);
    /// Would planning `other_stack` for `other_desc` give this program again?
    [[nodiscard]] bool serves(std::span<const plan::Entry> other_stack, const CompileDesc& other_desc) const;
};

[[nodiscard]] plan::PlannerTraits planner_traits(const gpu::Context& context, KernelStage kernels);
[[nodiscard]] Result<std::shared_ptr<StackProgram>> plan_stack(const gpu::Context& context,
                                                               std::span<const plan::Entry> stack,
                                                               const CompileDesc& desc);

}  // namespace darkroom::compose
