// SPDX-License-Identifier: MIT
#include "formats/integer_rows.hpp"

#include <fmt/format.h>

#include <cstring>

namespace darkroom {
namespace {

template <class From, class Convert>
void put(const IntegerRow& row, const SamplePlace& place, std::byte* to, const Convert& convert) {
    const std::size_t step = sizeof(From) * row.channels;
    const std::byte* from = row.first + place.channel * sizeof(From);
    for (std::size_t x = 0; x < row.width; ++x, from += step, to += place.pixel_bytes) {
        From value;
        std::memcpy(&value, from, sizeof value);
        const auto converted = convert(value);
        std::memcpy(to, &converted, sizeof converted);
    }
}

}  // namespace

Result<> put_integers(const IntegerRow& row, const SamplePlace& place, std::byte* to) {
    const auto same = [](auto value) { return value; };
    const bool is_wide = row.bits == 16;
    if (place.kind == SampleKind::Integer8 && !is_wide)
        put<std::uint8_t>(row, place, to, same);
    else if (place.kind == SampleKind::Integer16 && is_wide)
        put<std::uint16_t>(row, place, to, same);
    else if (place.kind == SampleKind::Integer16)
        put<std::uint8_t>(row, place, to, [](std::uint8_t value) { return static_cast<std::uint16_t>(value * 257); });
    else if (place.kind == SampleKind::Float && !is_wide)
        put<std::uint8_t>(row, place, to, [](std::uint8_t value) { return static_cast<float>(value) / 255; });
    else if (place.kind == SampleKind::Float)
        put<std::uint16_t>(row, place, to, [](std::uint16_t value) { return static_cast<float>(value) / 65535; });
    else
        return user_error(fmt::format("{}-bit integers are not read as {}", row.bits, name_of(place.kind)));
    return {};
}

}  // namespace darkroom
