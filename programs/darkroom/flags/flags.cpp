// SPDX-License-Identifier: MIT
#include "flags.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "core/text/param_text.hpp"
#include "core/text/quantity.hpp"
#include "image/picture/video_frame.hpp"
#include "programs/darkroom/run/shipped.hpp"

namespace app {

Flag& Flag::required() {
    option_->required();
    return *this;
}

Flag& Flag::type_name(const std::string& name) {
    option_->type_name(name);
    return *this;
}

Flag& Flag::option_text(const std::string& text) {
    option_->option_text(text);
    return *this;
}

Flag& Flag::default_str(const std::string& text) {
    option_->default_str(text);
    return *this;
}

Flag& Flag::capture_default() {
    option_->capture_default_str();
    return *this;
}

Flag& Flag::group(const std::string& title) {
    option_->group(title);
    return *this;
}

Flag& Flag::repeated() {
    option_->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return *this;
}

Flag& Flag::last_counts() {
    option_->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    return *this;
}

Flag& Flag::one_value() {
    option_->allow_extra_args(false);
    return *this;
}

Flag& Flag::needs(const Flag& other) {
    option_->needs(other.option_);
    return *this;
}

Flag& Flag::names_look() {
    // A name that is the command's own argument may be what follows an unknown flag, of which is told first.
    option_->transform(CLI::Validator(
        [is_own = option_->get_positional()](std::string& name) {
            std::string error = find_shipped_look(name);
            return is_own ? std::string() : error;
        },
        ""));
    return *this;
}

std::size_t Flag::count() const { return option_->count(); }

CommandFlags CommandFlags::add_command(const std::string& name, const std::string& doc) const {
    return CommandFlags(*app_->add_subcommand(name, doc));
}

void CommandFlags::put_aside() const { app_->group("aside"); }
bool CommandFlags::is_aside(const CLI::App& command) { return command.get_group() == "aside"; }

Flag CommandFlags::add_option(const std::string& names, std::string& to, const std::string& doc) const {
    return Flag(app_->add_option(names, to, doc));
}

Flag CommandFlags::add_option(const std::string& names, std::optional<std::string>& to, const std::string& doc) const {
    return Flag(app_->add_option(names, to, doc));
}

Flag CommandFlags::add_option(const std::string& names, std::vector<std::string>& to, const std::string& doc) const {
    return Flag(app_->add_option(names, to, doc));
}

Flag CommandFlags::add_flag(const std::string& names, bool& to, const std::string& doc) const {
    return Flag(app_->add_flag(names, to, doc));
}

Flag CommandFlags::add_flag(const std::string& names, std::string& to, const std::string& doc) const {
    return Flag(app_->add_flag(names, to, doc));
}

void CommandFlags::examples(const std::string& lines) const { app_->footer(lines); }

void CommandFlags::require_command() const { app_->require_subcommand(1); }

bool CommandFlags::has(const std::string& name) const { return app_->get_option_no_throw(name) != nullptr; }

std::string CommandFlags::name() const { return app_->get_name(); }

std::vector<std::string> CommandFlags::typed(const std::string& name) const {
    const CLI::Option* const option = app_->get_option_no_throw(name);
    return option == nullptr ? std::vector<std::string>() : option->results();
}

std::size_t CommandFlags::place(const Flag& flag) const {
    const std::vector<CLI::Option*>& order = app_->parse_order();
    const auto last = std::ranges::find(order.rbegin(), order.rend(), flag.option_).base();
    return static_cast<std::size_t>(last - order.begin());
}

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
