// SPDX-License-Identifier: MIT
#pragma once
// The worst of many comparisons as one picture: a row each with the reference, the picture under test and the FLIP
// errors side by side, worst first. It keeps small copies alone, however many pictures it is shown.

#include <array>
#include <darkroom/result.hpp>
#include <string>
#include <vector>

#include "image/compare/compare.hpp"

namespace darkroom {

class ContactSheet {
  public:
    static constexpr std::size_t max_rows = 8;
    static constexpr std::uint32_t max_cell = 480;  ///< texels of a cell's longer side

    /// Takes the comparison in if it is among the worst: first by samples that are not finite in one picture alone,
    /// then by mean FLIP. Floats are shown sRGB-encoded and cut off at 1, what is not finite in magenta.
    [[nodiscard]] Result<> add(std::string name, const Picture& reference, const Picture& test,
                               const Comparison& comparison, PictureEncoding encoding);
    /// Display-encoded and opaque; one dark pixel where nothing was added.
    [[nodiscard]] Picture picture() const;
    /// Of the rows from the top.
    [[nodiscard]] std::vector<std::string> names() const;

  private:
    struct Row {
        std::string name;
        std::uint64_t non_finite = 0;
        double flip = 0;
        std::array<Picture, 3> cells;
        [[nodiscard]] bool is_worse_than(const Row& other) const {
            return non_finite != other.non_finite ? non_finite > other.non_finite : flip > other.flip;
        }
    };
    std::vector<Row> rows_;  // worst first
};

}  // namespace darkroom
