// SPDX-License-Identifier: MIT
#pragma once
// What the numbers of a file's colour mean: which primaries, and by which curve light became them. Files say it, or
// whoever reads them does; it ends where a frame has been read, which is linear Rec. 709.

#include <darkroom/color_state.hpp>
#include <darkroom/result.hpp>
#include <string>
#include <string_view>

#include "core/primaries.hpp"

namespace darkroom {

/// From light to the numbers of a file, 1 being a white surface in both but for PQ and HLG.
struct TransferCurve {
    enum class Kind {
        Linear,
        Srgb,   ///< IEC 61966-2-1
        Power,  ///< light to the power of 1 / exponent
        Pq,     ///< SMPTE ST 2084, 1 being 203 cd/m2 (ITU-R BT.2408-7)
        Hlg,    ///< ITU-R BT.2100-2, a camera's light, 1 being what becomes 0.75 (ITU-R BT.2408-7)
    };
    Kind kind = Kind::Linear;
    double exponent = 1;

    [[nodiscard]] bool is_linear() const { return kind == Kind::Linear; }
    /// To light. Below 0 as above it, with the sign turned.
    [[nodiscard]] double decode(double code) const;
    [[nodiscard]] bool operator==(const TransferCurve&) const = default;
};

struct ColorCoding {
    Chromaticities primaries;
    TransferCurve curve{TransferCurve::Kind::Srgb};
    [[nodiscard]] bool operator==(const ColorCoding&) const = default;
};

/// A colour space that can be asked for by name. Files of floats and files of integers differ in their curves.
struct InputSpace {
    std::string_view name;
    Chromaticities primaries;
    TransferCurve floats, integers;
};

/// srgb, rec709, rec2020, p3, acescg or aces2065-1. An error names them.
[[nodiscard]] Result<InputSpace> find_input_space(std::string_view name);
[[nodiscard]] Chromaticities chromaticities_of(Primaries primaries);
/// The names of all, with commas.
[[nodiscard]] std::string input_space_names();

}  // namespace darkroom
