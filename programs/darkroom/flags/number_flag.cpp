// SPDX-License-Identifier: MIT
#include "number_flag.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/text/param_text.hpp"
#include "core/text/quantity.hpp"
#include "image/picture/video_frame.hpp"

namespace app {

using darkroom::Result;
using darkroom::user_error;

namespace {

std::string interval(const NumberRange& range) {
    const std::string_view before = range.unit.empty() ? "" : " ";
    return fmt::format("{}{}, {}{}{}{}", range.is_open ? '(' : '[', range.least, range.most, range.is_open ? ')' : ']',
                       before, range.unit);
}

}  // namespace

Flag NumberFlag::add_to(CommandFlags command, const std::string& doc) {
    return command.add_option(name_, text_, fmt::format("{}, {}", doc, interval(range_)));
}

Result<std::optional<double>> NumberFlag::value() const {
    if (!text_) return std::optional<double>();
    std::optional<double> number = darkroom::parse_quantity(*text_, range_.unit);
    if (!number || (range_.is_whole && *number != std::floor(*number)))
        return user_error(fmt::format("{}: '{}' is not a {}, allowed is {}", name_, darkroom::printable(*text_),
                                      range_.is_whole ? "whole number" : "number", interval(range_)));
    const bool is_inside = range_.is_open ? *number > range_.least && *number < range_.most
                                          : *number >= range_.least && *number <= range_.most;
    if (!is_inside)
        return user_error(fmt::format("{} = {}: allowed is {}", name_, darkroom::printable(*text_), interval(range_)));
    if (const darkroom::FrameRate rate = darkroom::frame_rate(range_.is_rate ? *number : 1); rate.denominator == 1001)
        number = rate.numerator / 1001.0;
    return number;
}

}  // namespace app
