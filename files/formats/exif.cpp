// SPDX-License-Identifier: MIT
#include "formats/exif.hpp"

namespace darkroom {

std::uint8_t orientation_of_exif(std::span<const std::byte> file) {
    constexpr std::size_t orientation = 274, short_type = 3;
    if (file.size() < 14) return 1;
    const bool is_little = file[0] == std::byte{'I'};
    const auto number = [&](std::size_t at, std::size_t size) {
        std::size_t value = 0;
        for (std::size_t i = 0; i < size; ++i)
            value = value << 8 | std::to_integer<std::size_t>(file[at + (is_little ? size - 1 - i : i)]);
        return value;
    };
    const std::size_t directory = number(4, 4);
    if (directory > file.size() - 2) return 1;
    const std::size_t count = number(directory, 2);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = directory + 2 + i * 12;
        if (file.size() - 12 < at) return 1;
        const std::size_t value = number(at + 8, 2);
        if (number(at, 2) == orientation && number(at + 2, 2) == short_type && value >= 1 && value <= 8)
            return static_cast<std::uint8_t>(value);
    }
    return 1;
}

}  // namespace darkroom
