// SPDX-License-Identifier: MIT
#pragma once
// Rows of integers as decoders give them, into the places of those who asked.

#include <cstddef>
#include <cstdint>

#include "formats/picture_source.hpp"

namespace darkroom {

/// Integers of 8 or 16 bits, as wide as this processor has them, pixel by pixel.
struct IntegerRow {
    const std::byte* first = nullptr;
    std::size_t width = 0, channels = 0, bits = 0;
};

/// As they are, widened, or as shares of the largest, which are divided: 8 bits and the same code in 16 bits are one
/// number then. An error where the place asks for something else.
[[nodiscard]] Result<> put_integers(const IntegerRow& row, const SamplePlace& place, std::byte* to);

}  // namespace darkroom
