// SPDX-License-Identifier: MIT
#pragma once
// What was found by comparing, as text and as JSON.

#include <span>
#include <string>
#include <vector>

#include "compare_files.hpp"
#include "programs/darkroom/run/json.hpp"

namespace app {

/// Many pairs, of which only the numbers are kept.
struct ComparedSet {
    std::vector<ComparedFiles> pairs;
    std::vector<std::string> only_in_reference, only_in_test;  ///< paths
    std::vector<std::string> errors;                           ///< of pairs that cannot be compared
    std::vector<std::string> sheet_rows;                       ///< names of the contact sheet's rows

    [[nodiscard]] std::size_t failed() const;
    [[nodiscard]] std::size_t missing() const { return only_in_reference.size() + only_in_test.size(); }
};

/// Numbers that JSON has not are the strings "nan", "inf" and "-inf".
[[nodiscard]] Json json_of(const ComparedFiles& files);
[[nodiscard]] Json json_of(const ComparedSet& set);

/// A line for each number, a block for each layer.
[[nodiscard]] std::string text_of(const ComparedFiles& files);
/// The head of a table, and its lines: one for each layer of a pair. `width` is that of the first column.
[[nodiscard]] std::string table_head(std::size_t width);
[[nodiscard]] std::string table_lines(const ComparedFiles& files, std::size_t width);
/// What is missing, and the worst and the mean of all pairs.
[[nodiscard]] std::string summary(const ComparedSet& set);

}  // namespace app
