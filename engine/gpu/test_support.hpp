// SPDX-License-Identifier: MIT
#pragma once
// For tests only: one device for the whole test program, with validation, where any message of the layer fails the test
// that caused it; images from floats and back; and one kernel run on its own.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <darkroom/device.hpp>
#include <memory>
#include <span>
#include <vector>

#include "gpu/kernel/kernel.hpp"
#include "gpu/resource/formats.hpp"
#include "gpu/resource/resources.hpp"
#include "gpu/test_smallest/device.hpp"

namespace darkroom::gpu::test {

/// The value, or the end of the test program: what a test is not about must work.
template <class T>
T must(Result<T> result) {
    if (!result) {
        std::fprintf(stderr, "test support: %s\n", result.error().text.c_str());
        std::abort();
    }
    if constexpr (!std::is_void_v<T>) return std::move(*result);
}

class SharedDevice : public ::testing::Environment {
  public:
    static SharedDevice& instance() {
        // The test program owns it, and tears it down before static objects go.
        static auto* const shared = static_cast<SharedDevice*>(::testing::AddGlobalTestEnvironment(new SharedDevice));
        return *shared;
    }
    /// With DARKROOM_TEST_DEVICE=smallest, that one.
    Device& device() {
        if (is_smallest()) return smallest();
        if (device_ == nullptr) device_ = std::make_unique<Device>(must(create()));
        return *device_;
    }
    Device& smallest() {
        if (smallest_ == nullptr) smallest_ = std::make_unique<SmallestDevice>(must(create()));
        return smallest_->device();
    }
    /// The smallest device once more, as a ComputeQueue lets it look.
    Device smallest_again() {
        static_cast<void>(smallest());
        return smallest_->adopted();
    }
    static bool is_smallest() {
        const char* const variable = std::getenv("DARKROOM_TEST_DEVICE");
        return variable != nullptr && std::string_view(variable) == "smallest";
    }
    void TearDown() override {
        if (smallest_ != nullptr) {
            EXPECT_EQ(smallest_->validation_messages(), 0U);
        }
        smallest_.reset();
        if (device_ == nullptr) return;
        EXPECT_EQ(device_->validation_messages(), 0U);
        device_.reset();
    }

  private:
    static void report(Severity severity, std::string_view text) {
        if (severity >= Severity::Warning) ADD_FAILURE() << text;
    }
    static Result<Device> create() {
        DeviceDesc desc{.validate = true, .log = report, .cache_folder = ::testing::TempDir() + "darkroom_test_cache"};
        Result<Device> device = Device::create(desc);
        if (device) return device;
        std::fprintf(stderr, "test support: %s; going on without validation\n", device.error().text.c_str());
        desc.validate = false;
        return Device::create(desc);
    }
    std::unique_ptr<Device> device_;
    std::unique_ptr<SmallestDevice> smallest_;
};
// Environments must be there before the tests start, and only register themselves here.
inline SharedDevice& shared_device = SharedDevice::instance();

inline Device& device() { return shared_device.device(); }
inline Context& context() { return device().context(); }

inline VkPhysicalDeviceLimits limits() {
    VkPhysicalDeviceProperties properties{};
    context().vk.GetPhysicalDeviceProperties(context().physical_device, &properties);
    return properties.limits;
}

/// While it lives, plans for the test's device are made as for a GPU or as for a driver on the CPU, whichever it is.
class PlannedFor {
  public:
    explicit PlannedFor(bool software) : was_software_(context().traits.is_software) {
        context().traits.is_software = software;
    }
    ~PlannedFor() { context().traits.is_software = was_software_; }
    PlannedFor(const PlannedFor&) = delete;
    PlannedFor& operator=(const PlannedFor&) = delete;

