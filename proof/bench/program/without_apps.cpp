// SPDX-License-Identifier: MIT
// In place of baked.cpp, edits.cpp, scene.cpp and sequence.cpp where what they measure is not built.
#include "baked.hpp"
#include "bench/chain/recipe.hpp"
#include "edits.hpp"
#include "sequence.hpp"

namespace darkroom::bench {

Result<std::vector<Figure>> baked_figures(std::uint32_t) { return std::vector<Figure>(); }
Result<std::vector<Figure>> edit_figures(Device&, std::uint32_t) { return std::vector<Figure>(); }
std::vector<Recipe> scene_recipes() { return {}; }
std::vector<std::string> sequence_row_names() { return {}; }
Result<SequenceReport> measure_sequence(Device&, const SequenceDesc&) { return SequenceReport{}; }

}  // namespace darkroom::bench
