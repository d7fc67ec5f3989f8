// SPDX-License-Identifier: MIT
#include "child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include "core/files.hpp"
#include "core/system/spawn.hpp"

namespace darkroom::bench {

namespace {

double milliseconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_usec) * 1e-3;
}

std::string last_line(const std::filesystem::path& path) {
    const auto bytes = read_file(path);
    if (!bytes) return {};
    const void* const data = bytes->data();
    std::string_view text(static_cast<const char*>(data), bytes->size());
    while (text.ends_with('\n')) text.remove_suffix(1);
    return std::string(text.substr(text.rfind('\n') + 1));
}

}  // namespace

Result<std::optional<Sample>> run_program(std::vector<std::string> arguments, const std::filesystem::path& log) {
    const Stopwatch watch;
    pid_t child = 0;
    const int error = Spawn()
                          .open(STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600)
                          .give(STDOUT_FILENO, STDERR_FILENO)
                          .start(child, arguments[0], arguments);
    if (error == ENOENT) return std::optional<Sample>();
    if (error != 0) return machine_error(fmt::format("{}: starting it failed: {}", arguments[0], std::strerror(error)));
    int status = 0;
    rusage usage{};
    while (wait4(child, &status, 0, &usage) < 0)
        if (errno != EINTR)
            return machine_error(fmt::format("{}: waiting failed: {}", arguments[0], std::strerror(errno)));
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return machine_error(fmt::format("{} failed: {}", arguments[0], last_line(log)));
    return Sample{.cpu_ms = milliseconds(usage.ru_utime) + milliseconds(usage.ru_stime),
                  .wall_ms = watch.elapsed().wall_ms};
}

}  // namespace darkroom::bench
