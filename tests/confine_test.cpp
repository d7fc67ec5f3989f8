// SPDX-License-Identifier: MIT
// What a process can still do once it is confined, tried in a process of its own.
#include "confined/inside/confine.hpp"

#include <fcntl.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <optional>
#include <thread>

#include "confined/inside/serve.hpp"
#include "image/picture/write.hpp"
#include "image/test_files.hpp"
#include "tests/places.hpp"

namespace darkroom::test {
namespace {

class Confined : public WithFolder {
  protected:
    /// Whether the work says yes in a process that may read these folders, this test's unless told otherwise.
    template <class Work>
    [[nodiscard]] bool can(const Work& work, std::optional<std::vector<std::string>> folders = {}) const {
        const pid_t child = ::fork();
        if (child == 0) {
            const Confinement done = confine(folders.value_or(std::vector{folder_.string()}));
            ::_exit(!done.has_seccomp ? 3 : work() ? 0 : 1);
        }
        int status = 0;
        EXPECT_EQ(::waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFEXITED(status)) << "by signal " << WTERMSIG(status);
        EXPECT_NE(WEXITSTATUS(status), 3) << "no seccomp";
        return WEXITSTATUS(status) == 0;
    }
    [[nodiscard]] static bool has_landlock() {
        const pid_t child = ::fork();
        if (child == 0) ::_exit(confine({}).has_landlock ? 0 : 1);
        int status = 0;
        ::waitpid(child, &status, 0);
        return WIFEXITED(status) && WEXITSTATUS(status) == 0;
    }
};

TEST_F(Confined, ReadsItsFoldersAlone) {
    put(file("a"), "text");
    std::filesystem::create_directory(file("folder"));
    put(file("folder/b"), "text");
    const auto reads = [&](const std::string& path) {
        return can([&] {
            char letter = 0;
            const int opened = ::open(path.c_str(), O_RDONLY);
            return opened >= 0 && ::read(opened, &letter, 1) == 1;
        });
    };
    EXPECT_TRUE(reads(file("a")));
    EXPECT_TRUE(reads(file("folder/b")));
    if (!has_landlock()) GTEST_SKIP() << "this kernel has no Landlock";
    EXPECT_FALSE(reads("/etc/passwd"));
    EXPECT_FALSE(reads("/proc/self/maps"));
    EXPECT_FALSE(reads(file("folder/../../../etc/passwd")));
}

TEST_F(Confined, WithoutFoldersItOpensNothing) {
    put(file("a"), "text");
    const auto can_here = [&](const auto& work) { return can(work, std::vector<std::string>{}); };
    for (const int flags : {O_RDONLY, O_PATH, O_RDONLY | O_DIRECTORY, O_WRONLY})
        for (const std::string& path : {file("a").string(), folder_.string(), std::string("/proc/self/maps")})
            EXPECT_FALSE(can_here([&] { return ::open(path.c_str(), flags) >= 0; })) << path << flags;
    EXPECT_FALSE(can_here([&] { return ::access(file("a").c_str(), F_OK) == 0; }));
    EXPECT_FALSE(can_here([&] {
        std::error_code ignored;
        return std::filesystem::exists(folder_, ignored);
    }));
    EXPECT_FALSE(can_here([] { return ::socket(AF_UNIX, SOCK_STREAM, 0) >= 0; }));
    EXPECT_FALSE(can_here([] {
        const pid_t child = ::fork();
        if (child == 0) ::_exit(0);
        return child > 0;
    }));
    EXPECT_FALSE(can_here([parent = ::getppid()] { return ::syscall(SYS_tgkill, parent, parent, 0) == 0; }));
    EXPECT_FALSE(can_here([] {
        const rlimit more{RLIM_INFINITY, RLIM_INFINITY};
        return ::setrlimit(RLIMIT_AS, &more) == 0;
    }));
}

// The kernel refuses what confines a decoder; a picture of a stranger's is not decoded then.
TEST_F(Confined, AProgramWhoseDecodersCannotBeConfinedSaysSo) {
    ASSERT_TRUE(write_picture(file("in.png"), Picture(4, 4)));
    const auto run = [&](std::vector<std::string> words) {
        words.insert(words.begin(), std::string(binary_folder) + "/bin/darkroom");
        const std::string said = file("said");
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        const pid_t child = ::fork();
        if (child == 0) {
            scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ALLOW);
            seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), SCMP_SYS(seccomp), 0);
            seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), SCMP_SYS(prctl), 1,
                             scmp_arg_cmp{0, SCMP_CMP_EQ, PR_SET_SECCOMP, 0});
            if (seccomp_load(filter) != 0) ::_exit(99);
            ::dup2(::open(said.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), STDERR_FILENO);
            ::execv(arguments.front(), arguments.data());
            ::_exit(98);
        }
        int status = 0;
        EXPECT_EQ(::waitpid(child, &status, 0), child);
        return std::pair(WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(file("said")));
    };
    const std::vector<std::string> develop{"develop", file("in.png"), "--reference", "-q", "-o", file("out.exr")};
    const auto [code, said] = run(develop);
    if (code == 99) GTEST_SKIP() << "this kernel has no seccomp";
    EXPECT_EQ(code, 2) << said;
    EXPECT_NE(said.find("cannot be confined"), std::string::npos) << said;
    EXPECT_EQ(std::ranges::count(said, '\n'), 1) << said;
    EXPECT_FALSE(std::filesystem::exists(file("out.exr")));
    std::vector<std::string> allowed = develop;
    allowed.emplace_back("--allow-unconfined");
    EXPECT_EQ(run(allowed).first, 0) << content(file("said"));
    EXPECT_TRUE(std::filesystem::exists(file("out.exr")));
    // A task of a farm hands it to what it starts.
    std::filesystem::copy(file("in.png"), file("in.0001.png"));
    EXPECT_EQ(run({"farm", "task", file("in.####.png"), "-o", file("out.####.png"), "--frames", "1",
                   "--allow-unconfined", "--", "--reference"})
                  .first,
              0)
        << content(file("said"));
    EXPECT_TRUE(std::filesystem::exists(file("out.0001.png")));
}

