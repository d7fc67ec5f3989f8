// SPDX-License-Identifier: MIT
#pragma once
// The results as a table for people, as JSON and as CSV. It holds no dates: two runs on one machine differ in figures
// only.

#include <filesystem>
#include <string>
#include <vector>

#include "rows.hpp"

namespace darkroom::bench {

struct Report {
    DeviceInfo device;
    std::vector<std::string> command_line;
    VkExtent2D extent{};
    std::uint32_t rounds = 0;
    double Sample::*cost = &Sample::cpu_ms;  ///< what the column c and the ratios compare
    std::vector<Row> rows;                   ///< the calibration pass first
    std::vector<Figure> figures;
    std::vector<PassRow> passes;
    std::vector<Row> sequence;  ///< milliseconds of a frame
    std::uint32_t sequence_frames = 0;
};

[[nodiscard]] std::string text(const Report& report);
[[nodiscard]] std::string json(const Report& report);
[[nodiscard]] std::string csv(const Report& report);

}  // namespace darkroom::bench
