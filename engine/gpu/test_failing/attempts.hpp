// SPDX-License-Identifier: MIT
#pragma once
// For tests only: a run of the library in which one Vulkan call fails, once for each call and each error that it may
// have. What failed says so in words, is tried once more, and then all is as if nothing had happened.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <mutex>
#include <random>
#include <string>
#include <vector>

#include "gpu/test_failing/failing_vulkan.hpp"
#include "gpu/test_support.hpp"

namespace darkroom::gpu::test {

/// One run. Its device is the test's own once more, by functions that may fail; the host's calls go to the test's.
class Attempt {
  public:
    /// What `step` gives. One that failed is tried once more.
    template <class Step>
    auto operator()(std::string_view doing, const Step& step) -> decltype(step()) {
        auto done = step();
        if (done) return done;
        expect_told(doing, done.error());
        auto again = step();
        if (!again) ADD_FAILURE() << doing << ", once more: " << again.error().text;
        return again;
    }
    /// An error that came by another way.
    void expect_told(std::string_view doing, const Error& error) {
        const failing::Failed failed = failing::failed();
        const std::string name = result_name(failed.result);
        EXPECT_FALSE(failed.name.empty()) << doing << " failed by itself: " << error.text;
        const std::size_t at = error.text.find(name);
        EXPECT_NE(at, std::string::npos) << doing << ": " << error.text << ", but it was " << name;
        EXPECT_GT(at, 10U) << doing << ": " << error.text << " does not say what was being done";
        EXPECT_EQ(error.text.find('\n'), std::string::npos) << error.text;
        EXPECT_EQ(error.fault, Fault::Machine) << error.text;
        const bool is_lost = failed.result == VK_ERROR_DEVICE_LOST;
        EXPECT_EQ(error.code == ErrorCode::DeviceLost, is_lost) << error.text;
        const bool is_memory = name.find("MEMORY") != std::string::npos || name.find("FRAGMENT") != std::string::npos;
        EXPECT_EQ(error.code == ErrorCode::OutOfMemory, is_memory) << error.text;
        is_told_ = true;
    }
    /// Of the device of the library.
    void log(std::string_view text) {
        const std::lock_guard lock(mutex_);
        is_told_ = is_told_ || text.find(result_name(failing::failed().result)) != std::string_view::npos;
    }
    [[nodiscard]] bool is_told() const { return is_told_; }

    /// Of `plain` with functions that may fail. Its log is this attempt's.
    [[nodiscard]] AdoptDesc desc_over(Device& plain) {
        static constexpr std::array extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
        static VkPhysicalDeviceVulkan13Features features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                                         .synchronization2 = VK_TRUE,
                                                         .dynamicRendering = VK_TRUE};
        static const VkPhysicalDeviceFeatures2 all{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                                   .pNext = &features};
        const Context& host = plain.context();
        return {
            .instance = host.instance,
            .physical_device = host.physical_device,
            .device = host.device,
            .queue_family = host.queue_family,
            .enabled_features = &all,
            .enabled_instance_extensions = std::span(extensions).first(host.traits.has_debug_labels),
            .get_proc = failing::vulkan_over(host.vk.GetInstanceProcAddr),
            .log = [this](Severity, std::string_view text) { log(text); },
            .cache_folder = host.cache_folder.string(),
        };
    }
    [[nodiscard]] Result<Device> adopted(Device& plain) {
        Result<Device> device = Device::adopt(desc_over(plain));
        if (device) device->context().queue = plain.context().queue;
        return device;
    }

  private:
    std::mutex mutex_;
    bool is_told_ = false;
};

/// Runs it, and tells its pictures as bytes.
using Scenario = std::function<std::vector<std::byte>(Attempt&)>;

/// What cannot be told, or needs no word: a picture comes out right without it.
inline bool is_harmless(const failing::Failed& call) {
    // There is another way to wait, and on a GPU other memory that the host can write.
    if (call.name == "vkWaitForFences") return call.result != VK_ERROR_DEVICE_LOST;
    if (call.name == "vkAllocateMemory" || call.name == "vkMapMemory") return !device().info().is_software;
    return call.name == "vkSetDebugUtilsObjectNameEXT" || call.name == "vkGetPipelineCacheData" ||
           call.name == "vkGetQueryPoolResults" || call.name == "vkDeviceWaitIdle" ||
           call.name == "vkGetSemaphoreCounterValue" || call.result == VK_ERROR_OUT_OF_DATE_KHR ||
           call.result == VK_ERROR_SURFACE_LOST_KHR;
}

struct Points {
    std::size_t calls = 0, tried = 0;
};

/// All points, or `most` of them by `seed`. `plain`: what the attempts' devices are of.
inline Points try_each_call(const Scenario& scenario, std::size_t most = ~std::size_t{0}, std::uint32_t seed = 1,
                            Device& plain = device()) {
    const std::uint64_t messages = plain.validation_messages();
    const auto run = [&](std::uint64_t number, std::size_t error, Attempt& attempt) {
        failing::arm(number, error);
        std::vector<std::byte> out = scenario(attempt);
        failing::disarm();
        EXPECT_EQ(failing::alive(), std::vector<std::string>{});
        EXPECT_EQ(failing::take_wrongs(), std::vector<std::string>{});
        return out;
    };
    // Twice, since what is made on disk by the first is found by those that follow.
    std::vector<std::byte> expected;
    for (int i = 0; i < 2; ++i) {
        Attempt untouched;
        expected = run(failing::never, 0, untouched);
    }
    const std::vector<failing::Call> calls = failing::calls();
    struct Point {
        std::uint64_t number = 0;
        std::size_t error = 0;
    };
    std::vector<Point> points;
    for (std::size_t i = 0; i < calls.size(); ++i)
        for (std::size_t error = 0; error < calls[i].errors; ++error) points.push_back({i, error});
    if (points.size() > most) {
        std::mt19937 random(seed);
        std::shuffle(points.begin(), points.end(), random);
        points.resize(most);
    }
    Points out{.calls = calls.size()};
    for (const auto [number, error] : points) {
        SCOPED_TRACE(fmt::format("call {} ({}), error {}", number, calls[number].name, error));
        Attempt attempt;
        const std::vector<std::byte> picture = run(number, error, attempt);
        const failing::Failed failed = failing::failed();
        EXPECT_EQ(picture == expected, true) << failed.name << " left another picture";
        EXPECT_TRUE(attempt.is_told() || is_harmless(failed)) << failed.name << " failed, and nobody heard of it";
        EXPECT_EQ(plain.validation_messages(), messages) << failed.name;
        ++out.tried;
        if (::testing::Test::HasFailure()) break;
    }
    return out;
}

}  // namespace darkroom::gpu::test
