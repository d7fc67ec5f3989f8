// SPDX-License-Identifier: MIT
#pragma once
// How a raster kernel of the software driver gets the numbers of its blocks. That driver checks the bounds of a uniform
// buffer and gathers from it anew in every group of pixels, some thirty instructions a number. So the vertices read the
// blocks, and pixels get what they name as flat inputs, one instruction each. The bits are the same.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "gpu/kernel/kernel.hpp"
#include "gpu/shader/glsl_scan.hpp"
#include "gpu/shader/word_set.hpp"

namespace darkroom::gpu {

/// The own block, in vectors: these of the output, these of each image, custom, then the members.
inline constexpr std::uint32_t vectors_of_output = 2;
inline constexpr std::uint32_t vectors_per_image = 3;
[[nodiscard]] std::uint32_t first_custom_vector(const KernelSpec& spec);
[[nodiscard]] std::uint32_t first_member_vector(const KernelSpec& spec);

/// Can its vertices write that much? Only then may KernelSpec::is_software be set, which asks for it.
[[nodiscard]] bool writes_flat_values(const Context& context);

/// Vectors of the two blocks, in the order of the inputs' locations: first the frame's.
struct FlatValues {
    std::vector<std::uint32_t> frame, own;
};
/// Else the kernel reads its blocks, because its device does that well.
[[nodiscard]] bool takes_flat_values(const KernelSpec& spec, Stage stage);
/// What a kernel's body names of them. Its words are visited one after the other.
class WordsOfBlocks {
  public:
    explicit WordsOfBlocks(const KernelSpec& spec);
    void visit(std::string_view word, const GlslScanner& after);
    std::unordered_set<std::string_view> found;
    bool has_literal_indices = true;  ///< of custom, also by way of an entry's NAME_custom()

  private:
    WordSet asked_;
    bool has_custom_;  ///< else no word is looked at for that
};
[[nodiscard]] FlatValues flat_values(const KernelSpec& spec, const WordsOfBlocks& words);

/// Instead of the blocks' declarations: the inputs, what they hold under the members' names, and blocks of the rest.
[[nodiscard]] std::string flat_inputs(const KernelSpec& spec, const FlatValues& values);
/// Does the fragment shader made of that still read them? Else the vertices must not write them.
[[nodiscard]] bool reads_flat_inputs(std::span<const std::uint32_t> fragment);
/// The full-screen triangle that brings them.
[[nodiscard]] std::string flat_vertex_source(const KernelSpec& spec, const FlatValues& values);

}  // namespace darkroom::gpu
