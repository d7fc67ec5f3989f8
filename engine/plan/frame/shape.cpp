// SPDX-License-Identifier: MIT
#include "plan/frame/shape.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "plan/frame/color.hpp"
#include "plan/program.hpp"

namespace darkroom::plan {

namespace {

std::uint32_t bits_of(const ParamInfo& row) {
    if (row.is_loop_count) return 8;
    if (row.kind != Kind::Choice) return 1;
    return std::max(1U, static_cast<std::uint32_t>(std::bit_width(row.choices.size() - 1)));
}

Result<std::string> body_of(const FusedPass& pass, std::span<const FusedStep> steps, Finish finish,
                            std::uint32_t word) {
    return fused_body(steps, finish, pass.resampling, pass.is_alpha, word, pass.alpha);
}
Result<std::string> body_of(const KernelPass&, std::span<const FusedStep> steps, Finish, std::uint32_t) {
    return pass_body(steps.front());
}
Result<std::string> body_of(const ComputePass&, std::span<const FusedStep> steps, Finish, std::uint32_t) {
    return pass_body(steps.front());
}
Result<std::string> body_of(const CopyPass& pass, std::span<const FusedStep>, Finish finish, std::uint32_t) {
    return fused_body({}, finish, pass.resampling);
}

/// `word`: of the frame's conversion, where the target's kernel finishes by that; none: it reads it.
Result<gpu::KernelSpec> spec_of(const ProgramPass& pass, std::span<const FusedStep> steps,
                                std::optional<std::uint32_t> word) {
    const FusedPass* const fused = pass.as<FusedPass>();
    const Finish finish = fused == nullptr                   ? Finish::None
                          : word && pass.finishes_by_frame() ? static_cast<Finish>(*word & 3)
                                                             : fused->finish;
    DARKROOM_TRY_VALUE(
        auto body,
        std::visit([&](const auto& kind) { return body_of(kind, steps, finish, word.value_or(0)); }, pass.kind));
    gpu::KernelSpec spec = pass.spec;
    spec.body = std::move(body);
    return spec;
}

}  // namespace

std::span<const FusedStep> ProgramPass::steps() const {
    if (const FusedPass* const fused = as<FusedPass>()) return fused->steps;
    if (const KernelPass* const kernel = of_effect()) return {&kernel->step, 1};
    return {};
}

// What a loop takes from a uniform buffer in each round costs the software driver as much as the round of ssao, and
// makes a blur half as slow again; some drivers take both sides of a branch around loads. A literal costs nothing.
void lay_out_literals(ProgramPass& pass) {
    std::uint32_t bit = 0;
    const std::span<const FusedStep> steps = pass.steps();
    for (std::uint32_t step = 0; step < steps.size(); ++step) {
        if (steps[step].is_merge) continue;
        for (const ParamInfo* const row : steps[step].text->literal_rows) {
            const std::uint32_t bits = bits_of(*row);
            if (bit + bits > 64) continue;
            pass.literals.push_back({step, row, bit, bits});
            bit += bits;
        }
    }
    for (std::uint32_t step = 0; step < steps.size(); ++step) {
        if (!steps[step].is_wrapped || bit + work_bits > 64) continue;
        pass.literals.push_back({step, nullptr, bit, work_bits});
        bit += work_bits;
    }
}

Result<gpu::KernelSpec> complete_spec(const ProgramPass& pass) { return spec_of(pass, pass.steps(), std::nullopt); }

Result<gpu::KernelSpec> lean_spec(const ProgramPass& pass, const Shape& shape) {
    const std::span<const FusedStep> all = pass.steps();
    std::vector<FusedStep> steps(all.begin(), all.end());
    for (const Literal& literal : pass.literals) {
        const auto value = static_cast<std::uint32_t>(shape.choices >> literal.bit & literal.mask());
        if (literal.row == nullptr)
            steps[literal.step].work = value;
        else
            steps[literal.step].baked.push_back({literal.row, value});
    }
    if (pass.as<FusedPass>() != nullptr) {
        const std::size_t known = std::min(steps.size(), Shape::max_steps);
        for (std::size_t i = 0; i < known; ++i) {
            steps[i].is_certain = shape.is_on(i);
            steps[i].is_plain = shape.is_plain(i);
        }
        const auto end = steps.begin() + static_cast<std::ptrdiff_t>(known);
        steps.erase(std::remove_if(steps.begin(), end, [](const FusedStep& step) { return !step.is_certain; }), end);
    }
    const auto finish = static_cast<std::uint32_t>(shape.flags >> Shape::finish_bit & ((1u << conversion_bits) - 1));
    auto spec = spec_of(pass, steps, finish);
    if (!spec) return spec;
    spec->is_whole = (shape.flags & Shape::is_whole) != 0;
    spec->rays_meet = (shape.flags & Shape::rays_meet) != 0;
    return spec;
}

}  // namespace darkroom::plan
