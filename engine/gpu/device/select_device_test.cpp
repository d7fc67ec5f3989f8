// SPDX-License-Identifier: MIT
#include "gpu/device/select_device.hpp"

#include <gtest/gtest.h>

#include <array>

namespace darkroom::gpu {

namespace {

// Best first, as the library lists them; indices are the driver's order.
const std::array devices{
    DeviceInfo{.index = 2, .name = "NVIDIA GeForce RTX 4090", .is_usable = true},
    DeviceInfo{.index = 0, .name = "AMD Radeon 780M", .is_usable = true},
    DeviceInfo{.index = 1, .name = "llvmpipe (LLVM 15.0.6, 256 bits)", .is_usable = true},
};

TEST(SelectDevice, NothingMeansTheBest) { EXPECT_EQ(select_device(devices, "").value(), 0U); }

TEST(SelectDevice, ANumberIsAnIndexWhereThereIsSuchAnIndex) {
    EXPECT_EQ(select_device(devices, "0").value(), 1U);
    EXPECT_EQ(select_device(devices, "1").value(), 2U);
    EXPECT_EQ(select_device(devices, "2").value(), 0U);
}

TEST(SelectDevice, AnotherNumberIsPartOfAName) {
    EXPECT_EQ(select_device(devices, "4090").value(), 0U);
    EXPECT_EQ(select_device(devices, "780").value(), 1U);
    EXPECT_EQ(select_device(devices, "256").value(), 2U);
    const DeviceInfo long_name{.name = "device 99999999999999999999"};
    EXPECT_EQ(select_device({&long_name, 1}, "99999999999999999999").value(), 0U) << "beyond any index";
}

TEST(SelectDevice, CaseDoesNotMatterAndTheBestOfSeveralWins) {
    EXPECT_EQ(select_device(devices, "geforce").value(), 0U);
    EXPECT_EQ(select_device(devices, "LLVMPIPE").value(), 2U);
    EXPECT_EQ(select_device(devices, "a").value(), 0U);
}

TEST(SelectDevice, ErrorsNameBothReadingsOfANumberAndWhatThereIs) {
    const Result<std::size_t> number = select_device(devices, "3070");
    ASSERT_FALSE(number);
    EXPECT_EQ(number.error().fault, Fault::User);
    EXPECT_EQ(number.error().text,
              "device \"3070\": no device has this index or a name with this in it; there are 2 \"NVIDIA GeForce RTX "
              "4090\", 0 \"AMD Radeon 780M\", 1 \"llvmpipe (LLVM 15.0.6, 256 bits)\"");
    const Result<std::size_t> name = select_device(devices, "voodoo");
    ASSERT_FALSE(name);
    EXPECT_TRUE(name.error().text.starts_with("device \"voodoo\": no such device; there are 2 "));
    const Result<std::size_t> nothing = select_device({}, "0");
    ASSERT_FALSE(nothing);
    EXPECT_EQ(
        nothing.error().text,
        "no Vulkan device: the loader found no driver; Mesa's software driver is in the package mesa-vulkan-drivers");
}

}  // namespace

}  // namespace darkroom::gpu
