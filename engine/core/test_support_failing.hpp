// SPDX-License-Identifier: MIT
#pragma once
// Tries a function with each of its allocations failing once.

#include <gtest/gtest.h>

#include "core/test_support_allocations.hpp"

namespace darkroom::test {

/// Calls `call` with the first, the second, ... allocation of its thread failing, until none does.
template <class Call>
void with_each_allocation_failing(const char* name, const Call& call) {
    constexpr std::uint64_t most = 100000;
    for (std::uint64_t number = 0; number < most; ++number) {
        const FailingAllocation failing(number);
        try {
            call();
        } catch (...) {
            ADD_FAILURE() << name << ": an exception left it as allocation " << number << " failed";
        }
        if (!failing.has_failed()) return;
    }
    ADD_FAILURE() << name << " never got by without allocations";
}

}  // namespace darkroom::test
