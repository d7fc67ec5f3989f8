// SPDX-License-Identifier: MIT
#pragma once
// Many images decoded at once, to four bytes a pixel, on all processors. The results do not depend on how many there
// are or on who is first. It caches nothing.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <darkroom/result.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "scene/model.hpp"

namespace darkroom::scene {

/// Calls `work(i)` for every i below `count`, on several threads, and waits. `work` must not throw.
template <class Work>
void parallel_for(std::size_t count, const Work& work) {
    std::atomic<std::size_t> next = 0;
    const auto run = [&] {
        for (std::size_t i = next++; i < count; i = next++) work(i);
    };
    const std::size_t wanted = std::min<std::size_t>(std::max(1U, std::thread::hardware_concurrency()), count);
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < wanted; ++i) threads.emplace_back(run);
    run();
}

/// An image file, or the bytes of one.
struct EncodedImage {
    std::string name;  ///< of the Image
    std::span<const std::byte> bytes;
    std::filesystem::path file;  ///< read if there are no bytes
};

/// One result for each, in order. Errors are without name and path. A batch that is out of proportion to its bytes is
/// decoded as far as it is not.
[[nodiscard]] std::vector<Result<Image>> decode_images(std::span<const EncodedImage> sources);

}  // namespace darkroom::scene
