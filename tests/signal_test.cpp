// SPDX-License-Identifier: MIT
// Ctrl-C: what files do then is told beside AtomicPath; here, that the program asks for it and ends by the signal.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "image/frame/frame_file.hpp"
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
    // More than a pipe holds, and nobody takes it: the program waits.
    FrameFile frame;
    frame.color = Picture(512, 512);
    const std::string in = path("in.exr");
    ASSERT_TRUE(write_frame(in, frame));
    int ends[2];
    ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    for (const int signal : {SIGINT, SIGTERM}) {
        const pid_t child = ::fork();
        if (child == 0) {
            ::dup2(ends[1], STDOUT_FILENO);
            std::signal(signal, SIG_DFL);  // a shell ignores SIGINT in what it starts in the background
            ::execl(program.c_str(), program.c_str(), "develop", in.c_str(), "-o", "-", "--format", "rgb24", nullptr);
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
    for (const int end : ends) ::close(end);
}

// A batch system's limit: the signal would end the program, and leave what it had begun.
// By a command that needs no device: to a software driver's memory, which may be a file without a name, the limit
// applies, too.
TEST_F(CliSignal, AFileThatIsTooLargeIsAnErrorAndLeavesNothing) {
    std::string table = "LUT_3D_SIZE 17\n";
    for (int i = 0; i < 17 * 17 * 17; ++i) table += "0.1 0.2 0.3\n";
    write("in.cube", table);
    const Outcome outcome = run_lines("ulimit -f 16\ndarkroom lut convert in.cube -o out.cube");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err, "darkroom: out.cube: cannot write: File too large\n");
    EXPECT_EQ(files(), std::vector<std::string>{"in.cube"});
}

}  // namespace
}  // namespace darkroom::test