  private:
    bool was_software_;
};

/// Is it Mesa's software driver, the one that everything is first tested on? It filters, blends and places vertices in
/// single precision, and gives both stages the same operations: its tests are the strictest. What Vulkan leaves open is
/// allowed to all others, which another software driver is one of.
inline bool is_lavapipe() {
    VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    context().vk.GetPhysicalDeviceProperties2(context().physical_device, &properties);
    return driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE;
}

/// The part of the difference between two neighbouring texels that a filtered fetch may be wrong by, for each axis it
/// filters along. 0 on lavapipe, which filters in single precision: bounds are there what they are without.
/// Elsewhere one division of a texel. Vulkan specification, "Limits", subTexelPrecisionBits: "the number of bits of
/// precision in the division along an axis of an image used for minification and magnification filters. [...] Sub-texel
/// values calculated during image sampling will snap to these locations when generating the filtered results."
inline double filter_step() {
    if (is_lavapipe()) return 0;
    return std::ldexp(1.0, -static_cast<int>(limits().subTexelPrecisionBits));
}

/// How far in pixels, along either axis, a vertex may be from where it was put, and what a pixel shows from its centre:
/// half a step of the grid that vertices are moved to (Vulkan specification, "Limits", subPixelPrecisionBits). 0 on
/// lavapipe, whose grid of 1/256 stays within the bounds that tests have without it.
inline double vertex_shift() {
    return is_lavapipe() ? 0 : std::ldexp(0.5, -static_cast<int>(limits().subPixelPrecisionBits));
}

/// What two kernels of one picture may differ by, for values in [0,1]: nothing on lavapipe. Elsewhere a code
/// of 8 bits: kernels of other forms or stages may be contracted differently, and Vulkan lets an implementation take
/// either neighbour where a value is rounded to half precision or to a code.
inline double code_between_kernels() { return is_lavapipe() ? 0 : 1 / 255.0; }

inline float half_to_float(std::uint16_t half) {
    const std::uint32_t sign = (half & 0x8000U) << 16U;
    const std::uint32_t exponent = (half >> 10U) & 0x1fU;
    const std::uint32_t mantissa = half & 0x3ffU;
    if (exponent == 0) {
        const float magnitude = std::ldexp(static_cast<float>(mantissa), -24);
        return sign != 0 ? -magnitude : magnitude;
    }
    if (exponent == 31) return std::bit_cast<float>(sign | 0x7f800000U | (mantissa << 13U));
    return std::bit_cast<float>(sign | ((exponent + 112U) << 23U) | (mantissa << 13U));
}

/// To the nearest, ties to even.
inline std::uint16_t float_to_half(float value) {
    const std::uint32_t sign = (std::bit_cast<std::uint32_t>(value) >> 16U) & 0x8000U;
    const float magnitude = std::fabs(value);
    std::uint32_t half = 0;
    if (std::isnan(magnitude)) {
        half = 0x7e00U;
    } else if (magnitude >= 65520.0F) {
        half = 0x7c00U;
    } else if (magnitude < 0x1p-14F) {
        half = static_cast<std::uint32_t>(std::nearbyint(std::ldexp(magnitude, 24)));
    } else {
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(magnitude);
        const std::uint32_t rounded = bits + 0xfffU + ((bits >> 13U) & 1U);
        half = (rounded >> 13U) - (112U << 10U);
    }
    return static_cast<std::uint16_t>(sign | half);
}

/// Four floats a pixel, rows from the top.
struct Pixels {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<float> rgba;

    [[nodiscard]] std::size_t index(std::uint32_t x, std::uint32_t y) const {
        return (static_cast<std::size_t>(y) * width + x) * 4;
    }
    [[nodiscard]] std::array<float, 4> at(std::uint32_t x, std::uint32_t y) const {
        const std::size_t first = index(x, y);
        return {rgba[first], rgba[first + 1], rgba[first + 2], rgba[first + 3]};
    }
};

/// `color(x, y)` returns std::array<float, 4>.
template <class Color>
Pixels make_pixels(std::uint32_t width, std::uint32_t height, Color color) {
    Pixels pixels{width, height, std::vector<float>(static_cast<std::size_t>(width) * height * 4)};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::array<float, 4> value = color(x, y);
            std::ranges::copy(value, pixels.rgba.begin() + static_cast<std::ptrdiff_t>(pixels.index(x, y)));
        }
    }
    return pixels;
}

