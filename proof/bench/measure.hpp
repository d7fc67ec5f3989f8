// SPDX-License-Identifier: MIT
#pragma once
// What a benchmark stands on: a device with a scene and a target to draw into, rows that record work, and the rounds
// that measure all rows in turn. It knows no effect, and prints nothing.

#include <darkroom/composer.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gpu/resource/resources.hpp"
#include "world.hpp"

namespace darkroom::bench {

/// The pictures that all rows share. Both are left in VK_IMAGE_LAYOUT_GENERAL.
struct Bed {
    [[nodiscard]] static Result<std::unique_ptr<Bed>> create(Device& device, VkExtent2D extent);
    /// Where it was not made yet. It must be there before a use of it.
    [[nodiscard]] Result<> make_world();
    /// What the host of a Composer says of them.
    [[nodiscard]] Frame frame(WorldUse use = WorldUse::None) const;
    [[nodiscard]] CompileDesc compile_desc(WorldUse use = WorldUse::None) const;
    /// The target's bytes, four a pixel.
    [[nodiscard]] Result<std::vector<std::byte>> read_target() const;

    Device& device;
    gpu::Context& context;
    VkExtent2D extent{};
    gpu::Image scene;   ///< RGBA16F, procedural HDR
    gpu::Image target;  ///< RGBA8
    std::unique_ptr<const World> world;
};

/// One run of a row.
struct Sample {
    double cpu_ms = 0;   ///< of the whole process
    double wall_ms = 0;  ///< from submit to fence
    double gpu_ms = 0;   ///< between two timestamps; 0 without timestamps
};

/// Starts when it is made.
class Stopwatch {
  public:
    Stopwatch();
    [[nodiscard]] Sample elapsed() const;

  private:
    Sample start_;
};

struct Row {
    std::string name;
    std::function<Result<>(VkCommandBuffer)> record{};
    std::function<void()> host{};  ///< instead of `record`: work of the CPU
    double moved_bytes = 0;        ///< that it must read and write at least; 0: not known
    std::vector<Sample> samples{};
};

/// A command buffer that is recorded, submitted and waited for, again and again.
class Submitter {
  public:
    [[nodiscard]] static Result<std::unique_ptr<Submitter>> create(gpu::Context& context);
    Submitter(const Submitter&) = delete;
    Submitter& operator=(const Submitter&) = delete;
    ~Submitter();
    /// The clocks run from submit to fence: recording is not measured.
    [[nodiscard]] Result<Sample> run(const std::function<Result<>(VkCommandBuffer)>& record);
    /// Empties the command buffer and begins it.
    [[nodiscard]] Result<VkCommandBuffer> begin();
    [[nodiscard]] Result<> submit();
    [[nodiscard]] Result<> wait();

  private:
    explicit Submitter(gpu::Context& context) : context_(context) {}
    gpu::Context& context_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    gpu::Timers timers_;
};

/// Runs every row once unmeasured, then `rounds` times, one row after the other, so that a machine that becomes slower
/// meanwhile slows all rows alike.
[[nodiscard]] Result<> measure(Bed& bed, std::vector<Row>& rows, std::uint32_t rounds);

[[nodiscard]] double median(std::vector<double> values);
[[nodiscard]] double minimum(const std::vector<double>& values);
[[nodiscard]] std::vector<double> column(const Row& row, double Sample::*member);
/// Median over the rounds of `row` / `unit`, each pair measured in the same round. 0 where nothing was measured.
[[nodiscard]] double ratio(const Row& row, const Row& unit, double Sample::*member);
/// The same of `row` - `less`.
[[nodiscard]] double difference(const Row& row, const Row& less, const Row& unit, double Sample::*member);
/// What rows are compared by: process CPU time on a software driver, GPU time elsewhere.
[[nodiscard]] double Sample::*cost_of(const Device& device);

}  // namespace darkroom::bench
