// SPDX-License-Identifier: MIT
#pragma once
// The kernels of one pass that a composer knows: the complete one, and lean ones by their shape. They come from the
// device's store. What is missing while one records is built by the worker and arrives later.

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "gpu/kernel/kernel_store.hpp"
#include "plan/program.hpp"

namespace darkroom::compose {

class PassKernels {
  public:
    explicit PassKernels(const plan::ProgramPass& pass) : pass_(pass) {}
    PassKernels(const PassKernels&) = delete;
    PassKernels& operator=(const PassKernels&) = delete;

    // At compile, or on the worker.
    [[nodiscard]] Result<> build_complete(gpu::KernelStore& store);
    /// Gets the kernel of a shape; find() has it from then on. One that cannot be built is remembered: the complete one
    /// takes its place. That is no error, but told, where there is no compiler and nobody baked it.
    [[nodiscard]] Result<> build(gpu::Context& context, const plan::Shape& shape);
    [[nodiscard]] bool has_complete() const { return complete_ != nullptr; }
    [[nodiscard]] const gpu::Kernel& complete() const { return *complete_; }
    /// Was it built before? It may have made room for others since; then recordings want it again.
    [[nodiscard]] bool was_built(const plan::Shape& shape) const;

    // On the thread that records: never waits.
    /// Null: the kernel is not there yet. `recording` counts those of all chains of the program, of which the last
    /// `unfinished` may still use what they found.
    [[nodiscard]] const gpu::Kernel* find(const plan::Shape& shape, std::uint64_t recording, std::uint64_t unfinished);
    /// Has the worker been told of it, as the last one that was missing?
    [[nodiscard]] bool is_wanted(const plan::Shape& shape) const { return wanted_ == shape; }
    void set_wanted(const plan::Shape& shape) { wanted_ = shape; }

  private:
    struct Lean {
        plan::Shape shape;
        std::shared_ptr<const gpu::Kernel> kernel;  ///< null: it could not be built
        std::uint64_t last_used = 0;
    };
    void take_arrivals(std::uint64_t recording, std::uint64_t unfinished);
    /// Where a further kernel goes: behind the last, or over the one that was used longest ago, if no recording uses
    /// it.
    [[nodiscard]] Lean* place_for_another(std::uint64_t recording, std::uint64_t unfinished);
    [[nodiscard]] Lean* known(const plan::Shape& shape);

    const plan::ProgramPass& pass_;
    std::shared_ptr<const gpu::Kernel> complete_;
    mutable std::mutex mutex_;  ///< guards the next three; find() tries it
    std::vector<plan::Shape> built_;
    std::vector<Lean> arrivals_;             ///< once taken: what gave way to them, which the next build() frees
    bool is_given_up_ = false;               ///< build() has thrown
    std::atomic<bool> has_arrivals_{false};  ///< so that find() need not try the lock
    std::array<Lean, 64> lean_{};
    std::size_t count_ = 0;
    std::optional<plan::Shape> wanted_;
};

}  // namespace darkroom::compose
