// SPDX-License-Identifier: MIT
#pragma once
// The kernels of a device, each made once: a request is the kernel's text, its stage and its outputs, and whoever asks
// for the same gets the same. Failures are remembered, too. Any thread may ask.

#include <condition_variable>
#include <cstdint>
#include <darkroom/result.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>

#include "core/hash.hpp"
#include "gpu/kernel/kernel.hpp"

namespace darkroom::gpu {

class KernelStore {
  public:
    /// Kernels that nobody holds stay, the `most_unused` used last.
    explicit KernelStore(Context& context, std::size_t most_unused = 256)
        : context_(context), most_unused_(most_unused) {}

    /// Makes the kernel, or waits for a thread that is making it, or returns the one that is there. Errors: those of
    /// Kernel::create. A fault of the text is not tried again; one of the machine is.
    [[nodiscard]] Result<std::shared_ptr<const Kernel>> get(const KernelSpec& spec, Stage stage);

    struct Counters {
        std::uint64_t requests = 0;
        std::uint64_t built = 0;   ///< pipelines
        std::uint64_t failed = 0;  ///< builds that failed
        std::size_t held = 0;      ///< kernels in the store now
    };
    [[nodiscard]] Counters counters() const;

  private:
    struct Entry {
        std::shared_ptr<const Kernel> kernel;
        std::optional<Error> error;
        std::uint64_t last_used = 0;
    };
    struct HashOfHash {
        std::size_t operator()(const Hash& hash) const { return static_cast<std::size_t>(hash.low); }
    };
    void drop_unused();

    Context& context_;
    std::size_t most_unused_;
    mutable std::mutex mutex_;
    std::condition_variable built_;
    std::unordered_map<Hash, Entry, HashOfHash> entries_;
    Counters counters_;
};

}  // namespace darkroom::gpu
