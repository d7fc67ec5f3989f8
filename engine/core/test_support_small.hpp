// SPDX-License-Identifier: MIT
// Under a sanitizer everything takes many times as long, and tests of random things try fewer of them
// (tests/CMakeLists.txt sets the variable).
#pragma once

#include <cstdlib>

namespace darkroom::test {

inline bool is_small() { return std::getenv("DARKROOM_TEST_SMALL") != nullptr; }

}  // namespace darkroom::test
