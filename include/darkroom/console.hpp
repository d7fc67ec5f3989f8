// SPDX-License-Identifier: MIT
#pragma once
// A console for a Composer: every parameter of its stack is a variable, `<entry>.<member>`, some under another name as
// well. Variables are views: what is set is the parameter's base value, and there is no second store. It has no window
// and no keys; a host hands it lines and shows what it prints.
//
//     darkroom::Console console(composer, {.print = print, .folder = "config"});
//     console.read_config("config/user.cfg");
//     console.execute("vignette.intensity 0.5; cvarlist r_ui");
//
// Part of the optional target Darkroom::script. docs/console.md has the commands.

#include <cstdint>
#include <darkroom/composer.hpp>
#include <darkroom/log.hpp>
#include <darkroom/result.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom {

struct ConsoleDesc {
    LogSink print{};                 ///< a line at a time: answers are Info, what was clamped Warning, refusals Error
    std::filesystem::path folder{};  ///< that `exec` reads from, and its folders; empty: it reads nothing
};

/// Where commands come from.
struct ExecuteOptions {
    bool allows_files = true;  ///< `exec` is not refused
    bool suggests = true;      ///< unknown names are answered with the nearest, which takes longer than all else
    LogSink print{};           ///< instead of the console's
    /// Of the commands that are run, files included; what comes behind is left out, and printed to be.
    std::uint32_t max_commands = 10000;
};

class Console {
  public:
    /// The Composer must outlive it. Its values are taken as defaults.
    explicit Console(Composer& composer, ConsoleDesc desc = {});
    Console(Console&&) noexcept;
    Console& operator=(Console&&) noexcept;
    ~Console();

    /// Runs commands. Returns how many were refused; each refusal is printed, the first 64 in full.
    std::uint32_t execute(std::string_view commands, const ExecuteOptions& options = {});

    [[nodiscard]] bool has(std::string_view name) const;
    /// The base value as text; nothing: there is no such variable.
    [[nodiscard]] std::optional<std::string> get(std::string_view name) const;
    /// The same as a number, 0 where it is none.
    [[nodiscard]] std::optional<double> number(std::string_view name) const;
    /// Sets the base value. A number out of range becomes the bound; the text says so, and is empty otherwise. Errors:
    /// no such variable, not a value of its kind, a read-only variable.
    Result<std::string> set(std::string_view name, std::string_view value);
    /// The same for this frame's value: Composer::set_override.
    Result<std::string> set_override(std::string_view name, std::string_view owner, std::string_view value);
    /// All names that begin with `prefix`, in alphabetical order.
    [[nodiscard]] std::vector<std::string> names(std::string_view prefix = {}) const;
    /// The same with the commands among them: what a host completes words with.
    [[nodiscard]] std::vector<std::string> words(std::string_view prefix = {}) const;

    /// Makes the present base values those that `reset` goes back to: after a look was applied. Entries that came later
    /// go back to their effect's defaults.
    void take_defaults();
    /// A locked variable is read-only for commands, set() and set_override(). False: there is no such variable.
    bool lock(std::string_view name, bool is_locked = true);

    /// Runs a file that write_config() wrote. A file that is not there is no error. What it says of variables that the
    /// stack does not have is kept for the next write_config().
    Result<> read_config(const std::filesystem::path& path);
    /// Writes the archived variables that commands, set() or read_config() have set and `reset` has not taken back, whole
    /// or not at all. Archived are those whose row says so, and those that `seta` named.
    [[nodiscard]] Result<> write_config(const std::filesystem::path& path) const;

    [[nodiscard]] Composer& composer() const;

    struct State;

  private:
    std::unique_ptr<State> state_;
};

}  // namespace darkroom
