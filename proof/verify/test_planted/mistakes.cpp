// SPDX-License-Identifier: MIT
// Each mistake is planted at the last place of a module that it fits: the first ones are regions and places of pixels.
#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>

#include "verify/test_planted/module.hpp"

namespace darkroom::verify::test {

namespace {

template <class Fits>
Instruction* last(Module& module, const Fits& fits) {
    const auto found = std::find_if(module.body.rbegin(), module.body.rend(), fits);
    return found == module.body.rend() ? nullptr : &*found;
}
Instruction* last_of(Module& module, std::initializer_list<std::uint32_t> codes) {
    return last(module, [&](const Instruction& one) { return std::ranges::find(codes, opcode(one)) != codes.end(); });
}
Instruction* last_glsl(Module& module, std::initializer_list<std::uint32_t> numbers) {
    return last(module, [&](const Instruction& one) {
        return std::ranges::any_of(numbers, [&](std::uint32_t number) { return is_glsl(one, number); });
    });
}

void set_code(Instruction& one, std::uint32_t code) { one[0] = (one[0] & 0xffff0000U) | code; }
/// One opcode for the other, whichever of both it is.
void exchange(Instruction& one, std::uint32_t a, std::uint32_t b) { set_code(one, opcode(one) == a ? b : a); }

/// Of an extended instruction the first operand alone remains.
bool keep_first(Instruction* one) {
    if (one == nullptr) return false;
    *one = {op::copy_object, (*one)[1], (*one)[2], (*one)[5]};
    return true;
}

bool drop_clamp(Module& module) { return keep_first(last_glsl(module, {glsl::clamp, glsl::n_clamp})); }
bool drop_pow(Module& module) { return keep_first(last_glsl(module, {glsl::pow})); }

bool min_for_max(Module& module) {
    Instruction* const one = last_glsl(module, {glsl::max, glsl::n_max});
    if (one == nullptr) return false;
    (*one)[4] = (*one)[4] == glsl::max ? glsl::min : glsl::n_min;
    return true;
}

bool turn_comparison(Module& module) {
    Instruction* const one = last_of(
        module, {op::f_ord_less_than, op::f_ord_greater_than, op::f_ord_less_than_equal, op::f_ord_greater_than_equal});
    if (one == nullptr) return false;
    const bool is_strict = opcode(*one) == op::f_ord_less_than || opcode(*one) == op::f_ord_greater_than;
    if (is_strict)
        exchange(*one, op::f_ord_less_than, op::f_ord_greater_than);
    else
        exchange(*one, op::f_ord_less_than_equal, op::f_ord_greater_than_equal);
    return true;
}

bool swap_swizzle(Module& module) {
    Instruction* const one = last(
        module, [](const Instruction& i) { return opcode(i) == op::vector_shuffle && i.size() >= 8 && i[5] != i[6]; });
    if (one == nullptr) return false;
    std::swap((*one)[5], (*one)[6]);
    return true;
}

bool extract_the_next(Module& module) {
    Instruction* const one =
        last(module, [](const Instruction& i) { return opcode(i) == op::composite_extract && i.size() == 5; });
    if (one == nullptr) return false;
    (*one)[4] = (*one)[4] == 0 ? 1 : 0;
    return true;
}

bool change_sign(Module& module) {
    Instruction* const one = last_of(module, {op::f_sub});
    if (one != nullptr) set_code(*one, op::f_add);
    return one != nullptr;
}

/// The last product is rounded to a half on its way.
bool halve_precision(Module& module) {
    Instruction* const one = last_of(module, {op::f_mul, op::vector_times_scalar});
    if (one == nullptr) return false;
    const std::uint32_t type = (*one)[1], result = (*one)[2], whole = module.new_id();
    (*one)[2] = whole;
    module.body.insert(module.body.begin() + (one - module.body.data()) + 1,
                       {op::quantize_to_f16, type, result, whole});
    return true;
}

bool lose_barrier(Module& module) {
    bool is_found = false;
    for (Instruction& one : module.body)
        if (opcode(one) == op::control_barrier) {
            one = {op::nop};
            is_found = true;
        }
    return is_found;
}

/// Of numbers, not of vectors. The first one: later loops are for pictures with NaN in them.
Instruction* first_test(Module& module, std::uint32_t code) {
    const auto found = std::ranges::find_if(
        module.body, [&](const Instruction& i) { return opcode(i) == code && !module.is_vector(i[1]); });
    return found == module.body.end() ? nullptr : &*found;
}

bool go_on_at_the_end(Module& module) {
    Instruction* const one = first_test(module, op::s_less_than);
    if (one != nullptr) set_code(*one, op::s_less_than_equal);
    return one != nullptr;
}

bool end_early(Module& module) {
    Instruction* const one = first_test(module, op::s_less_than_equal);
    if (one != nullptr) set_code(*one, op::s_less_than);
    return one != nullptr;
}

bool turn_offset(Module& module) {
    Instruction* const one =
        last(module, [&](const Instruction& i) { return opcode(i) == op::i_add && module.is_vector(i[1]); });
    if (one != nullptr) set_code(*one, op::i_sub);
    return one != nullptr;
}

bool shift_with_sign(Module& module) {
    Instruction* const one = last_of(module, {op::shift_right_logical});
    if (one != nullptr) set_code(*one, op::shift_right_arithmetic);
    return one != nullptr;
}

bool ceil_for_floor(Module& module) {
    Instruction* const one = last_glsl(module, {glsl::floor});
    if (one != nullptr) (*one)[4] = glsl::ceil;
    return one != nullptr;
}

bool swap_selection(Module& module) {
    Instruction* const one = last_of(module, {op::select});
    if (one != nullptr) std::swap((*one)[4], (*one)[5]);
    return one != nullptr;
}

bool swap_mix(Module& module) {
    Instruction* const one = last_glsl(module, {glsl::mix});
    if (one != nullptr) std::swap((*one)[5], (*one)[6]);
    return one != nullptr;
}

bool turn_division(Module& module) {
    Instruction* const one = last(module, [&](const Instruction& i) { return opcode(i) == op::f_div && i[3] != i[4]; });
    if (one != nullptr) std::swap((*one)[3], (*one)[4]);
    return one != nullptr;
}

/// Of a selection, not of a loop, which might not end.
bool take_other_branch(Module& module) {
    for (std::size_t i = module.body.size(); i-- > 1;) {
        Instruction& one = module.body[i];
        if (opcode(one) != op::branch_conditional || opcode(module.body[i - 1]) != op::selection_merge) continue;
        std::swap(one[2], one[3]);
        return true;
    }
    return false;
}

/// The last two members of the last block of uniforms change their places.
bool swap_offsets(Module& module) {
    constexpr std::uint32_t offset = 35;
    std::vector<Instruction*> found;
    for (Instruction& one : module.body)
        if (opcode(one) == op::member_decorate && one[3] == offset) found.push_back(&one);
    if (found.size() < 2) return false;
    Instruction &a = *found[found.size() - 1], &b = *found[found.size() - 2];
    if (a[1] != b[1]) return false;
    std::swap(a[4], b[4]);
    return true;
}

bool lose_a_term(Module& module) {
    Instruction* const one = last_of(module, {op::dot});
    if (one != nullptr) (*one)[4] = (*one)[3];
    return one != nullptr;
}

/// One workgroup, of 16x8 invocations, counts these pixels by luminance: its first half lines 0 to 3 and 8 to 11, its
/// second half lines 4 to 7 alone. Without a barrier the second half adds up its bins before lines 8 to 11 are in them,
/// whether a subgroup has 8 or 64 invocations.
constexpr VkExtent2D half_a_tile_more{64, 12};

constexpr std::array<Mistake, 20> all{{
    {"a clamp is dropped", "encode", drop_clamp},
    {"min for max", "fog", min_for_max},
    // Whatever a driver makes of it: the last one asks of every pixel whether a weight in [0, 1] is above 0.
    {"a comparison is turned round", "high_pass", turn_comparison},
    {"a swizzle has two letters changed", "hsv_adjust", swap_swizzle},
    {"the next component is taken", "color_grade", extract_the_next},
    {"a sign is wrong", "high_pass", change_sign},
    {"half for float", "exposure", halve_precision},
    {"barriers are lost", "auto_exposure", lose_barrier, half_a_tile_more},
    {"a loop goes on for one more", "radial_blur", go_on_at_the_end},
    {"a loop ends one early", "gaussian_blur", end_early},
    {"an offset in texels is turned round", "sharpen", turn_offset},
    {"a shift keeps the sign", "film_grain", shift_with_sign},
    {"ceil for floor", "posterize", ceil_for_floor},
    {"a selection takes the other one", "gamut_compression", swap_selection},
    {"the ends of a mix are changed", "grayscale", swap_mix},
    {"a power is dropped", "contrast_gamma", drop_pow},
    {"a division is turned round", "tonemap", turn_division},
    {"the other branch is taken", "fxaa", take_other_branch},
    {"two members of a block are changed", "grayscale", swap_offsets},
    {"a product of vectors is of one with itself", "color_grade", lose_a_term},
}};

}  // namespace

std::span<const Mistake> mistakes() { return all; }

}  // namespace darkroom::verify::test
