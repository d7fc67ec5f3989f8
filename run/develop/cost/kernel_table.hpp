// SPDX-License-Identifier: MIT
#pragma once
// What kernels cost on a GPU, as a text file that people read and a later build is held against.

#include <darkroom/result.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace darkroom {

struct KernelRow {
    double vgprs = 0, waves = 0, instructions = 0, alu = 0, texture = 0, lds = 0;
    double spilled = 0;  ///< registers, and bytes of scratch memory
    [[nodiscard]] double cycles() const;
};

struct KernelTable {
    std::string driver;
    /// By name, stage and form: "bloom: bloom.prefilter, compute, lean".
    std::map<std::string, KernelRow> rows;

    [[nodiscard]] std::string text() const;
    /// Errors: a file that cannot be read, a line that is none of a table.
    [[nodiscard]] static Result<KernelTable> read(const std::filesystem::path& path);
};

/// A sentence for each kernel that spills, costs a tenth more than in `before`, or is not in it. Costs are compared
/// where the driver is the same.
[[nodiscard]] std::vector<std::string> findings(const KernelTable& before, const KernelTable& now);

}  // namespace darkroom
