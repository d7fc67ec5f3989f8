// SPDX-License-Identifier: MIT
#include "film_grain/film_grain_av1.hpp"

#include <algorithm>

#include "film_grain/film_grain_gaussian.hpp"

namespace darkroom {

namespace {

/// get_random_number() of section 7.18.3.2: a shift register of 16 bits.
class Av1Register {
  public:
    explicit Av1Register(std::uint32_t state) : state_(state) {}
    std::int32_t draw(std::uint32_t bits) {
        const std::uint32_t bit = (state_ ^ state_ >> 1U ^ state_ >> 3U ^ state_ >> 12U) & 1U;
        state_ = state_ >> 1U | bit << 15U;
        return static_cast<std::int32_t>(state_ >> (16U - bits) & ((1U << bits) - 1U));
    }

  private:
    std::uint32_t state_;
};

/// Round2() of section 4.7: to nearest, halves upward, negative numbers, too.
std::int32_t rounded(std::int32_t value, std::int32_t bits) {
    return bits == 0 ? value : (value + (1 << (bits - 1))) >> bits;
}

struct Offset {
    std::int32_t x = 0, y = 0;
};

/// Where the template is read by each block of a row of them.
std::vector<Offset> offsets_of_row(const Av1Grain& grain, std::int32_t row, std::int32_t columns) {
    const auto number = static_cast<std::uint32_t>(row);
    Av1Register random(grain.grain_seed ^ ((number * 37 + 178) & 255U) << 8U ^ ((number * 173 + 105) & 255U));
    std::vector<Offset> offsets(static_cast<std::size_t>(columns));
    for (Offset& offset : offsets) {
        const std::int32_t drawn = random.draw(8);
        offset = {9 + (drawn >> 4) * 2, 9 + (drawn & 15) * 2};
    }
    return offsets;
}

}  // namespace

Av1Template av1_grain_template(const Av1Grain& grain) {
    const std::int32_t shift = 12 - grain.bit_depth + grain.grain_scale_shift;
    const std::int32_t center = 128 << (grain.bit_depth - 8);
    Av1Template out{};
    Av1Register random(grain.grain_seed);
    for (std::int16_t& value : out)
        value =
            static_cast<std::int16_t>(rounded(film_grain_gaussian[static_cast<std::size_t>(random.draw(11))], shift));

    const std::int32_t lag = grain.ar_coeff_lag;
    const auto at = [&](std::int32_t x, std::int32_t y) -> std::int16_t& {
        return out[static_cast<std::size_t>(y * av1_grain_width + x)];
    };
    for (std::int32_t y = 3; y < av1_grain_height; ++y)
        for (std::int32_t x = 3; x < av1_grain_width - 3; ++x) {
            std::int32_t sum = 0, before_x = -lag, before_y = -lag;
            for (const std::int8_t coefficient : grain.ar_coeffs_y) {
                sum += coefficient * at(x + before_x, y + before_y);
                if (++before_x > lag) {
                    before_x = -lag;
                    ++before_y;
                }
            }
            const std::int32_t value = at(x, y) + rounded(sum, grain.ar_coeff_shift);
            at(x, y) = static_cast<std::int16_t>(std::clamp(value, -center, center - 1));
        }
    return out;
}

std::vector<std::int16_t> av1_grain_picture(const Av1Grain& grain, std::int32_t columns, std::int32_t rows,
                                            bool wraps) {
    constexpr std::int32_t block = av1_grain_block;
    const std::int32_t width = columns * block, center = 128 << (grain.bit_depth - 8);
    const Av1Template luma = av1_grain_template(grain);
    const auto blended = [&](std::int32_t before, std::int32_t now, std::int32_t place) {
        const std::int32_t sum = place == 0 ? before * 27 + now * 17 : before * 17 + now * 27;
        return std::clamp(rounded(sum, 5), -center, center - 1);
    };
    std::vector<std::int16_t> out(static_cast<std::size_t>(width) * static_cast<std::size_t>(rows * block));
    for (std::int32_t row = 0; row < rows; ++row) {
        const std::vector<Offset> own = offsets_of_row(grain, row, columns);
        const std::vector<Offset> above = offsets_of_row(grain, (row + rows - 1) % rows, columns);
        for (std::int32_t y = 0; y < block; ++y)
            for (std::int32_t x = 0; x < width; ++x) {
                const std::int32_t column = x / block, inside = x % block;
                // A line of blocks: a block's first two texels are blended with what the one before has beyond its end.
                const auto of_line = [&](const std::vector<Offset>& offsets, std::int32_t line) {
                    const auto read = [&](std::int32_t which, std::int32_t across) {
                        const Offset offset = offsets[static_cast<std::size_t>(which)];
                        return std::int32_t{
                            luma[static_cast<std::size_t>((offset.y + line) * av1_grain_width + offset.x + across)]};
                    };
                    const std::int32_t now = read(column, inside);
                    if (inside > 1 || (column == 0 && !wraps)) return now;
                    return blended(read((column + columns - 1) % columns, block + inside), now, inside);
                };
                std::int32_t value = of_line(own, y);
                if (y < 2 && (row > 0 || wraps)) value = blended(of_line(above, block + y), value, y);
                out[static_cast<std::size_t>((row * block + y) * width + x)] = static_cast<std::int16_t>(value);
            }
    }
    return out;
}

}  // namespace darkroom
