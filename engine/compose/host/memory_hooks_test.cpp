// SPDX-License-Identifier: MIT
// A host whose allocator hands out ranges of a few large allocations: the library binds at the offsets it is given, and
// its pictures are the same.
#include <map>
#include <mutex>

#include "compose/test_stacks/host.hpp"
#include "gpu/device/test_host_desc.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;

/// One block a memory type, filled from its front. What is freed comes back with the block.
class SubAllocator {
  public:
    SubAllocator() = default;
    SubAllocator(const SubAllocator&) = delete;
    SubAllocator& operator=(const SubAllocator&) = delete;
    ~SubAllocator() {
        for (const auto& [type, block] : blocks_)
            gpu::test::context().vk.FreeMemory(gpu::test::context().device, block.memory, nullptr);
    }
    [[nodiscard]] DeviceMemoryHooks hooks() { return {.allocate = allocate, .free = free, .user = this}; }
    [[nodiscard]] std::size_t blocks() const { return blocks_.size(); }
    int pieces = 0, live = 0, at_an_offset = 0, for_one_image = 0, for_one_buffer = 0;

  private:
    static constexpr VkDeviceSize block_size = VkDeviceSize{64} << 20U;
    struct Block {
        VkDeviceMemory memory = VK_NULL_HANDLE;
        std::byte* mapped = nullptr;
        VkDeviceSize end = 0;
    };

    static VkResult allocate(void* user, VkDevice device, const DeviceMemoryRequest* request, DeviceMemory* memory) {
        return static_cast<SubAllocator*>(user)->take(device, *request, *memory);
    }
    static void free(void* user, VkDevice, const DeviceMemory* memory) {
        auto& self = *static_cast<SubAllocator*>(user);
        const std::lock_guard lock(self.mutex_);
        EXPECT_EQ(self.blocks_.at(*static_cast<const std::uint32_t*>(memory->owner)).memory, memory->memory);
        --self.live;
    }
    VkResult take(VkDevice device, const DeviceMemoryRequest& request, DeviceMemory& out) {
        const std::lock_guard lock(mutex_);
        const gpu::Dispatch& vk = gpu::test::context().vk;
        const auto [found, is_new] = blocks_.try_emplace(request.memory_type);
        Block& block = found->second;
        if (is_new) {
            const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                            .allocationSize = block_size,
                                            .memoryTypeIndex = request.memory_type};
            if (const VkResult made = vk.AllocateMemory(device, &info, nullptr, &block.memory); made != VK_SUCCESS)
                return made;
        }
        if (request.is_mapped && block.mapped == nullptr) {
            void* mapped = nullptr;
            if (const VkResult made = vk.MapMemory(device, block.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
                made != VK_SUCCESS)
                return made;
            block.mapped = static_cast<std::byte*>(mapped);
        }
        // Images and buffers do not meet within bufferImageGranularity.
        const VkDeviceSize alignment = std::max<VkDeviceSize>(request.alignment, 65536);
        const VkDeviceSize offset = (block.end + alignment - 1) / alignment * alignment;
        if (offset + request.size > block_size) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        block.end = offset + request.size;
        out = {.memory = block.memory,
               .offset = offset,
               .mapped = request.is_mapped ? block.mapped + offset : nullptr,
               .owner = const_cast<std::uint32_t*>(&found->first)};
        ++pieces;
        ++live;
        at_an_offset += offset > 0 ? 1 : 0;
        for_one_image += request.image != VK_NULL_HANDLE ? 1 : 0;
        for_one_buffer += request.buffer != VK_NULL_HANDLE ? 1 : 0;
        return VK_SUCCESS;
    }

    std::mutex mutex_;
    std::map<std::uint32_t, Block> blocks_;
};

