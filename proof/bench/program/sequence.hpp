// SPDX-License-Identifier: MIT
#pragma once
// From files to files: a sequence developed stage by stage in this process, by the program, and by OpenImageIO's
// oiiotool, which only drops the other channels and encodes. Wall time counts here, and how busy the processors are.

#include <string>
#include <vector>

#include "bench/rows.hpp"

namespace darkroom::bench {

struct SequenceDesc {
    VkExtent2D extent{};
    std::uint32_t frames = 0;
    std::uint32_t rounds = 1;  ///< a few are enough: a round is long
    std::string device;        ///< as the program's --device; empty: its own choice
};
struct SequenceReport {
    std::uint32_t frames = 0;
    std::vector<Row> rows;  ///< samples are of one frame: a round's time over its frames
    std::vector<Figure> figures;
};

[[nodiscard]] std::vector<std::string> sequence_row_names();
[[nodiscard]] Result<SequenceReport> measure_sequence(Device& device, const SequenceDesc& desc);

}  // namespace darkroom::bench
