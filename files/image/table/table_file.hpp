// SPDX-License-Identifier: MIT
#pragma once
// Colour tables from files of any kind: .cube by the tree's own reader, pictures (strips and HaldCLUTs) through the
// readers of pictures, the others through OpenColorIO.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tables/cube_file.hpp"

namespace darkroom {

struct FoundTable {
    TableFile file;
    std::string format;  ///< ".cube", "a picture", ".clf"
    /// Largest difference of the table from the file's operations, on random colours of the table's inputs; only where
    /// OpenColorIO read the file.
    std::optional<double> error;
    /// What whoever uses the table should know, a line each, without the file's name.
    std::vector<std::string> warnings;
};

/// Of files of tables that are no pictures: ".cube", ".3dl".
[[nodiscard]] std::vector<std::string> table_extensions();
/// Is this the name of a file of tables that is no picture?
[[nodiscard]] bool is_table_name(const std::filesystem::path& path);
/// Errors begin with the path. `bits`: of the numbers of a .3dl file; else what the file says or OpenColorIO guesses.
[[nodiscard]] Result<FoundTable> read_table_file(const std::filesystem::path& path, std::optional<int> bits = {});

}  // namespace darkroom
