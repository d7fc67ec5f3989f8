// SPDX-License-Identifier: MIT
#pragma once
// Two files compared, layer by layer, with numbers as the files have them, and what of it is too much. It prints
// nothing.

#include <darkroom/result.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "image/compare/compare.hpp"
#include "image/picture/display_picture.hpp"

namespace app {

/// How far a test may be from its reference; not given: as far as it likes. NaN and infinities must be the same anyway.
struct Thresholds {
    std::optional<double> max, psnr, flip;
};

struct CompareRequest {
    std::vector<std::string> layers{"color"};  ///< see LayerFile::find
    bool has_all_layers = false;               ///< instead of `layers`, all that the files have
    Thresholds thresholds;
};

struct ComparedLayer {
    std::string name;
    std::vector<std::string> channels;  ///< that are counted in errors.worst
    darkroom::SampleErrors errors;      ///< of a color without its alpha
    std::optional<darkroom::SampleErrors> alpha;
    struct Flip {
        bool is_hdr = false;
        double mean = 0, weighted_median = 0, max = 0;
    };
    std::optional<Flip> flip;  ///< of a color
    bool is_integer = false;   ///< of 32 bits: numbers of things, which are the same or another

    [[nodiscard]] std::uint64_t non_finite_differences() const;
    [[nodiscard]] darkroom::NonFinite reference_counts() const;
    [[nodiscard]] darkroom::NonFinite test_counts() const;
    /// Alpha included.
    [[nodiscard]] double max_error() const;
};

struct ComparedFiles {
    std::string reference, test;  ///< paths
    std::vector<ComparedLayer> layers;
    std::vector<std::string> failures;  ///< what is too much; empty: the test passes
};

/// What a picture of a comparison is made of.
struct ComparedColor {
    darkroom::ComparablePicture reference, test;
    darkroom::Comparison comparison;
};

/// Errors name the file or both: it cannot be read, it lacks a layer, the sizes differ, one is encoded for a display
/// and the other is not. `color`: takes what is compared as color, if anything is.
[[nodiscard]] darkroom::Result<ComparedFiles> compare_files(const std::filesystem::path& reference,
                                                            const std::filesystem::path& test,
                                                            const CompareRequest& request,
                                                            std::optional<ComparedColor>* color = nullptr);

}  // namespace app