TEST(ConfinedProgram, AProcessAtWorkEndsWithIt) {
    int ends[2];
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        ::dup2(ends[1], socket_of_program);
        for (const int end : ends) ::close(end);
        confine({});
        if (!greet()) ::_exit(1);
        for (volatile bool is_at_work = true; is_at_work;) {
        }
    }
    ::close(ends[1]);
    std::uint32_t greeting = 1;
    EXPECT_TRUE(::read(ends[0], &greeting, sizeof greeting) == sizeof greeting && greeting == 0);
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, WNOHANG), 0) << "it works";
    ::close(ends[0]);
    pid_t ended = 0;
    for (int i = 0; i < 10'000 && ended == 0; ++i) {
        ::usleep(1000);
        ended = ::waitpid(child, &status, WNOHANG);
    }
    EXPECT_EQ(ended, child);
    if (ended == 0) {
        ::kill(child, SIGKILL);
        ::waitpid(child, &status, 0);
    }
    EXPECT_TRUE(WIFEXITED(status)) << status;
}

TEST_F(Confined, WritesNothing) {
    put(file("a"), "text");
    for (const int flags : {O_WRONLY, O_RDWR, O_RDONLY | O_TRUNC, O_RDONLY | O_CREAT, O_WRONLY | O_APPEND})
        EXPECT_FALSE(can([&] { return ::open(file("a").c_str(), flags, 0600) >= 0; })) << flags;
    EXPECT_FALSE(can([&] { return ::unlink(file("a").c_str()) == 0; }));
    EXPECT_FALSE(can([&] { return ::rename(file("a").c_str(), file("b").c_str()) == 0; }));
    EXPECT_FALSE(can([&] { return ::mkdir(file("c").c_str(), 0700) == 0; }));
    EXPECT_FALSE(can([&] { return ::symlink("a", file("d").c_str()) == 0; }));
    EXPECT_EQ(content(file("a")), "text");
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(Confined, HasNoNetworkAndNoOtherProcess) {
    for (const int family : {AF_INET, AF_INET6, AF_UNIX, AF_NETLINK})
        EXPECT_FALSE(can([&] { return ::socket(family, SOCK_STREAM, 0) >= 0; })) << family;
    EXPECT_FALSE(can([] {
        const pid_t child = ::fork();
        if (child == 0) ::_exit(0);
        return child > 0;
    }));
    EXPECT_FALSE(can([] {
        ::execl("/bin/true", "true", nullptr);
        return errno != EPERM && errno != EACCES;
    }));
    EXPECT_FALSE(can([] { return ::kill(::getppid(), 0) == 0; }));
    EXPECT_TRUE(can([] {
        int value = 0;
        std::thread([&] { value = 1; }).join();
        return value == 1;
    })) << "threads are no processes";
}

}  // namespace
}  // namespace darkroom::test
