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
#include <thread>
#include <vector>

#include "compose/program.hpp"
#include "gpu/context.hpp"

namespace darkroom::compose {

/// Two bits a step: on, and with opacity, blend mode or mask. Passes of more steps have no lean kernels.
using Shape = std::uint64_t;
inline constexpr std::size_t max_lean_steps = 31;
inline constexpr Shape no_shape = ~Shape{0};

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
    [[nodiscard]] Shape take_wanted() { return wanted_.exchange(no_shape); }
    [[nodiscard]] bool has_lean() const { return !pass_->steps.empty() && pass_->steps.size() <= max_lean_steps; }

  private:
    struct Lean {
        Shape shape = no_shape;
        std::unique_ptr<gpu::Kernel> kernel;
    };
    /// More shapes than this stay with the complete kernel: toggles beyond are rarer than memory is dear.
    static constexpr std::size_t capacity = 64;

    const ProgramPass* pass_;
    std::unique_ptr<gpu::Kernel> complete_;
    std::mutex building_;
    std::array<Lean, capacity> lean_{};
    std::atomic<std::size_t> count_{0};
    std::atomic<Shape> wanted_{no_shape};
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
