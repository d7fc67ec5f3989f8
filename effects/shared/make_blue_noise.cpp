// SPDX-License-Identifier: MIT
// Writes the blue-noise tile: 64 x 64 ranks of 0 to 4095, each once, as text to be included by C++.
// Ulichney, "The void-and-cluster method for dither array generation", 1993: wherever the ranks are cut, the pixels
// below the cut are spread evenly. The tile repeats without a seam, and every run of the program writes the same one.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace {

constexpr std::size_t side = 64;
constexpr std::size_t count = side * side;
constexpr std::size_t initial_ones = count / 10;
/// Ulichney's choice: at this width neither rows nor diagonals appear.
constexpr double deviation = 1.5;

/// A binary pattern on a torus, and how crowded with ones each place is.
class Pattern {
  public:
    Pattern() {
        for (std::size_t i = 0; i < count; ++i) {
            const double x = wrapped_distance(i % side);
            const double y = wrapped_distance(i / side);
            // Rounded to integers, so that sums do not depend on their order and ties are true ties.
            gaussian_[i] = std::llround(std::exp(-(x * x + y * y) / (2.0 * deviation * deviation)) * 0x1p40);
        }
    }

    [[nodiscard]] bool is_one(std::size_t i) const { return ones_[i]; }
    void toggle(std::size_t i) {
        ones_[i] = !ones_[i];
        const std::int64_t sign = ones_[i] ? 1 : -1;
        for (std::size_t y = 0; y < side; ++y) {
            const std::size_t row = (y + side - i / side) % side * side;
            for (std::size_t x = 0; x < side; ++x) {
                energy_[y * side + x] += sign * gaussian_[row + (x + side - i % side) % side];
            }
        }
    }

    /// The one with the most ones around it.
    [[nodiscard]] std::size_t tightest_cluster() const {
        std::size_t best = count;
        for (std::size_t i = 0; i < count; ++i) {
            if (ones_[i] && (best == count || energy_[i] > energy_[best])) best = i;
        }
        return best;
    }
    /// The zero with the fewest ones around it.
    [[nodiscard]] std::size_t largest_void() const {
        std::size_t best = count;
        for (std::size_t i = 0; i < count; ++i) {
            if (!ones_[i] && (best == count || energy_[i] < energy_[best])) best = i;
        }
        return best;
    }

  private:
    static double wrapped_distance(std::size_t steps) {
        return static_cast<double>(steps < side / 2 ? steps : side - steps);
    }

    std::array<std::int64_t, count> gaussian_{};
    std::array<std::int64_t, count> energy_{};
    std::array<bool, count> ones_{};
};

/// Ones scattered by a fixed generator, then moved from the tightest cluster to the largest void until that is one
/// place.
Pattern initial_pattern() {
    Pattern pattern;
    std::uint32_t state = 1;
    for (std::size_t placed = 0; placed < initial_ones;) {
        // Numerical Recipes' linear congruential generator; its upper bits are the good ones.
        state = state * 1664525U + 1013904223U;
        const std::size_t place = state >> 20U;
        if (pattern.is_one(place)) continue;
        pattern.toggle(place);
        ++placed;
    }
    for (;;) {
        const std::size_t cluster = pattern.tightest_cluster();
        pattern.toggle(cluster);
        const std::size_t hole = pattern.largest_void();
        pattern.toggle(hole);
        if (hole == cluster) return pattern;
    }
}

std::vector<std::uint16_t> make_ranks() {
    const Pattern start = initial_pattern();
    std::vector<std::uint16_t> ranks(count);
    Pattern pattern = start;
    for (std::size_t rank = initial_ones; rank-- > 0;) {
        const std::size_t place = pattern.tightest_cluster();
        pattern.toggle(place);
        ranks[place] = static_cast<std::uint16_t>(rank);
    }
    // Past one half Ulichney looks for clusters of zeros. On a torus the crowding by zeros and by ones add up to a
    // constant, so the tightest cluster of zeros is the largest void.
    pattern = start;
    for (std::size_t rank = initial_ones; rank < count; ++rank) {
        const std::size_t place = pattern.largest_void();
        pattern.toggle(place);
        ranks[place] = static_cast<std::uint16_t>(rank);
    }
    return ranks;
}

}  // namespace

int main(int argument_count, char** arguments) {
    if (argument_count != 2) {
        std::fputs("dither_make_tile: needs one argument, the file to write\n", stderr);
        return 1;
    }
    std::FILE* file = std::fopen(arguments[1], "wb");
    if (file == nullptr) {
        std::fprintf(stderr, "dither_make_tile: cannot write '%s'\n", arguments[1]);
        return 2;
    }
    const std::vector<std::uint16_t> ranks = make_ranks();
    bool is_written = true;
    for (std::size_t i = 0; i < count; ++i) {
        const char* const separator = i + 1 == count ? "\n" : (i % 16 == 15 ? ",\n" : ", ");
        is_written = std::fprintf(file, "%u%s", unsigned{ranks[i]}, separator) > 0 && is_written;
    }
    if (std::fclose(file) != 0 || !is_written) {
        std::fprintf(stderr, "dither_make_tile: cannot write '%s'\n", arguments[1]);
        return 2;
    }
    return 0;
}
