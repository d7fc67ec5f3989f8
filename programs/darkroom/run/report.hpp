// SPDX-License-Identifier: MIT
#pragma once
// What the program says. What was asked for goes to standard output. How far the work has come, and one line an error
// or warning, go to standard error: as text, or each as an object of JSON for another program to read.

#include <chrono>
#include <darkroom/log.hpp>
#include <darkroom/result.hpp>
#include <string>
#include <string_view>

namespace app {

inline constexpr int exit_ok = 0, exit_user = 1, exit_machine = 2;

/// How much is said. Quiet: warnings, errors, and what was asked for. Verbose: remarks, too.
enum class Voice { Quiet, Usual, Verbose };
void set_voice(Voice voice);
[[nodiscard]] Voice current_voice();
/// From now on each line of standard error is {"event": "start" | "picture" | "failed" | "end" | "note" | "warning" |
/// "error", ...}: see docs/command_line.md.
void report_as_json();
/// Standard output belongs to a stream of pictures: all that is said goes to standard error.
void leave_standard_output();

/// What was asked for, a line.
void answer(std::string_view line);
/// The same, of what was done more than asked for: not where it is to be quiet.
void answer_unless_quiet(std::string_view line);
/// What was done, a line of standard error; not where it is to be quiet.
void tell(std::string_view line);
/// For work whose lines are told by the way: that nobody reads them does not end it.
void survive_closed_pipes();
/// A file beyond the limit of the shell or of a batch system (`ulimit -f`) is an error of writing it, not the end.
void survive_size_limits();
/// A standard stream that came closed is one that cannot be read or written: the first file that is opened would take
/// its place, and have our lines.
void hold_standard_streams();
/// The exit code `code`; where standard output could not be written (a full disk), a line says so and it is another.
[[nodiscard]] int end_output(int code);
/// "darkroom: <text>" on one line of standard error, where that was asked for.
void remark(std::string_view text);
/// "darkroom: <text>" on one line of standard error.
void complain(std::string_view text);
/// "darkroom: warning: <text>".
void warn(std::string_view text);
/// Complains, and returns the exit code for it.
[[nodiscard]] int fail(const darkroom::Error& error);
[[nodiscard]] int fail_user(std::string_view text);

/// Prints the library's warnings and errors, and where it is to be verbose its remarks.
[[nodiscard]] darkroom::LogSink log_sink();

/// A picture that was made.
struct Made {
    std::string from, to;  ///< files
    std::uint32_t width = 0, height = 0;
};

/// How far a list of pictures has come: on a terminal a bar with frames a second and the time that is left, else a line
/// for each picture, "a.exr -> b.png (640x360)". Of a single one its line alone. May be told by several threads, one at
/// a time.
class Progress {
  public:
    explicit Progress(std::size_t total);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress();
    void step(const Made& made);
    /// For who reads JSON; as text, errors are told at the end.
    void fail(const darkroom::Error& error);

  private:
    std::size_t total_ = 0;
    std::size_t done_ = 0, failed_ = 0;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    [[nodiscard]] double seconds() const;

    bool is_terminal_ = false;
};

}  // namespace app
