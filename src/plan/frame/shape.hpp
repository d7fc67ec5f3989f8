// SPDX-License-Identifier: MIT
#pragma once
// The kernels of one pass: the complete one, which skips switched-off entries by uniform branches, and the lean ones,
// each for one shape of the frame: which entries are on, which are plain, how regions lie, and the values of choices.
// Pure: from a pass and a shape to a spec.

#include <cstdint>
#include <darkroom/param.hpp>

#include "gpu/kernel/kernel.hpp"

namespace darkroom::plan {

struct ProgramPass;

/// What a lean kernel is made for. `steps`: two bits a step, whether it is on and whether it has an opacity, a blend
/// mode or a mask; then what it does for the target. `choices`: the values of the literals that the pass's text names,
/// as far as they fit.
struct Shape {
    std::uint64_t steps = 0;
    std::uint64_t choices = 0;
    static constexpr std::uint64_t output_is_twice = std::uint64_t{1} << 58;  ///< in steps
    static constexpr std::uint64_t rays_meet = std::uint64_t{1} << 59;        ///< in steps
    static constexpr std::uint32_t finish_bit = 60;  ///< in steps, two bits: a Finish, for kernels of Finish::OfFrame
    static constexpr std::uint64_t is_whole = std::uint64_t{1} << 62;        ///< in steps: all regions are whole images
    static constexpr std::uint64_t input_is_twice = std::uint64_t{1} << 63;  ///< in steps
    friend bool operator==(const Shape&, const Shape&) = default;
};
inline constexpr std::size_t max_lean_steps = 29;

/// A row whose value is a literal of the lean kernels of a pass, and its bits in Shape::choices.
struct Literal {
    std::uint32_t step = 0;
    const ParamInfo* row = nullptr;
    std::uint32_t bit = 0, bits = 0;

    [[nodiscard]] std::uint64_t mask() const { return (std::uint64_t{1} << bits) - 1; }
};
/// Gives the rows that the texts of the steps name their bits.
void lay_out_literals(ProgramPass& pass);

/// Has this pass lean kernels at all?
[[nodiscard]] bool has_lean(const ProgramPass& pass);
[[nodiscard]] Result<gpu::KernelSpec> complete_spec(const ProgramPass& pass);
/// Same images, outputs and members as the complete one; only the steps that are on, and no branches.
[[nodiscard]] Result<gpu::KernelSpec> lean_spec(const ProgramPass& pass, const Shape& shape);

}  // namespace darkroom::plan
