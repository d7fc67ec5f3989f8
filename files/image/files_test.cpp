// SPDX-License-Identifier: MIT
#include "core/files.hpp"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "core/own_file.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

std::span<const std::byte> bytes(const std::string& text) { return std::as_bytes(std::span(text)); }

class ImageFiles : public WithFolder {};

TEST_F(ImageFiles, WhatIsWrittenIsRead) {
    const std::string text(100000, 'x');
    ASSERT_TRUE(write_file(file("a.bin"), bytes(text)));
    const auto back = read_file(file("a.bin"));
    ASSERT_TRUE(back);
    EXPECT_TRUE(std::ranges::equal(*back, bytes(text)));
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(ImageFiles, MissingFileNamesThePathAndIsTheUsersFault) {
    const auto missing = read_file(file("none.bin"));
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().fault, Fault::User);
    EXPECT_EQ(missing.error().text, file("none.bin").string() + ": there is no such file");
    EXPECT_FALSE(read_file(folder_));
}

TEST_F(ImageFiles, MissingFolderIsAnErrorAndLeavesNothing) {
    const auto written = write_file(file("no/such.bin"), bytes("x"));
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().text.find("no/such.bin"), std::string::npos);
    EXPECT_EQ(file_count(), 0u);
}

TEST_F(ImageFiles, WithoutCommitTheOldFileStays) {
    put(file("a.png"), "old");
    {
        auto temporary = AtomicPath::beside(file("a.png"));
        ASSERT_TRUE(temporary);
        EXPECT_EQ(temporary->path().extension(), ".png");
        EXPECT_EQ(temporary->path().parent_path(), folder_);
        put(temporary->path(), "half of the new");
        EXPECT_EQ(file_count(), 2u);
    }
    EXPECT_EQ(content(file("a.png")), "old");
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(ImageFiles, CommitReplacesKeepsPermissionsAndFollowsLinks) {
    put(file("a.txt"), "old");
    std::filesystem::permissions(file("a.txt"), std::filesystem::perms(0640));
    std::filesystem::create_symlink(file("a.txt"), file("link.txt"));
    ASSERT_TRUE(write_file(file("link.txt"), bytes("new")));
    EXPECT_EQ(content(file("a.txt")), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(file("link.txt")));
    EXPECT_EQ(std::filesystem::status(file("a.txt")).permissions(), std::filesystem::perms(0640));
}

TEST_F(ImageFiles, ALinkToNothingIsFollowedAndStays) {
    std::filesystem::create_symlink("second.txt", file("first.txt"));
    std::filesystem::create_symlink("later.txt", file("second.txt"));
    ASSERT_TRUE(write_file(file("first.txt"), bytes("new")));
    EXPECT_TRUE(std::filesystem::is_symlink(file("first.txt")));
    EXPECT_TRUE(std::filesystem::is_symlink(file("second.txt")));
    EXPECT_EQ(content(file("later.txt")), "new");
    std::filesystem::create_symlink("round.txt", file("round.txt"));
    EXPECT_FALSE(write_file(file("round.txt"), bytes("new")));
    EXPECT_TRUE(std::filesystem::is_symlink(file("round.txt")));
}

TEST_F(ImageFiles, FullDeviceIsAMachineErrorAndTheDeviceStays) {
    if (!std::filesystem::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    const auto written = write_file("/dev/full", bytes("x"));
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().fault, Fault::Machine);
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
    EXPECT_FALSE(AtomicPath::beside("/dev/full"));
}

// Ctrl-C at any moment, while several threads write.
TEST_F(ImageFiles, ASignalLeavesNoTemporaryFile) {
    for (int attempt = 0; attempt < 20; ++attempt) {
        const pid_t child = ::fork();
        if (child == 0) {
            // A shell ignores SIGINT in what it starts in the background.
            for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
            AtomicPath::remove_on_signals();
            std::vector<std::jthread> threads;
            for (int thread = 0; thread < 4; ++thread)
                threads.emplace_back([&, thread] {
                    const auto target = file("a" + std::to_string(thread));
                    for (;;) {
                        std::vector<AtomicPath> held;
                        for (int i = 0; i < 8; ++i) held.push_back(std::move(*AtomicPath::beside(target)));
                        static_cast<void>(held.front().commit());
                    }
                });
            threads.clear();
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5 + attempt));
        ::kill(child, attempt % 2 == 0 ? SIGINT : SIGTERM);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        ASSERT_TRUE(WIFSIGNALED(status));
        EXPECT_EQ(WTERMSIG(status), attempt % 2 == 0 ? SIGINT : SIGTERM);
        for (const auto& entry : std::filesystem::directory_iterator(folder_))
            EXPECT_TRUE(entry.path().filename().string().starts_with("a")) << entry.path();
    }
}

// What a stranger put under the name of a journal or an entry of a cache.
TEST_F(ImageFiles, FilesOfOurOwnFollowNoLinkAndWaitForNoPipe) {
    put(file("target"), "precious");
    std::filesystem::create_symlink("target", file("link"));
    std::filesystem::create_symlink("nowhere", file("dangling"));
    ASSERT_EQ(::mkfifo(file("pipe").c_str(), 0600), 0);
    put(file("own"), "old");
    const std::string text = "text";
    const auto write = [&](const char* name) { return write_own_file(file(name), std::as_bytes(std::span(text))); };
    for (const auto& [name, why] : {std::pair("link", "is a link, which is not followed"),
                                    std::pair("dangling", "is a link, which is not followed"),
                                    std::pair("pipe", "is no regular file"), std::pair(".", "is a folder")}) {
        const Result<> done = write(name);
        ASSERT_FALSE(done) << name;
        EXPECT_NE(done.error().text.find(why), std::string::npos) << done.error().text;
    }
    EXPECT_EQ(content(file("target")), "precious");
    EXPECT_FALSE(std::filesystem::exists(file("nowhere")));
    EXPECT_TRUE(write("own"));
    EXPECT_TRUE(write("new"));
    EXPECT_EQ(content(file("own")) + content(file("new")), "texttext");
    EXPECT_FALSE(write_file(file("pipe"), std::as_bytes(std::span(text)))) << "nobody reads, and nobody waits";
    EXPECT_EQ(file_count(), 6U) << "nothing is left beside them";
    if (::geteuid() != 0) return;
    // Records lie in folders that several people share.
    ASSERT_EQ(::chown(file("own").c_str(), 12345, ::getegid()), 0);
    const Result<> done = write("own");
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().text.find("belongs to another user; a regular file of this user"), std::string::npos);
    EXPECT_TRUE(write_own_file(file("own"), std::as_bytes(std::span(text)), FileOwner::Anyone));
    EXPECT_FALSE(write_own_file(file("link"), std::as_bytes(std::span(text)), FileOwner::Anyone));
    EXPECT_EQ(content(file("target")), "precious");
}

}  // namespace
}  // namespace darkroom
