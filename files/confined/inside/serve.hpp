// SPDX-License-Identifier: MIT
#pragma once
// What a confined process says to the program that started it (confined/process.hpp).

#include <string_view>

namespace darkroom {

/// Its socket, which is its standard input.
inline constexpr int socket_of_program = 0;

/// The first thing that is said. Empty: it is confined and ready; else why it is not. False: nobody listens. From then
/// on the process ends when the program does.
[[nodiscard]] bool greet(std::string_view error = {});

}  // namespace darkroom