class ComposeMemoryHooks : public test::StackTest {
  protected:
    /// A device of the host's whose memory comes from `memory`.
    static Device adopted(SubAllocator& memory) {
        const VkPhysicalDeviceVulkan13Features features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                                        .synchronization2 = VK_TRUE,
                                                        .dynamicRendering = VK_TRUE};
        const VkPhysicalDeviceFeatures2 all{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                            .pNext = const_cast<VkPhysicalDeviceVulkan13Features*>(&features)};
        AdoptDesc desc = gpu::test::host_desc(&all);
        desc.memory = memory.hooks();
        Device device = test::must(Device::adopt(desc));
        device.context().queue = gpu::test::context().queue;  // for the uploads of the test
        device.context().vk.AllocateMemory = nullptr;
        device.context().vk.MapMemory = nullptr;
        return device;
    }
    /// Two frames of a stack with pyramids, a table and `histories` histories.
    static ReferenceImage developed(Device& device, int histories = 1) {
        const ReferenceImage picture = test::round_to_float(test::random_display(61, 47, 7));
        const Host host(picture, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, device);
        Composer composer(device);
        add(composer, "bloom");
        for (int i = 0; i < histories; ++i) {
            const Handle blur = add(composer, "gaussian_blur");
            add(composer, "blend", {}, {.second = blur.previous(), .opacity = 0.5f});
        }
        add(composer, "encode");
        add(composer, "dither");
        test::must(composer.compile(host.compile_desc()));
        (void)host.run(composer);
        return host.run(composer);
    }
};

TEST_F(ComposeMemoryHooks, ASubAllocatorGivesTheSamePicture) {
    SubAllocator memory;
    {
        Device device = adopted(memory);
        // The adopted device has fewer features, so that some of a GPU's halves are other formats there.
        const double rounded = gpu::test::is_lavapipe() ? 0 : 0x1p-11;
        EXPECT_LE(test::worst_difference(developed(device), developed(gpu::test::device())), rounded);
        EXPECT_GT(memory.at_an_offset, 5);
        EXPECT_GT(memory.for_one_buffer, 0);
        EXPECT_LT(memory.for_one_image + memory.for_one_buffer, memory.pieces) << "transients share a piece";
    }
    EXPECT_EQ(memory.live, 0);
    EXPECT_LE(memory.blocks(), gpu::test::is_lavapipe() ? 3U : 4U) << "images may have memory of their own type";
}

TEST_F(ComposeMemoryHooks, TheHistoriesOfAPlanShareAPiece) {
    const auto pieces = [](int histories) {
        SubAllocator memory;
        {
            Device device = adopted(memory);
            (void)developed(device, histories);
        }
        EXPECT_EQ(memory.live, 0);
        return memory.pieces;
    };
    EXPECT_EQ(pieces(3), pieces(1));
}

TEST_F(ComposeMemoryHooks, WhatWasRetiredBeforeMoreViewsCameStaysAsLongAsTheLast) {
    SubAllocator memory;
    {
        Device device = adopted(memory);
        const ReferenceImage picture = test::round_to_float(test::random_display(24, 18, 7));
        const Host host(picture, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, device);
        // Without a thread, what was put away is freed by the next compile.
        Composer composer(device, {.frames_in_flight = 2, .max_threads = 0});
        add(composer, "bloom");
        add(composer, "encode");
        CompileDesc desc = host.compile_desc();
        const auto compile = [&] {
            const int before = memory.live;
            test::must(composer.compile(desc));
            return memory.live - before;
        };
        const auto record = [&](int times) {
            for (int i = 0; i < times; ++i) (void)host.run(composer);
        };
        compile();
        record(1);
        compile();
        // The first two are to be kept from here, too: six recordings may go on from what they left, and as many more
        // are made before the last of those has finished.
        desc.views = 3;
        compile();
        const int of_one = compile();
        EXPECT_GT(of_one, 0);
        record(4);
        EXPECT_EQ(compile(), of_one) << "one that recordings may still use was freed";
        record(13);
        EXPECT_LT(compile(), 0) << "none was freed";
    }
    EXPECT_EQ(memory.live, 0);
}

}  // namespace
}  // namespace darkroom
