// SPDX-License-Identifier: MIT
// In place of scene.cpp and sequence.cpp where what they measure is not built.
#include "scene.hpp"
#include "sequence.hpp"

namespace darkroom::bench {

std::vector<Recipe> scene_recipes() { return {}; }
std::vector<std::string> sequence_row_names() { return {}; }
Result<SequenceReport> measure_sequence(Device&, const SequenceDesc&) { return SequenceReport{}; }

}  // namespace darkroom::bench
