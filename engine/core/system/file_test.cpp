// SPDX-License-Identifier: MIT
#include "core/system/file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

#include "core/files.hpp"

namespace darkroom {

namespace {

namespace fs = std::filesystem;

/// What every system does alike; what POSIX does beyond is tested where pictures are (files/image/files_test.cpp).
class SystemFiles : public ::testing::Test {
  protected:
    void SetUp() override {
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    [[nodiscard]] fs::path file(std::u8string_view name) const { return folder_ / fs::path(name); }
    [[nodiscard]] std::size_t count() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

    fs::path folder_ = fs::path(::testing::TempDir()) /
                       ("darkroom_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) +
                        "_" + std::to_string(process_number()));
};

std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

std::string text_of(const fs::path& path) {
    const auto content = read_file(path);
    if (!content) return content.error().text;
    return {reinterpret_cast<const char*>(content->data()), content->size()};
}

TEST_F(SystemFiles, NamesMayHaveLettersOfAnyScript) {
    const fs::path path = file(u8"größer 光.bin");
    ASSERT_TRUE(write_file(path, bytes_of("a\r\nb\n\x1a c")));
    EXPECT_EQ(text_of(path), "a\r\nb\n\x1a c") << "bytes are not taken for text";
    EXPECT_TRUE(fs::directory_iterator(folder_)->path().filename().u8string() == u8"größer 光.bin");
}

TEST_F(SystemFiles, WhatIsWrittenReplacesWhatWasThereAndLeavesNothingElse) {
    ASSERT_TRUE(write_file(file(u8"a"), bytes_of("a long one, which was there before")));
    ASSERT_TRUE(write_file(file(u8"a"), bytes_of("short"), true));
    EXPECT_EQ(text_of(file(u8"a")), "short");
    {
        const auto temporary = AtomicPath::beside(file(u8"a"));
        ASSERT_TRUE(temporary);
        EXPECT_EQ(count(), 2U);
    }
    EXPECT_EQ(count(), 1U) << "what is not committed goes";
    EXPECT_EQ(text_of(file(u8"a")), "short");
}

TEST_F(SystemFiles, WhatIsNoFileIsSaidSo) {
    const auto error_of = [](const auto& result) {
        return result ? Error{Fault::Machine, "no error"} : result.error();
    };
    const Error missing = error_of(read_file(file(u8"none")));
    EXPECT_EQ(missing.text, file(u8"none").string() + ": there is no such file");
    EXPECT_EQ(missing.fault, Fault::User);
    EXPECT_EQ(error_of(read_file(folder_)).text, folder_.string() + ": is a folder, a file is needed");
    EXPECT_EQ(error_of(write_file(folder_, bytes_of("x"))).text, folder_.string() + ": is a folder, a file is needed");
    const Error nowhere = error_of(write_file(file(u8"no") / "such", bytes_of("x")));
    EXPECT_TRUE(nowhere.text.starts_with((file(u8"no") / "such").string() + ": cannot create: ")) << nowhere.text;
    EXPECT_EQ(count(), 0U);
}

TEST_F(SystemFiles, AStampTellsWhatWasReplaced) {
    EXPECT_EQ(stamp_of(file(u8"a")), FileStamp{});
    ASSERT_TRUE(write_file(file(u8"a"), bytes_of("one")));
    const FileStamp first = stamp_of(file(u8"a"));
    EXPECT_EQ(first.size, 3U);
    EXPECT_EQ(stamp_of(file(u8"a")), first);
    ASSERT_TRUE(write_file(file(u8"b"), bytes_of("two")));
    fs::last_write_time(file(u8"b"), fs::last_write_time(file(u8"a")));
    fs::rename(file(u8"b"), file(u8"a"));
    EXPECT_NE(stamp_of(file(u8"a")), first) << "of the same size and time, but another file";
}

TEST_F(SystemFiles, OneIsCreatedOnceAndReadToItsEnd) {
    OpenFile out, again, in;
    ASSERT_FALSE(out.open(file(u8"a"), OpenFile::How::Create));
    EXPECT_EQ(again.open(file(u8"a"), OpenFile::How::Create), std::errc::file_exists);
    ASSERT_FALSE(out.write(bytes_of("abc")));
    ASSERT_FALSE(out.reach_disk());
    ASSERT_FALSE(out.close());
    ASSERT_FALSE(in.open(file(u8"a"), OpenFile::How::Read));
    std::array<std::byte, 8> room{};
    std::size_t read = 8;
    ASSERT_FALSE(in.read(room, read));
    EXPECT_EQ(read, 3U);
    ASSERT_FALSE(in.read(room, read));
    EXPECT_EQ(read, 0U);
    FileFacts facts;
    ASSERT_FALSE(in.facts(facts));
    EXPECT_EQ(facts.size, 3U);
    EXPECT_EQ(facts.kind, FileKind::Regular);
}

}  // namespace

}  // namespace darkroom
