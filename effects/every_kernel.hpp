// SPDX-License-Identifier: MIT
#pragma once
// Every kernel of this build: of every effect alone, and of the chains of both shipped orders, complete and lean.

#include <string>
#include <vector>

#include "plan/program.hpp"

namespace darkroom {

struct NamedKernel {
    std::string name;  ///< of its stack and its pass
    bool is_lean = false;
    gpu::KernelSpec spec;
};

/// As `traits` plans them, for a frame that brings every image. Lean: whole images, every entry on, the choices of the
/// defaults; with `has_every_choice` of effects alone the other ones, too. Errors: a stack that cannot be planned.
[[nodiscard]] Result<std::vector<NamedKernel>> every_kernel(const plan::PlannerTraits& traits,
                                                            bool has_every_choice = false);

}  // namespace darkroom
