// SPDX-License-Identifier: MIT
#include "gpu/device/loader.hpp"

#include <gtest/gtest.h>

namespace darkroom::gpu {

namespace {

TEST(VulkanLoader, OneThatIsMissingIsNamedInOneLine) {
    const Result<PFN_vkGetInstanceProcAddr> missing = open_vulkan_loader("libdarkroom-no-such-loader.so.1");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().fault, Fault::Machine);
    EXPECT_TRUE(missing.error().text.starts_with("no Vulkan loader: libdarkroom-no-such-loader.so.1"))
        << missing.error().text;
    EXPECT_EQ(missing.error().text.find("has no"), std::string::npos) << "it was never opened";
    EXPECT_EQ(missing.error().text.find('\n'), std::string::npos);
}

TEST(VulkanLoader, ALibraryThatIsNoLoaderIsRefused) {
    const Result<PFN_vkGetInstanceProcAddr> other = open_vulkan_loader("libm.so.6");
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().text, "no Vulkan loader: libm.so.6 has no vkGetInstanceProcAddr");
}

}  // namespace

}  // namespace darkroom::gpu
