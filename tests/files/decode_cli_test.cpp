// SPDX-License-Identifier: MIT
// The processes that decode pictures are gone with the program, whatever ends it.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "image/picture/write.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom::test {
namespace {

class CliDecode : public CliFixture {
  protected:
    void make_files() override {
        ASSERT_TRUE(write_picture(path("in.png"), Picture(512, 512)));
        ASSERT_EQ(::pipe2(ends_, O_CLOEXEC), 0);
    }
    void TearDown() override {
        for (const int end : ends_) ::close(end);
        CliFixture::TearDown();
    }
    /// The program in a group of its own, in which what it starts is, too. What it writes is more than a pipe holds.
    [[nodiscard]] pid_t start(const std::string& output) const {
        std::vector<std::string> words{program, "develop", path("in.png"), "-q", "-o", output};
        if (output == "-") words.insert(words.end(), {"--format", "rgb24"});
        std::vector<char*> pointers;
        for (std::string& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        const pid_t child = ::fork();
        if (child == 0) {
            ::setpgid(0, 0);
            ::dup2(ends_[1], STDOUT_FILENO);
            ::execv(pointers[0], pointers.data());
            ::_exit(127);
        }
        return child;
    }
    /// Processes of the group that decode, or are no longer, but have not been waited for.
    struct Found {
        std::size_t alive = 0, ended = 0;
    };
    [[nodiscard]] static Found decoders(pid_t group) {
        Found out;
        for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
            const std::string stat = content(entry.path() / "stat");
            const std::size_t name = stat.find("(darkroom_decode) ");
            if (name == std::string::npos) continue;
            char state = 0;
            pid_t parent = 0, its_group = 0;
            std::istringstream(stat.substr(name + 18)) >> state >> parent >> its_group;
            if (its_group == group) ++(state == 'Z' ? out.ended : out.alive);
        }
        return out;
    }
    [[nodiscard]] static bool becomes(const std::function<bool()>& is_so) {
        for (int i = 0; i < 20'000 && !is_so(); ++i) ::usleep(1000);
        return is_so();
    }

    int ends_[2] = {-1, -1};
};

TEST_F(CliDecode, AProgramThatComesToItsEndLeavesNoProcess) {
    const pid_t child = start(path("out.png"));
    int status = 0;
    siginfo_t ended{};
    // Not yet waited for, so its number is still its own.
    ASSERT_EQ(::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT), 0);
    const Found left = decoders(child);
    EXPECT_EQ(left.alive, 0U);
    EXPECT_EQ(left.ended, 0U);
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
}

TEST_F(CliDecode, AProgramThatIsEndedLeavesNoProcess) {
    // SIGABRT for a crash: sanitizers take SIGSEGV for themselves.
    for (const int signal : {SIGTERM, SIGINT, SIGKILL, SIGABRT}) {
        const pid_t child = start("-");
        EXPECT_TRUE(becomes([&] { return decoders(child).alive == 1; })) << signal;
        ::kill(child, signal);
        siginfo_t ended{};
        ASSERT_EQ(::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT), 0);
        EXPECT_EQ(ended.si_status, signal);
        EXPECT_TRUE(becomes([&] { return decoders(child).alive == 0; })) << signal;
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
    }
}

}  // namespace
}  // namespace darkroom::test
