// SPDX-License-Identifier: MIT
#pragma once
// The version of Darkroom in numbers, and what a change of each promises.
//
// Stability. Before 1.0 a minor version may change the interface and a patch version may not; the shared object's name
// carries both numbers, so a program never loads a library that it was not compiled for. From 1.0 on only a major
// version may. The interface is what the headers of <darkroom/> declare outside the namespaces `detail` and `gpu`. A
// struct of parameters may gain members in a minor version: name the ones you set. Looks say `format = 1`, and a
// released look stays readable. A picture may change in a minor version where that mends an error; the change log says
// where.

#include <cstdint>

namespace darkroom {

inline constexpr std::uint32_t version_major = 0;
inline constexpr std::uint32_t version_minor = 1;
inline constexpr std::uint32_t version_patch = 0;

/// The version that a program was compiled with, as one number that grows.
inline constexpr std::uint32_t version = version_major * 1'000'000 + version_minor * 1'000 + version_patch;
/// The version of the library that was loaded.
[[nodiscard]] std::uint32_t library_version() noexcept;

}  // namespace darkroom
