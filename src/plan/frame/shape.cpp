// SPDX-License-Identifier: MIT
#include "plan/frame/shape.hpp"

#include <utility>

#include "plan/program.hpp"

namespace darkroom::plan {

namespace {

std::uint32_t bits_of(const ParamInfo& row) {
    if (row.is_loop_count) return 8;
    return row.kind == Kind::Choice ? 5 : 1;
}

Result<gpu::KernelSpec> spec_of(const ProgramPass& pass, std::span<const FusedStep> steps, Finish finish) {
    gpu::KernelSpec spec = pass.spec;
    if (!pass.is_fused) {
        spec.body = pass_body(steps.front());
        return spec;
    }
    auto body = fused_body(steps, finish, pass.resampling, pass.is_alpha);
    if (!body) return failure(std::move(body));
    spec.body = std::move(*body);
    return spec;
}

}  // namespace

void lay_out_literals(ProgramPass& pass) {
    std::uint32_t bit = 0;
    for (std::uint32_t step = 0; step < pass.steps.size(); ++step) {
        if (pass.steps[step].is_merge) continue;
        for (const ParamInfo* const row : pass.steps[step].text->literal_rows) {
            const std::uint32_t bits = bits_of(*row);
            if (bit + bits > 64) continue;
            pass.literals.push_back({step, row, bit, bits});
            bit += bits;
        }
    }
}

bool has_lean(const ProgramPass& pass) { return pass.steps.size() <= max_lean_steps; }

Result<gpu::KernelSpec> complete_spec(const ProgramPass& pass) { return spec_of(pass, pass.steps, pass.finish); }

Result<gpu::KernelSpec> lean_spec(const ProgramPass& pass, const Shape& shape) {
    std::vector<FusedStep> steps = pass.steps;
    for (const Literal& literal : pass.literals)
        steps[literal.step].baked.push_back(
            {literal.row, static_cast<std::uint32_t>(shape.choices >> literal.bit & literal.mask())});
    if (pass.is_fused) {
        for (std::size_t i = 0; i < steps.size(); ++i) {
            steps[i].is_certain = (shape.steps >> (2 * i) & 1) != 0;
            steps[i].is_plain = (shape.steps >> (2 * i) & 2) == 0;
        }
        std::erase_if(steps, [](const FusedStep& step) { return !step.is_certain; });
    }
    const bool is_of_frame = pass.finish == Finish::OfFrame;
    auto spec =
        spec_of(pass, steps, is_of_frame ? static_cast<Finish>(shape.steps >> Shape::finish_bit & 3) : pass.finish);
    if (!spec) return spec;
    spec->is_whole = (shape.steps & Shape::is_whole) != 0;
    spec->input_is_twice = (shape.steps & Shape::input_is_twice) != 0;
    spec->output_is_twice = (shape.steps & Shape::output_is_twice) != 0;
    spec->rays_meet = (shape.steps & Shape::rays_meet) != 0;
    return spec;
}

}  // namespace darkroom::plan
