// SPDX-License-Identifier: MIT
#pragma once
// The kernels of one pass: the complete one, which skips switched-off entries by uniform branches, and the lean ones,
// each for one shape of the frame: which entries are on, which are plain, how regions lie, and the values of choices.
// Pure: from a pass and a shape to a spec.

#include <array>
#include <cstdint>
#include <darkroom/param.hpp>

#include "gpu/kernel/kernel.hpp"

namespace darkroom::plan {

struct ProgramPass;

/// What a lean kernel is made for: which of its steps are on, and which of those have an opacity, a blend mode or a
/// mask, two bits a step; how regions lie and what it does for the target; and the values of the literals that the
/// pass's text names, as far as they fit.
struct Shape {
    static constexpr std::size_t max_steps = 128;  ///< those behind them keep their branches
    std::array<std::uint64_t, max_steps / 32> steps{};
    std::uint64_t flags = 0;
    std::uint64_t choices = 0;
    static constexpr std::uint64_t rays_meet = 1;   ///< in flags
    static constexpr std::uint64_t is_whole = 2;    ///< in flags: all regions are whole images
    static constexpr std::uint32_t finish_bit = 2;  ///< in flags: Conversion::word(), where a frame says how to finish
    friend bool operator==(const Shape&, const Shape&) = default;

    void set_step(std::size_t step, bool is_plain) {
        if (step < max_steps) steps[step / 32] |= (is_plain ? std::uint64_t{1} : std::uint64_t{3}) << (2 * (step % 32));
    }
    [[nodiscard]] bool is_on(std::size_t step) const { return (steps[step / 32] >> (2 * (step % 32)) & 1) != 0; }
    [[nodiscard]] bool is_plain(std::size_t step) const { return (steps[step / 32] >> (2 * (step % 32)) & 2) == 0; }
};

/// A row whose value is a literal of the lean kernels of a pass, and its bits in Shape::choices.
struct Literal {
    std::uint32_t step = 0;
    const ParamInfo* row = nullptr;  ///< null: Work::word of the step
    std::uint32_t bit = 0, bits = 0;

    [[nodiscard]] std::uint64_t mask() const { return (std::uint64_t{1} << bits) - 1; }
};
/// Gives the rows that the texts of the steps name their bits.
void lay_out_literals(ProgramPass& pass);

[[nodiscard]] Result<gpu::KernelSpec> complete_spec(const ProgramPass& pass);
/// Same images, outputs and members as the complete one; only the steps that are on, and no branches, but for those
/// behind Shape::max_steps.
[[nodiscard]] Result<gpu::KernelSpec> lean_spec(const ProgramPass& pass, const Shape& shape);

}  // namespace darkroom::plan
