// SPDX-License-Identifier: MIT
#pragma once
// What both kinds of chains share: colours through a processor, and one line of what OpenColorIO threw.

#include <OpenColorIO/OpenColorIO.h>

#include <array>
#include <darkroom/result.hpp>
#include <exception>
#include <span>

#include "core/text/param_text.hpp"

namespace darkroom {

namespace ocio = OCIO_NAMESPACE;

/// Of the message the reason that the file's own format gave; the path, and what other formats said, are left out.
inline Error error_of(const std::exception& exception) {
    std::string_view text = exception.what();
    constexpr std::string_view mark = " failed with: ", next = "    '";
    if (const std::size_t at = text.find(mark); at != std::string_view::npos) text.remove_prefix(at + mark.size());
    return {Fault::User, printable(text.substr(0, text.find(next)))};
}

inline void run(const ocio::ConstProcessorRcPtr& processor, std::span<std::array<float, 3>> colors) {
    if (colors.empty()) return;
    ocio::PackedImageDesc image(colors.data(), static_cast<long>(colors.size()), 1, 3);
    // As the operations are, so that what is compared is no faster approximation of them.
    processor->getOptimizedCPUProcessor(ocio::OPTIMIZATION_NONE)->apply(image);
}

}  // namespace darkroom
