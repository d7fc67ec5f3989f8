// SPDX-License-Identifier: MIT
#pragma once
// The kernels of one fused pass: the complete one, which skips switched-off entries by uniform branches, and the lean
// ones, each for one shape (which entries are on, which are plain), built off the frame loop. Recording looks a lean
// kernel up without a lock and takes the complete one while there is none.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "plan/program.hpp"
#include "gpu/context.hpp"

namespace darkroom::compose {

using namespace plan;

/// What a lean kernel is made for: how its regions lie, and for a fused kernel, in two bits a step, whether it is on
/// and whether it has an opacity, a blend mode or a mask; then what it does for the target. `choices`: the values of
/// its choices, toggles and loop counts, as far as they fit.
struct Shape {
    std::uint64_t steps = 0;
    std::uint64_t choices = 0;
    static constexpr std::uint32_t finish_bit = 60;  ///< in steps, two bits: a Finish, for kernels of Finish::OfFrame
    static constexpr std::uint64_t is_whole = std::uint64_t{1} << 62;        ///< in steps: all regions are whole images
    static constexpr std::uint64_t input_is_twice = std::uint64_t{1} << 63;  ///< in steps
    friend bool operator==(const Shape&, const Shape&) = default;
};
inline constexpr std::size_t max_lean_steps = 30;

/// Bits of a shape that the value of a row takes; 0: it is no literal of lean kernels.
[[nodiscard]] constexpr std::uint32_t literal_bits(const ParamInfo& row) {
    if (row.is_loop_count) return 8;
    return row.kind == Kind::Choice ? 5 : row.kind == Kind::Toggle ? 1 : 0;
}

/// Calls `visit(step, row, first_bit, bits)` for every choice, toggle and loop count that a shape of this pass holds; a
/// pass of an effect counts as one step.
template <class Visit>
void for_each_choice(const ProgramPass& pass, const Visit& visit) {
    std::uint32_t bit = 0;
    const auto visit_rows = [&](std::size_t step, const EffectInfo& info) {
        for (const ParamInfo& row : info.parameters.rows) {
            const std::uint32_t bits = literal_bits(row);
            if (bits == 0 || bit + bits > 64) continue;
            visit(step, row, bit, bits);
            bit += bits;
        }
    };
    if (!is_fused(pass)) visit_rows(0, *pass.info);
    for (std::size_t i = 0; i < pass.steps.size(); ++i)
        if (!pass.steps[i].is_merge) visit_rows(i, *pass.steps[i].info);
}

/// The kernel of a pass that holds only the steps that are on: same images and bindings, no branches. A pass of an
/// effect has one step, itself.
[[nodiscard]] Result<gpu::KernelSpec> lean_spec(const ProgramPass& pass, std::span<const FusedStep> steps,
                                                Finish finish);

class Variants {
  public:
    explicit Variants(const ProgramPass& pass) : pass_(&pass) {}
    Variants(const Variants&) = delete;
    Variants& operator=(const Variants&) = delete;

    [[nodiscard]] Result<> build_complete(gpu::Context& context);
    /// Builds the kernel of a shape if it is not there. Any thread but one inside a frame loop.
    [[nodiscard]] Result<> build(gpu::Context& context, Shape shape);
    /// What to record now. Never waits; a missing shape is remembered as wanted.
    [[nodiscard]] const gpu::Kernel& find(Shape shape);
    [[nodiscard]] const gpu::Kernel& complete() const { return *complete_; }
    /// The shape that was last missing, once.
    [[nodiscard]] std::optional<Shape> take_wanted();
    [[nodiscard]] bool has_lean() const { return pass_->steps.size() <= max_lean_steps; }

  private:
    struct Lean {
        Shape shape;
        std::unique_ptr<gpu::Kernel> kernel;
    };
    /// More shapes than this stay with the complete kernel: toggles beyond are rarer than memory is dear.
    static constexpr std::size_t capacity = 64;

    const ProgramPass* pass_;
    std::unique_ptr<gpu::Kernel> complete_;
    std::mutex building_;
    std::array<Lean, capacity> lean_{};
    std::atomic<std::size_t> count_{0};
    // Two words that may tear: the worst is a kernel that nobody asked for.
    std::atomic<std::uint64_t> wanted_steps_{0}, wanted_choices_{0};
    std::atomic<bool> is_wanted_{false};
};

/// Builds wanted kernels on a thread of its own until it is destroyed.
class Builders {
  public:
    Builders(gpu::Context& context, std::vector<std::unique_ptr<Variants>>& variants);
    ~Builders();
    /// Something is wanted. Never waits.
    void wake();

  private:
    void work();
    gpu::Context& context_;
    std::vector<std::unique_ptr<Variants>>& variants_;
    std::atomic<std::uint32_t> calls_{0};
    std::atomic<bool> is_ending_{false};
    std::thread thread_;
};

}  // namespace darkroom::compose
