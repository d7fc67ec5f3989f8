// SPDX-License-Identifier: MIT
#include "core/system/spawn.hpp"

#include <unistd.h>

#include <cerrno>
#include <vector>

namespace darkroom {

Spawn::Spawn() { posix_spawn_file_actions_init(&actions_); }

Spawn::~Spawn() { posix_spawn_file_actions_destroy(&actions_); }

Spawn& Spawn::open(int to, const char* path, int flags, mode_t mode) {
    posix_spawn_file_actions_addopen(&actions_, to, path, flags, mode);
    return *this;
}

Spawn& Spawn::give(int from, int to) {
    posix_spawn_file_actions_adddup2(&actions_, from, to);
    return *this;
}

Spawn& Spawn::close_from(int first) {
    posix_spawn_file_actions_addclosefrom_np(&actions_, first);
    return *this;
}

int Spawn::start(pid_t& process, const std::string& program, std::span<const std::string> arguments) const {
    std::vector<char*> pointers;
    // The program gets copies; the signature is older than const.
    for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
    pointers.push_back(nullptr);
    return posix_spawnp(&process, program.c_str(), &actions_, nullptr, pointers.data(), environ);
}

int become(const std::string& program, std::span<char* const> arguments) {
    std::vector<char*> pointers(arguments.begin(), arguments.end());
    pointers.push_back(nullptr);
    ::execv(program.c_str(), pointers.data());
    return errno;
}

}  // namespace darkroom
