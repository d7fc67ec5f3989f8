// SPDX-License-Identifier: MIT
#include "script/command_reader.hpp"

#include <algorithm>
#include <utility>

namespace darkroom::script {

namespace {

bool is_blank(char letter) { return static_cast<unsigned char>(letter) <= ' ' || letter == '\x7f'; }

}  // namespace

std::optional<std::string_view> CommandReader::word() {
    while (!rest_.empty() && rest_[0] != '\n' && is_blank(rest_[0])) rest_.remove_prefix(1);
    if (rest_.starts_with("//")) rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
    if (rest_.empty()) return std::nullopt;
    if (rest_[0] == '\n' || rest_[0] == ';') {
        if (rest_[0] == '\n') ++line_;
        rest_.remove_prefix(1);
        return std::nullopt;
    }
    const bool is_quoted = rest_[0] == '"';
    if (is_quoted) rest_.remove_prefix(1);
    const auto is_end = [&](char letter) {
        return letter == '\n' || (is_quoted ? letter == '"' : letter == ';' || is_blank(letter));
    };
    const auto length = static_cast<std::size_t>(std::ranges::find_if(rest_, is_end) - rest_.begin());
    const std::string_view found = rest_.substr(0, length);
    rest_.remove_prefix(length);
    if (is_quoted && rest_.starts_with('"')) rest_.remove_prefix(1);
    return found;
}

std::optional<Command> CommandReader::next() {
    while (!rest_.empty()) {
        Command command{.line = line_};
        while (const auto found = word()) command.words.push_back(*found);
        if (!command.words.empty()) return command;
    }
    return std::nullopt;
}

}  // namespace darkroom::script
