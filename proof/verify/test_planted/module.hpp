// SPDX-License-Identifier: MIT
#pragma once
// For tests only: a SPIR-V module as a list of instructions that can be changed, and mistakes of a compiler that are
// planted into one. Not part of the library.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>
#include <vector>

namespace darkroom::verify::test {

using Instruction = std::vector<std::uint32_t>;  ///< its words; the first holds the opcode and their number

/// Numbers of SPIR-V 1.6 and of its extended instructions GLSL.std.450, as far as tests name them.
namespace op {
inline constexpr std::uint32_t nop = 0, ext_inst = 12, type_vector = 23, member_decorate = 72, vector_shuffle = 79,
                               composite_extract = 81, copy_object = 83, quantize_to_f16 = 116, i_add = 128,
                               f_add = 129, i_sub = 130, f_sub = 131, f_mul = 133, f_div = 136,
                               vector_times_scalar = 142, dot = 148, select = 169, s_less_than = 177,
                               s_less_than_equal = 179, f_ord_less_than = 184, f_ord_greater_than = 186,
                               f_ord_less_than_equal = 188, f_ord_greater_than_equal = 190, shift_right_logical = 194,
                               shift_right_arithmetic = 195, control_barrier = 224, selection_merge = 247,
                               branch_conditional = 250;
}  // namespace op
namespace glsl {
inline constexpr std::uint32_t floor = 8, ceil = 9, pow = 26, min = 37, max = 40, clamp = 43, mix = 46, n_min = 79,
                               n_max = 80, n_clamp = 81;
}  // namespace glsl

struct Module {
    explicit Module(std::span<const std::uint32_t> words);
    [[nodiscard]] std::vector<std::uint32_t> words() const;

    [[nodiscard]] std::uint32_t new_id() { return header[3]++; }
    [[nodiscard]] bool is_vector(std::uint32_t type) const;

    std::vector<std::uint32_t> header;  ///< five words
    std::vector<Instruction> body;
};

[[nodiscard]] inline std::uint32_t opcode(const Instruction& one) { return one[0] & 0xffffU; }
/// Of an extended instruction its number.
[[nodiscard]] inline bool is_glsl(const Instruction& one, std::uint32_t number) {
    return opcode(one) == op::ext_inst && one[4] == number;
}

/// A mistake of a compiler.
struct Mistake {
    const char* name;
    const char* effect;  ///< whose kernels it is planted into
    /// Changes the module, and says whether there was a place for it.
    bool (*plant)(Module& module);
    VkExtent2D extent{67, 41};  ///< of the picture that shows it
};

/// Twenty, each of another kind.
[[nodiscard]] std::span<const Mistake> mistakes();

}  // namespace darkroom::verify::test
