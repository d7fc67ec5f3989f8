// SPDX-License-Identifier: MIT
#pragma once
// What every confined process says first, over the socket that is its standard input: that it is confined and ready, or
// why it is not.

#include <cstdint>
#include <string_view>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define DARKROOM_IS_SANITIZED true
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DARKROOM_IS_SANITIZED true
#endif
#ifndef DARKROOM_IS_SANITIZED
#define DARKROOM_IS_SANITIZED false
#endif

namespace darkroom {

inline constexpr bool is_sanitized = DARKROOM_IS_SANITIZED;

/// Longer ones are no error texts.
inline constexpr std::uint32_t max_error_bytes = 65536;

/// The argument that lets a process go on whose calls are not held back (ConfinedProcess::allow_unconfined).
inline constexpr std::string_view allow_unconfined_flag = "--allow-unconfined";

struct ConfinedGreeting {
    std::uint32_t error_size = 0;  ///< bytes of the text behind it; 0: it is ready
};

}  // namespace darkroom
