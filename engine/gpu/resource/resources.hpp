// SPDX-License-Identifier: MIT
#pragma once
// RAII for the Vulkan objects that the library makes: memory, images, buffers, descriptor sets, timers, and one-off
// submissions on a device of our own. Nothing here is called while recording, except where it says so.

#include <vulkan/vulkan.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/try.hpp"
#include "gpu/device/context.hpp"
#include "gpu/resource/memory_types.hpp"

namespace darkroom::gpu {

class Memory {
  public:
    using Kind = MemoryKind;
    Memory() = default;
    /// One of `type_bits`; size, alignment and what it is for are those of `wanted`.
    [[nodiscard]] static Result<Memory> create(Context&, DeviceMemoryRequest wanted, std::uint32_t type_bits, Kind,
                                               std::string_view what);
    Memory(Memory&&) noexcept;
    Memory& operator=(Memory&&) noexcept;
    ~Memory();
    DeviceMemory piece{};
    std::byte* mapped = nullptr;  ///< all but Kind::Device: persistently mapped, coherent
    VkDeviceSize size = 0;
    Context* context = nullptr;
};

struct ImageInfo {
    std::string name;
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent3D extent{1, 1, 1};
    std::uint32_t mip_levels = 1;
    std::uint32_t array_layers = 1;
    VkImageUsageFlags usage = 0;
    VkImageType type = VK_IMAGE_TYPE_2D;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
};

/// An image, one view of the whole, one of each mip level, and of an array one of each layer's first level. With its
/// own memory, or placed in somebody else's.
class Image {
  public:
    Image() = default;
    [[nodiscard]] static Result<Image> create(Context&, const ImageInfo&);
    /// Placed: the memory must outlive the image.
    [[nodiscard]] static Result<Image> place(Context&, const ImageInfo&, const Memory&, VkDeviceSize offset);
    /// All of them side by side in one piece, which is then `memory`.
    [[nodiscard]] static Result<std::vector<Image>> create_together(Context&, std::span<const ImageInfo>,
                                                                    std::string_view what, Memory& memory);
    [[nodiscard]] static Result<VkMemoryRequirements> measure(Context&, const ImageInfo&);
    Image(Image&&) noexcept;
    Image& operator=(Image&&) noexcept;
    ~Image();
    VkImage handle = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    std::vector<VkImageView> mip_views;
    std::vector<VkImageView> layer_views;  ///< only where there are several layers
    ImageInfo info{};
    Memory memory;
    Context* context = nullptr;
};

class Buffer {
  public:
    Buffer() = default;
    [[nodiscard]] static Result<Buffer> create(Context&, VkDeviceSize size, VkBufferUsageFlags, Memory::Kind,
                                               std::string_view name);
    Buffer(Buffer&&) noexcept;
    Buffer& operator=(Buffer&&) noexcept;
    ~Buffer();
    VkBuffer handle = VK_NULL_HANDLE;
    Memory memory;
    Context* context = nullptr;
};

/// Descriptor sets allocated once for a list of layouts; freed together.
class DescriptorSets {
  public:
    DescriptorSets() = default;
    [[nodiscard]] static Result<DescriptorSets> create(Context&, std::span<const VkDescriptorSetLayout> layouts);
    DescriptorSets(DescriptorSets&&) noexcept;
    DescriptorSets& operator=(DescriptorSets&&) noexcept;
    ~DescriptorSets();
    std::vector<VkDescriptorSet> sets;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    Context* context = nullptr;
};

/// How far a counter of `valid_bits` bits went from `begin` to `end`, if it went round at most once.
[[nodiscard]] std::uint64_t elapsed_ticks(std::uint64_t begin, std::uint64_t end, std::uint32_t valid_bits);

/// GPU timestamps, a ring of `slots` recordings of up to `marks` marks each. begin() and mark() record only; nothing
/// but create() allocates. One thread at a time.
class Timers {
  public:
    Timers() = default;
    [[nodiscard]] static Result<Timers> create(Context&, std::uint32_t slots, std::uint32_t marks);
    Timers(Timers&&) noexcept;
    Timers& operator=(Timers&&) noexcept;
    ~Timers();
    void begin(VkCommandBuffer, std::uint32_t slot);
    void mark(VkCommandBuffer, std::uint32_t slot, std::uint32_t index);
    /// Milliseconds between neighbouring marks of a finished recording; empty while it is not finished. Never waits.
    /// A slot may be read once it has begun in a recording that has finished, or from the start where is_reset.
    std::size_t read(std::uint32_t slot, std::uint32_t count, std::span<double> milliseconds);
    /// One a slot, none without timestamps: the validation layers of 2026 take the reset of a part for one of the
    /// whole, which a recording under way may still write.
    std::vector<VkQueryPool> pools;
    bool is_reset = false;  ///< by the host; else the first recording of a slot does it
    std::uint32_t marks = 0;
    std::vector<std::uint64_t> ticks;  ///< what read() reads, `marks` of them
    Context* context = nullptr;
};

/// Commands on the context's own queue that may not have finished yet.
class Submission {
  public:
    Submission();  ///< nothing to wait for
    /// Records with `body` and submits.
    [[nodiscard]] static Result<Submission> begin(Context&, std::string_view what,
                                                  const std::function<void(VkCommandBuffer)>& body);
    Submission(Submission&&) noexcept;
    Submission& operator=(Submission&&) noexcept;
    ~Submission();  ///< waits
    [[nodiscard]] Result<> wait();

  private:
    struct State;
    explicit Submission(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// Records with `body`, submits on the context's own queue and waits. For uploads, read-back, and headless work.
[[nodiscard]] Result<> submit_and_wait(Context&, std::string_view what,
                                       const std::function<void(VkCommandBuffer)>& body);

/// Brings a whole image into another layout, after everything before and before everything after; what a copy out of it
/// wrote is then there for the host, too. For uploads and read-back, where nothing finer would gain.
void transition(const Context&, VkCommandBuffer, const Image&, VkImageLayout from, VkImageLayout to);

void name_object(Context&, VkObjectType, std::uint64_t handle, const std::string& name);
void begin_label(const Context&, VkCommandBuffer, const char* name);
void end_label(const Context&, VkCommandBuffer);

}  // namespace darkroom::gpu
