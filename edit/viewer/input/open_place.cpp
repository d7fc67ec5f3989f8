// SPDX-License-Identifier: MIT
#include "open_place.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace app {

namespace {

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr ? value : "";
}

std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

}  // namespace

std::string editor_command(const std::string& editor, const darkroom::panels::TextPlace& place) {
    const std::string own = variable("EDITOR").empty() ? "vi" : variable("EDITOR");
    return fmt::format("{} +{} {}", editor.empty() ? own : editor, place.line, quoted(place.file.string()));
}

// Twice forked, so that nobody has to wait for it; its name goes to the shell as words, its file as one argument.
darkroom::Result<bool> open_in_editor(const darkroom::panels::TextPlace& place) {
    if (variable("VISUAL").empty()) return false;
    const std::string line = fmt::format("+{}", place.line), file = place.file.string();
    const pid_t first = fork();
    if (first < 0) return darkroom::machine_error(fmt::format("the editor: {}", std::strerror(errno)));
    if (first == 0) {
        setsid();
        if (fork() != 0) _exit(0);
        close_range(STDERR_FILENO + 1, ~0U, 0);
        const int nothing = open("/dev/null", O_RDWR);
        for (const int own : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, own);
        execl("/bin/sh", "sh", "-c", "exec $VISUAL \"$@\"", "sh", line.c_str(), file.c_str(), nullptr);
        _exit(127);
    }
    int status = 0;
    while (waitpid(first, &status, 0) < 0 && errno == EINTR) {
    }
    return true;
}

}  // namespace app
