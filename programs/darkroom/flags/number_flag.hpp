// SPDX-License-Identifier: MIT
#pragma once
// A flag that takes one number of a range. The command line's parser hands over its text, so that a wrong one is
// refused in the words that every other value is: flag, value, what is allowed.

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/try.hpp"
#include "flags.hpp"

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
