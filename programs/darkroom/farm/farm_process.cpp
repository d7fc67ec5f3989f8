// SPDX-License-Identifier: MIT
#include "farm_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "core/system/spawn.hpp"
#include "core/text/param_text.hpp"

extern char** environ;

namespace app {

using darkroom::Result;

namespace {

constexpr std::size_t max_output = 1 << 16;
constexpr std::size_t max_errors = 8;

/// A pipe that the program started does not inherit but where it is told to.
class Pipe {
  public:
    Pipe() {
        if (pipe2(ends_.data(), O_CLOEXEC) != 0) ends_ = {-1, -1};
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe() {
        close_end(0);
        close_end(1);
    }
    [[nodiscard]] int read_end() const { return ends_[0]; }
    [[nodiscard]] int write_end() const { return ends_[1]; }
    void close_end(std::size_t end) {
        if (ends_[end] >= 0) ::close(ends_[end]);
        ends_[end] = -1;
    }
    /// Appends what is there. False: no more will come.
    bool read_to(std::string& text) const {
        std::array<char, 4096> bytes{};
        const ssize_t count = ::read(ends_[0], bytes.data(), bytes.size());
        if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
        return count > 0 || (count < 0 && errno == EINTR);
    }

  private:
    std::array<int, 2> ends_{-1, -1};
};

struct Words {
    std::vector<std::string> errors, last;
};

void keep(std::vector<std::string>& lines, const std::string& line) {
    lines.push_back(darkroom::printable(line));
    if (lines.size() > max_errors) lines.erase(lines.begin());
}

/// Takes whole lines out of `text`, and one that never ends in pieces.
void take_lines(std::string& text, bool is_end, Words& words) {
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        if (end == std::string::npos && !is_end && text.size() < max_output) return;
        const std::string line = text.substr(0, end);
        text.erase(0, end == std::string::npos ? text.size() : end + 1);
        if (line.empty() || line.find("warning:") != std::string::npos) continue;
        keep(line.starts_with("darkroom: ") ? words.errors : words.last, line);
    }
}

void read_all(Pipe& out, Pipe& errors, ProcessOutput output, ProcessOutcome& outcome, Words& words) {
    std::string text;
    while (out.read_end() >= 0 || errors.read_end() >= 0) {
        std::array<pollfd, 2> waits{pollfd{out.read_end(), POLLIN, 0}, pollfd{errors.read_end(), POLLIN, 0}};
        if (::poll(waits.data(), waits.size(), -1) < 0 && errno != EINTR) break;
        if (waits[0].revents != 0) {
            if (!out.read_to(outcome.out)) out.close_end(0);
            outcome.out.resize(std::min(outcome.out.size(), max_output));
        }
        if (waits[1].revents != 0) {
            const std::size_t known = text.size();
            const bool goes_on = errors.read_to(text);
            if (output == ProcessOutput::Told) std::fwrite(text.data() + known, 1, text.size() - known, stderr);
            take_lines(text, !goes_on, words);
            if (!goes_on) errors.close_end(0);
        }
    }
}

}  // namespace

Result<ProcessOutcome> run_process(const std::vector<std::string>& arguments, ProcessOutput output) {
    Pipe out, errors;
    const auto cannot_be_run = [&](int reason) {
        return darkroom::machine_error(fmt::format("{}: cannot be run: {}", darkroom::printable(arguments[0]),
                                                   std::generic_category().message(reason)));
    };
    if (out.read_end() < 0 || errors.read_end() < 0) return cannot_be_run(errno);
    darkroom::Spawn spawn;
    spawn.open(STDIN_FILENO, "/dev/null", O_RDONLY);
    if (output == ProcessOutput::Kept) spawn.give(out.write_end(), STDOUT_FILENO);
    spawn.give(errors.write_end(), STDERR_FILENO);
    pid_t process = -1;
    const int reason = spawn.start(process, arguments[0], arguments);
    if (reason != 0) return cannot_be_run(reason);
    darkroom::process_that_ends_with_us = process;
    out.close_end(1);
    errors.close_end(1);
    ProcessOutcome outcome;
    Words words;
    read_all(out, errors, output, outcome, words);
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    darkroom::process_that_ends_with_us = 0;
    outcome.code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    if (outcome.code != 0) outcome.errors = words.errors.empty() ? std::move(words.last) : std::move(words.errors);
    return outcome;
}

}  // namespace app
