// SPDX-License-Identifier: MIT
#pragma once
// Whole messages over a socket between a program and a confined process, and the files that go with them.

#include <cstddef>
#include <span>
#include <vector>

#include "confined/descriptor.hpp"

namespace darkroom {

/// Files that go with one message at most.
inline constexpr std::size_t max_descriptors = 2;

/// All of it, and the files with its first byte; false: the other side is gone, or late.
[[nodiscard]] bool send_all(int socket, const void* data, std::size_t size, std::span<const int> descriptors = {});
/// The same; files that come with it are closed unless they are asked for.
[[nodiscard]] bool receive_all(int socket, void* data, std::size_t size,
                               std::vector<Descriptor>* descriptors = nullptr);

}  // namespace darkroom
