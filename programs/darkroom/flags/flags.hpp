// SPDX-License-Identifier: MIT
#pragma once
// The door to CLI11, which parses the command line: flags of a command, and what was typed of them. Its headers are all
// templates and take longer to compile than a command does, so only the files here that name them and those of help/
// include them.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/try.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace app {

/// One flag or argument of a command. A handle: the command owns what it stands for.
class Flag {
  public:
    Flag() = default;
    explicit Flag(CLI::Option* option) : option_(option) {}

    Flag& required();
    /// What it takes, as help shows it: "OUT".
    Flag& type_name(const std::string& name);
    /// The same of an argument, or of a flag whose values may be empty.
    Flag& option_text(const std::string& text);
    /// What help says of the default.
    Flag& default_str(const std::string& text);
    /// What it is set to now is the default that help tells of.
    Flag& capture_default();
    /// The title it stands under in help.
    Flag& group(const std::string& title);
    /// May stand several times, with one value each.
    Flag& repeated();
    /// May stand several times; the last one counts.
    Flag& last_counts();
    /// One value each time, although there is room for several.
    Flag& one_value();
    Flag& needs(const Flag& other);
    /// The name of a look that ships stands for its file.
    Flag& names_look();
    [[nodiscard]] std::size_t count() const;

  private:
    friend class CommandFlags;
    CLI::Option* option_ = nullptr;
};

/// The flags of a command. A handle, too. What flags write to stays where it is until the command has run.
class CommandFlags {
  public:
    explicit CommandFlags(CLI::App& app) : app_(&app) {}

    /// A command below this one.
    [[nodiscard]] CommandFlags add_command(const std::string& name, const std::string& doc) const;
    /// `names`: "-o,--output", or "INPUT" of an argument that has a place instead.
    Flag add_option(const std::string& names, std::string& to, const std::string& doc) const;
    Flag add_option(const std::string& names, std::optional<std::string>& to, const std::string& doc) const;
    Flag add_option(const std::string& names, std::vector<std::string>& to, const std::string& doc) const;
    Flag add_flag(const std::string& names, bool& to, const std::string& doc) const;
    /// Its text is "true" or "false", or what was typed behind "=". A name behind "!" says the opposite.
    Flag add_flag(const std::string& names, std::string& to, const std::string& doc) const;
    /// Whole command lines, one a line.
    void examples(const std::string& lines) const;
    /// Help names it and tells no more of it.
    void put_aside() const;
    [[nodiscard]] static bool is_aside(const CLI::App& command);
    /// It only holds others, one of which is asked for.
    void require_command() const;

    [[nodiscard]] bool has(const std::string& name) const;
    [[nodiscard]] std::string name() const;
    /// What was typed for a flag or an argument; nothing where there is none of that name.
    [[nodiscard]] std::vector<std::string> typed(const std::string& name) const;
    /// Larger for what was typed later; 0 for what was not. Of several times the last counts.
    [[nodiscard]] std::size_t place(const Flag& flag) const;
    [[nodiscard]] CLI::App& parser() const { return *app_; }

  private:
    CLI::App* app_;
};

}  // namespace app

// A flag that takes one number of a range. The command line's parser hands over its text, so that a wrong one is
// refused in the words that every other value is: flag, value, what is allowed.

namespace app {

struct NumberRange {
    double least = 0, most = 0;
    bool is_open = false;   ///< (least, most): the ends are not allowed
    bool is_whole = false;  ///< whole numbers only
    std::string_view unit = {};
    bool is_rate = false;  ///< frames a second: 23.98 and its like are television's, 24000/1001
};

/// Stays where it is: the parser keeps a reference to it.
class NumberFlag {
  public:
    NumberFlag(std::string name, NumberRange range) : name_(std::move(name)), range_(range) {}
    NumberFlag(const NumberFlag&) = delete;
    NumberFlag& operator=(const NumberFlag&) = delete;

    /// The help says `doc` and the range.
    Flag add_to(CommandFlags command, const std::string& doc);
    [[nodiscard]] bool is_given() const { return text_.has_value(); }
    /// Nothing where the flag was not given.
    [[nodiscard]] darkroom::Result<std::optional<double>> value() const;
    /// Changes `to` only if the flag was given. What a whole number is written to holds every one of the range.
    template <typename T>
    [[nodiscard]] darkroom::Result<> read_to(T& to) const {
        DARKROOM_TRY_VALUE(const std::optional<double> number, value());
        if (!number) return {};
        if constexpr (std::is_arithmetic_v<T>)
            to = static_cast<T>(*number);
        else
            to = static_cast<typename T::value_type>(*number);
        return {};
    }

  private:
    std::string name_;
    NumberRange range_;
    std::optional<std::string> text_;
};

}  // namespace app
