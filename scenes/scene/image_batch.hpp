// SPDX-License-Identifier: MIT
#pragma once
// Many images decoded at once, as fine as their files, on all processors. The results do not depend on how many there
// are or on who is first. It caches nothing.

#include <cstddef>
#include <darkroom/result.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/model.hpp"

namespace darkroom::scene {

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
