// SPDX-License-Identifier: MIT
#pragma once
// Which files are compared with which: one with one, those of the same names in two folders, or those of the same
// numbers in two sequences. Names alone are looked at.

#include <darkroom/result.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace app {

struct FilePairs {
    struct Pair {
        std::filesystem::path reference, test;
    };
    std::vector<Pair> pairs;
    std::vector<std::filesystem::path> only_in_reference, only_in_test;
    bool is_single = false;  ///< two files were named
};

/// Of folders, the picture files directly in them, by their extensions. Errors: a folder or a sequence against anything
/// else, nothing in either, a sequence that matches nothing.
[[nodiscard]] darkroom::Result<FilePairs> find_pairs(const std::string& reference, const std::string& test);

}  // namespace app
