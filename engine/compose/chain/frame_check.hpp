// SPDX-License-Identifier: MIT
#pragma once
// Whether the host's images are what a plan needs: their descriptions before it is compiled, and each frame's before
// anything is recorded. What passes here is sound by all that the host said; what it said wrongly only the validation
// layers can see.

#include <darkroom/composer.hpp>
#include <optional>

#include "plan/program.hpp"

namespace darkroom::gpu {
class Context;
}

namespace darkroom::compose {

/// Can this device read the inputs and write the target as they are described?
[[nodiscard]] Result<> check_images(const gpu::Context& context, const CompileDesc& desc);

/// An image of a frame, other than the cascades of a light.
[[nodiscard]] const ImageRef& host_image(const Frame& frame, plan::HostImage which);

/// Have they texels in common?
[[nodiscard]] bool overlap(const ImageRef& a, const ImageRef& b);

/// Which of CompileDesc::watches has this number; none.
[[nodiscard]] std::optional<std::size_t> watch_with(const CompileDesc& desc, std::uint32_t id);

/// Is the frame for this plan, and for none of other formats or extents, or of images that `before` did not have?
[[nodiscard]] bool fits(const plan::Program& program, const CompileDesc& desc, const Frame& frame,
                        const CompileDesc& before);

/// Is every image that the program reads or writes given as it was compiled for? Allocates nothing, but for an error.
[[nodiscard]] Result<> check_frame(const plan::Program& program, const CompileDesc& desc, const Frame& frame);

}  // namespace darkroom::compose
