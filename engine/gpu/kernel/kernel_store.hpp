// SPDX-License-Identifier: MIT
#pragma once
// The kernels of a device, each made once: a request is the kernel's text, its stage and its outputs, and whoever asks
// for the same gets the same. A text is known by its SHA-256; debug builds compare the texts. Failures are remembered,
// too. Any thread may ask.

#include <array>
#include <condition_variable>
#include <cstdint>
#include <darkroom/result.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>

#include "gpu/kernel/kernel.hpp"

namespace darkroom::gpu {

class KernelStore {
  public:
    /// Kernels that nobody holds stay, the `max_unused` used last.
    explicit KernelStore(Context& context, std::size_t max_unused = 256) : context_(context), max_unused_(max_unused) {}

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
    /// What the text does not say stands beside it: a fragment shader names no format and no blending.
    struct Key {
        Digest text{};
        Stage stage = Stage::Compute;
        bool is_additive = false;
        std::array<VkFormat, max_outputs> outputs{};
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct HashOfKey {
        std::size_t operator()(const Key& key) const;
    };
    struct Entry {
        std::shared_ptr<const Kernel> kernel{};
        std::optional<Error> error{};
        std::uint64_t last_used = 0;
        std::string text{};  ///< of what failed, and in debug builds of all
    };
    [[nodiscard]] static Key key_of(const KernelSpec& spec, Stage stage, const Digest& text);
    void drop_unused();

    Context& context_;
    std::size_t max_unused_;
    mutable std::mutex mutex_;
    std::condition_variable built_;
    std::unordered_map<Key, Entry, HashOfKey> entries_;
    Counters counters_;
};

}  // namespace darkroom::gpu
