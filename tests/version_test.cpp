// SPDX-License-Identifier: MIT
#include <darkroom/version.hpp>

#include <gtest/gtest.h>

#include <string>

#include "tests/places.hpp"

namespace darkroom {
namespace {

TEST(Version, TheHeaderAgreesWithTheProject) {
    const std::string header =
        std::to_string(version_major) + "." + std::to_string(version_minor) + "." + std::to_string(version_patch);
    EXPECT_EQ(header, test::project_version);
    EXPECT_EQ(library_version(), version);
}

}  // namespace
}  // namespace darkroom
