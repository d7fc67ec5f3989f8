// SPDX-License-Identifier: MIT
#pragma once
// What both kinds of chains share: colours through a processor, and one line of what OpenColorIO threw.

#include <OpenColorIO/OpenColorIO.h>

#include <array>
#include <darkroom/result.hpp>
#include <exception>
#include <filesystem>
#include <span>

#include "ocio/reader_words.hpp"

namespace darkroom {

namespace ocio = OCIO_NAMESPACE;

/// What was thrown about this file.
inline Error error_of(const std::exception& exception, const std::filesystem::path& file) {
    return {Fault::User, words_of_reader(exception.what(), file)};
}

inline void run(const ocio::ConstProcessorRcPtr& processor, std::span<std::array<float, 3>> colors) {
    if (colors.empty()) return;
    ocio::PackedImageDesc image(colors.data(), static_cast<long>(colors.size()), 1, 3);
    // As the operations are, so that what is compared is no faster approximation of them.
    processor->getOptimizedCPUProcessor(ocio::OPTIMIZATION_NONE)->apply(image);
}

}  // namespace darkroom
