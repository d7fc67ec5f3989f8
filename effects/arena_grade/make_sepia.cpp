// SPDX-License-Identifier: MIT
// Writes the sepia table: 16 x 16 x 16 colours of 8 bits, red fastest, as text to be included by C++. A colour's luma
// in the tone of a faded print: warm, no darker in the middle than it was.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

int main(int count, char** arguments) {
    std::FILE* const file = count == 2 ? std::fopen(arguments[1], "w") : nullptr;
    if (file == nullptr) return 1;
    constexpr int side = 16;
    constexpr std::array tone{1.07, 0.97, 0.78};
    bool is_written = true;
    for (int i = 0; i < side * side * side; ++i) {
        const double r = i % side, g = i / side % side, b = i / side / side;
        const double luma = (0.2126 * r + 0.7152 * g + 0.0722 * b) / (side - 1.0);
        for (const double factor : tone)
            is_written = std::fprintf(file, "%ld,", std::lround(255 * std::min(1.0, luma * factor))) > 0 && is_written;
        std::fputc('\n', file);
    }
    return std::fclose(file) == 0 && is_written ? 0 : 1;
}
