// SPDX-License-Identifier: MIT
#pragma once
// The kernels of one pass that a composer knows: the complete one, and lean ones by their shape. They come from the
// device's store. Recording looks one up without a lock; what is missing is built by the worker and arrives later.

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "compose/atomic_stack.hpp"
#include "gpu/kernel/kernel_store.hpp"
#include "plan/program.hpp"

namespace darkroom::compose {

class PassKernels {
  public:
    explicit PassKernels(const plan::ProgramPass& pass) : pass_(pass) {}
    PassKernels(const PassKernels&) = delete;
    PassKernels& operator=(const PassKernels&) = delete;
    ~PassKernels();

    // At compile, or on the worker.
    [[nodiscard]] Result<> build_complete(gpu::KernelStore& store);
    /// Gets the kernel of a shape; find() has it from then on. One that cannot be built is remembered: the complete one
    /// takes its place. That is no error, but told, where there is no compiler and nobody baked it.
    [[nodiscard]] Result<> build(gpu::Context& context, const plan::Shape& shape);
    [[nodiscard]] bool has_complete() const { return complete_ != nullptr; }
    [[nodiscard]] const gpu::Kernel& complete() const { return *complete_; }
    /// Was it built before? It may have made room for others since; then recordings want it again.
    [[nodiscard]] bool was_built(const plan::Shape& shape) const;
    /// The shape that was last missing, once.
    [[nodiscard]] std::optional<plan::Shape> take_wanted();

    // On the thread that records.
    /// Null: the kernel is not there yet. `recording` counts those of all chains of the program, of which the last
    /// `unfinished` may still use what they found. What must go goes to `garbage`.
    [[nodiscard]] const gpu::Kernel* find(const plan::Shape& shape, std::uint64_t recording, std::uint64_t unfinished,
                                          AtomicStack<Garbage>& garbage);
    /// True: it was not wanted yet, so the worker has to be told.
    [[nodiscard]] bool want(const plan::Shape& shape);

    PassKernels* next = nullptr;  ///< in the worker's list of those that want something

  private:
    struct Lean {
        plan::Shape shape;
        std::shared_ptr<const gpu::Kernel> kernel;  ///< null: it could not be built
        std::uint64_t last_used = 0;
    };
    struct Arrival : Garbage {
        Lean lean;
        Arrival* next = nullptr;
    };
    void take_arrivals(std::uint64_t recording, std::uint64_t unfinished, AtomicStack<Garbage>& garbage);
    /// Where a further kernel goes: behind the last, or over the one that was used longest ago, if no recording uses
    /// it.
    [[nodiscard]] Lean* place_for_another(std::uint64_t recording, std::uint64_t unfinished);
    [[nodiscard]] Lean* known(const plan::Shape& shape);

    const plan::ProgramPass& pass_;
    std::shared_ptr<const gpu::Kernel> complete_;
    mutable std::mutex built_mutex_;  ///< never taken while recording
    std::vector<plan::Shape> built_;
    AtomicStack<Arrival> arrivals_;
    std::array<Lean, 64> lean_{};
    std::size_t count_ = 0;
    // Words that may tear: the worst is a kernel that nobody asked for.
    using ShapeWords = std::array<std::uint64_t, sizeof(plan::Shape) / sizeof(std::uint64_t)>;
    std::array<std::atomic<std::uint64_t>, sizeof(plan::Shape) / sizeof(std::uint64_t)> wanted_{};
    std::atomic<bool> is_wanted_{false};
};

}  // namespace darkroom::compose