enum class Component : std::uint8_t { Unorm8, Half, Float };
struct TestFormat {
    VkFormat format = VK_FORMAT_UNDEFINED;
    Component component = Component::Float;
    std::uint32_t channels = 4;
    std::uint32_t bytes = 4;  ///< a component
};

inline TestFormat test_format(VkFormat format) {
    constexpr std::array formats{
        TestFormat{VK_FORMAT_R32G32B32A32_SFLOAT, Component::Float, 4, 4},
        TestFormat{VK_FORMAT_R32G32_SFLOAT, Component::Float, 2, 4},
        TestFormat{VK_FORMAT_R32_SFLOAT, Component::Float, 1, 4},
        TestFormat{VK_FORMAT_D32_SFLOAT, Component::Float, 1, 4},
        TestFormat{VK_FORMAT_R16G16B16A16_SFLOAT, Component::Half, 4, 2},
        TestFormat{VK_FORMAT_R16G16_SFLOAT, Component::Half, 2, 2},
        TestFormat{VK_FORMAT_R16_SFLOAT, Component::Half, 1, 2},
        TestFormat{VK_FORMAT_R8G8B8A8_UNORM, Component::Unorm8, 4, 1},
        TestFormat{VK_FORMAT_R8G8B8A8_SRGB, Component::Unorm8, 4, 1},
        TestFormat{VK_FORMAT_B8G8R8A8_UNORM, Component::Unorm8, 4, 1},
        TestFormat{VK_FORMAT_R8G8_UNORM, Component::Unorm8, 2, 1},
        TestFormat{VK_FORMAT_R8_UNORM, Component::Unorm8, 1, 1},
    };
    for (const TestFormat& candidate : formats) {
        if (candidate.format == format) return candidate;
    }
    std::fprintf(stderr, "test support: format %d is not in the table\n", static_cast<int>(format));
    std::abort();
}

inline void encode(const TestFormat& format, float value, std::byte* out) {
    if (format.component == Component::Float) {
        std::memcpy(out, &value, sizeof value);
    } else if (format.component == Component::Half) {
        const std::uint16_t half = float_to_half(value);
        std::memcpy(out, &half, sizeof half);
    } else {
        *out = static_cast<std::byte>(std::lround(std::fmin(std::fmax(value, 0.0F), 1.0F) * 255.0F));
    }
}

inline float decode(const TestFormat& format, const std::byte* in) {
    if (format.component == Component::Unorm8) return static_cast<float>(*in) / 255.0F;
    if (format.component == Component::Half) {
        std::uint16_t half = 0;
        std::memcpy(&half, in, sizeof half);
        return half_to_float(half);
    }
    float value = 0;
    std::memcpy(&value, in, sizeof value);
    return value;
}

/// B8G8R8A8 stores blue first.
inline std::uint32_t stored_channel(const TestFormat& format, std::uint32_t channel) {
    return format.format == VK_FORMAT_B8G8R8A8_UNORM && channel < 3 ? 2 - channel : channel;
}

inline VkImageAspectFlags aspect_of(VkFormat format) {
    return format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

/// An image and the layout it is in.
struct Picture {
    Image image;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;

    [[nodiscard]] Region whole() const {
        const VkExtent2D extent{image.info.extent.width, image.info.extent.height};
        return {.extent = extent, .image = extent};
    }
};

/// Every usage that the device has for the format.
inline VkImageUsageFlags all_usage(const Context& context, VkFormat format) {
    VkImageUsageFlags usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (context.supports(format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)) usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
    if (context.supports(format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    if (context.supports(format, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT)) usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    return usage;
}

}  // namespace darkroom::gpu::test
