// SPDX-License-Identifier: MIT
#include "core/system/module.hpp"

#include <gtest/gtest.h>

namespace darkroom {

namespace {

TEST(SystemModule, TheProgramKnowsWhereItLies) {
    EXPECT_EQ(running_program().stem(), "darkroom_tests");
    EXPECT_TRUE(std::filesystem::is_regular_file(running_program()));
    // The tests are linked with the archives.
    std::error_code error;
    EXPECT_TRUE(std::filesystem::equivalent(own_library(), running_program(), error)) << own_library();
}

TEST(SystemModule, WhatCannotBeLoadedIsNamedInOneLine) {
    for (const char* const name : {"libdarkroom-no-such.so", "no-such/darkroom-none.dll"}) {
        const Result<void*> loaded = load_library(name);
        ASSERT_FALSE(loaded);
        EXPECT_TRUE(loaded.error().text.starts_with(std::string(name) + ": ")) << loaded.error().text;
        EXPECT_GT(loaded.error().text.size(), std::string(name).size() + 4);
        EXPECT_EQ(loaded.error().text.find_first_of("\r\n"), std::string::npos) << loaded.error().text;
        EXPECT_EQ(loaded.error().fault, Fault::Machine);
    }
}

TEST(SystemModule, ALibraryHasItsSymbolsAndNoOthers) {
#ifdef _WIN32
    const Result<void*> library = load_library("kernel32.dll");
    const char* const symbol = "GetCurrentProcessId";
#else
    const Result<void*> library = load_library("libm.so.6");
    const char* const symbol = "cos";
#endif
    ASSERT_TRUE(library) << library.error().text;
    EXPECT_NE(symbol_of(*library, symbol), nullptr);
    EXPECT_EQ(symbol_of(*library, "darkroom_no_such_function"), nullptr);
}

}  // namespace

}  // namespace darkroom
