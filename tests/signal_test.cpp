// SPDX-License-Identifier: MIT
// Ctrl-C: what files do then is told beside AtomicPath; here, that the program asks for it and ends by the signal.
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "tests/cli/cli_support.hpp"

namespace darkroom::test {
namespace {

class CliSignal : public CliFixture {};

std::uint64_t caught_signals(pid_t process) {
    const std::string status = content("/proc/" + std::to_string(process) + "/status");
    const std::size_t at = status.find("SigCgt:");
    return at == std::string::npos ? 0 : std::stoull(status.substr(at + 7), nullptr, 16);
}

TEST_F(CliSignal, TheProgramEndsByItAndLeavesNothing) {
    // Opened by nobody else: the program waits for it.
    const std::string pipe = path("in.exr"), out = path("out.png");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    for (const int signal : {SIGINT, SIGTERM}) {
        const pid_t child = ::fork();
        if (child == 0) {
            ::execl(program.c_str(), program.c_str(), "develop", pipe.c_str(), "-o", out.c_str(), nullptr);
            ::_exit(127);
        }
        const std::uint64_t wanted = std::uint64_t{1} << (signal - 1);
        for (int i = 0; i < 10'000 && (caught_signals(child) & wanted) == 0; ++i) ::usleep(1000);
        EXPECT_NE(caught_signals(child) & wanted, 0U);
        ::kill(child, signal);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
        EXPECT_EQ(files(), std::vector<std::string>{"in.exr"});
    }
}

}  // namespace
}  // namespace darkroom::test
