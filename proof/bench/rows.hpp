// SPDX-License-Identifier: MIT
#pragma once
// All rows of the benchmark, and the figures that are made of them, with the targets they are held against.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "measure.hpp"

namespace darkroom::bench {

inline constexpr std::string_view calibration_name = "calibration (1 c)";
/// What the device takes to move bytes and do nothing else.
inline constexpr std::string_view floor_name = "copy of the scene's bytes (floor)";

/// A number that is derived from rows or counted, and what it should be at most or at least.
struct Figure {
    std::string name;
    double value = 0;
    std::string unit;
    std::optional<double> at_most{};
    std::optional<double> at_least{};
    [[nodiscard]] bool holds() const { return (!at_most || value <= *at_most) && (!at_least || value >= *at_least); }
};

/// The median time of one pass of a stack.
struct PassRow {
    std::string stack, pass;
    double milliseconds = 0;
};

[[nodiscard]] std::vector<std::string> row_names();
/// Only rows whose name holds one of `filters`, all without any; always the calibration pass, which comes first, and
/// the floor.
[[nodiscard]] Result<std::vector<Row>> make_rows(Bed& bed, std::span<const std::string> filters);
/// Of the rows that were measured.
[[nodiscard]] std::vector<Figure> ratio_figures(const Device& device, const std::vector<Row>& rows);
/// Transient memory, and the CPU time and allocations of `record`.
[[nodiscard]] Result<std::vector<Figure>> counted_figures(Bed& bed);
/// The hand-written tail against the fused one: the same picture?
[[nodiscard]] Result<std::vector<Figure>> picture_figures(Bed& bed, const std::vector<Row>& rows);
/// GPU time of every pass of the stacks, by timestamps around each: these stop a driver from overlapping passes.
[[nodiscard]] Result<std::vector<PassRow>> measure_passes(Bed& bed, std::uint32_t rounds);

}  // namespace darkroom::bench
