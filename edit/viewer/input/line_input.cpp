// SPDX-License-Identifier: MIT
#include "line_input.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace app {

darkroom::Result<std::vector<std::string>> LineInput::take() {
    std::vector<std::string> lines;
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (!is_open_ || poll(&input, 1, 0) <= 0) return lines;
    std::array<char, 4096> some{};
    const ssize_t count = read(STDIN_FILENO, some.data(), some.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return lines;
    is_open_ = count > 0;
    begun_.append(some.data(), is_open_ ? static_cast<std::size_t>(count) : 0);
    if (!is_open_) begun_ += '\n';
    std::size_t begin = 0, longest = 0;
    for (std::size_t end = 0; (end = begun_.find('\n', begin)) != std::string::npos; begin = end + 1) {
        if (end > begin) lines.push_back(begun_.substr(begin, end - begin));
        longest = std::max(longest, end - begin);
    }
    begun_.erase(0, begin);
    if (std::max(longest, begun_.size()) <= longest_line) return lines;
    is_open_ = false;
    return darkroom::user_error(
        fmt::format("standard input: a line is longer than {} characters, no more are read", longest_line));
}

}  // namespace app
