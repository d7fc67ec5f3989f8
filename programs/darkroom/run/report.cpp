// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <mutex>

#include "core/text/param_text.hpp"
#include "json.hpp"

namespace app {

namespace {

Voice voice = Voice::Usual;
std::FILE* told_to = stdout;
bool is_bar_shown = false;
bool is_json = false;
int output_error = 0;  ///< the first of standard output, as errno has it
std::mutex terminal;   // whose lines come from several threads

/// A line of standard error, in place of a bar. Nobody reads it, or the disk is full: the work goes on.
void print_line(std::string_view line) {
    const std::lock_guard lock(terminal);
    if (is_bar_shown) std::fputs("\r\x1b[K", stderr);
    is_bar_shown = false;
    std::fwrite(line.data(), 1, line.size(), stderr);
    std::fputc('\n', stderr);
    std::fflush(stderr);
}

void print_event(const Json& event) { print_line(event.dump()); }

void say(const char* event, std::string_view prefix, std::string_view text) {
    if (is_json) return print_event({{"event", event}, {"text", text}});
    std::string line(text);
    for (char& c : line)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    print_line(fmt::format("darkroom: {}{}", prefix, line));
}

}  // namespace

void set_voice(Voice to) { voice = to; }
Voice current_voice() { return voice; }
void report_as_json() { is_json = true; }
void leave_standard_output() { told_to = stderr; }

void answer(std::string_view line) {
    std::fwrite(line.data(), 1, line.size(), told_to);
    std::fputc('\n', told_to);
    if (std::fflush(told_to) != 0 && output_error == 0) output_error = errno;
}

void answer_unless_quiet(std::string_view line) {
    if (voice != Voice::Quiet) answer(line);
}

void tell(std::string_view line) {
    if (is_json) return print_event({{"event", "note"}, {"text", line}});
    if (voice != Voice::Quiet) print_line(line);
}

void survive_closed_pipes() { std::signal(SIGPIPE, SIG_IGN); }

void survive_size_limits() { std::signal(SIGXFSZ, SIG_IGN); }

void hold_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) == -1 && errno == EBADF)
            static_cast<void>(::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY));
}

int end_output(int code) {
    errno = 0;
    if (std::fflush(stdout) != 0 && output_error == 0) output_error = errno;
    if (std::ferror(stdout) == 0 && output_error == 0) return code;
    complain(fmt::format("standard output: cannot write: {}",
                         output_error == 0 ? "an error before" : std::strerror(output_error)));
    return code == exit_ok ? exit_machine : code;
}

void remark(std::string_view text) {
    if (voice == Voice::Verbose) say("note", "", text);
}
void complain(std::string_view text) { say("error", "", text); }
void warn(std::string_view text) { say("warning", "warning: ", text); }

int fail(const darkroom::Error& error) {
    complain(error.text);
    return error.fault == darkroom::Fault::User ? exit_user : exit_machine;
}

int fail_user(std::string_view text) {
    complain(text);
    return exit_user;
}

darkroom::LogSink log_sink() {
    return [](darkroom::Severity severity, std::string_view text) {
        if (severity == darkroom::Severity::Info) remark(text);
        if (severity == darkroom::Severity::Warning) warn(text);
        if (severity == darkroom::Severity::Error) complain(text);
    };
}

Progress::Progress(std::size_t total) : total_(total), is_terminal_(isatty(STDERR_FILENO) != 0) {
    if (is_json) print_event({{"event", "start"}, {"total", total_}});
}

Progress::~Progress() {
    if (is_json)
        print_event(
            {{"event", "end"}, {"total", total_}, {"done", done_}, {"failed", failed_}, {"seconds", seconds()}});
    if (is_bar_shown) std::fputc('\n', stderr);
    is_bar_shown = false;
}

double Progress::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Progress::fail(const darkroom::Error& error) {
    ++failed_;
    if (is_json) print_event({{"event", "failed"}, {"text", error.text}});
}

void Progress::step(const Made& made) {
    ++done_;
    if (is_json)
        return print_event({{"event", "picture"},
                            {"done", done_},
                            {"total", total_},
                            {"input", made.from},
                            {"output", made.to},
                            {"width", made.width},
                            {"height", made.height},
                            {"seconds", seconds()}});
    const std::string line = fmt::format("{} -> {} ({}x{})", darkroom::printable(made.from),
                                         darkroom::printable(made.to), made.width, made.height);
    if (total_ < 2) return tell(line);
    if (!is_terminal_ || voice == Voice::Quiet) return tell(fmt::format("{}/{} {}", done_, total_, line));
    const std::lock_guard lock(terminal);
    constexpr std::size_t width = 30;
    const std::size_t filled = width * done_ / total_;
    const double rate = static_cast<double>(done_) / std::max(seconds(), 1e-6);
    const auto left = static_cast<long long>(static_cast<double>(total_ - done_) / rate + 0.5);
    fmt::print(stderr, "\r\x1b[K[{:=<{}}{: <{}}] {}/{} {:.1f} fps, {}:{:02} left  {}", "", filled, "", width - filled,
               done_, total_, rate, left / 60, left % 60, line);
    std::fflush(stderr);
    is_bar_shown = true;
}

}  // namespace app
