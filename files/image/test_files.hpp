// SPDX-License-Identifier: MIT
#pragma once
// For the tests of image files: a folder of their own that is removed afterwards, and the folder of test data.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace darkroom {

/// The folder that DARKROOM_TEST_DATA names, if it is set.
inline std::optional<std::filesystem::path> test_data() {
    const char* folder = std::getenv("DARKROOM_TEST_DATA");
    if (folder == nullptr || *folder == 0) return std::nullopt;
    return folder;
}

class WithFolder : public testing::Test {
  protected:
    void SetUp() override {
        const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("darkroom_") + test->test_suite_name() + test->name() + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] std::size_t file_count() const {
        std::size_t count = 0;
        for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_)) ++count;
        return count;
    }
    static std::string content(const std::filesystem::path& path) {
        std::ifstream stream(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    static void put(const std::filesystem::path& path, const std::string& text) {
        std::ofstream(path, std::ios::binary) << text;
    }

    std::filesystem::path folder_;
};

class WithData : public WithFolder {
  protected:
    void SetUp() override {
        WithFolder::SetUp();
        const auto folder = test_data();
        if (!folder) GTEST_SKIP() << "DARKROOM_TEST_DATA is not set";
        data_ = *folder;
    }
    std::filesystem::path data_;
};

}  // namespace darkroom
