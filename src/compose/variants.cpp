// SPDX-License-Identifier: MIT
#include "compose/variants.hpp"

namespace darkroom::compose {

Result<gpu::KernelSpec> lean_spec(const ProgramPass& pass, std::span<const FusedStep> steps, Finish finish) {
    gpu::KernelSpec spec = pass.spec;
    if (!is_fused(pass)) {
        spec.body = effect_pass_body(pass, steps.front().baked);
        return spec;
    }
    auto body = fused_body(steps, finish, pass.resampling);
    if (!body) return failure(std::move(body));
    spec.body = std::move(*body);
    return spec;
}

Result<> Variants::build_complete(gpu::Context& context) {
    auto kernel = gpu::Kernel::create(context, pass_->spec, pass_->stage);
    if (!kernel) return failure(std::move(kernel));
    complete_ = std::move(*kernel);
    return {};
}

Result<> Variants::build(gpu::Context& context, Shape shape) {
    if (!has_lean()) return {};
    const std::scoped_lock lock(building_);
    const std::size_t count = count_.load(std::memory_order_relaxed);
    for (std::size_t i = 0; i < count; ++i)
        if (lean_[i].shape == shape) return {};
    if (count == capacity) return {};

    std::vector<FusedStep> steps = pass_->steps;
    if (!is_fused(*pass_)) steps.resize(1);
    for_each_choice(*pass_, [&](std::size_t step, const ParamInfo& row, std::uint32_t bit, std::uint32_t bits) {
        steps[step].baked.push_back({&row, static_cast<std::uint32_t>(shape.choices >> bit) & ((1u << bits) - 1)});
    });
    for (std::size_t i = 0; i < steps.size(); ++i) {
        steps[i].is_certain = (shape.steps >> (2 * i) & 1) != 0;
        steps[i].is_plain = (shape.steps >> (2 * i) & 2) == 0;
    }
    if (is_fused(*pass_)) std::erase_if(steps, [](const FusedStep& step) { return !step.is_certain; });
    const Finish finish =
        pass_->finish == Finish::OfFrame ? static_cast<Finish>(shape.steps >> Shape::finish_bit & 3) : pass_->finish;
    auto spec = lean_spec(*pass_, steps, finish);
    if (!spec) return failure(std::move(spec));
    spec->is_whole = (shape.steps & Shape::is_whole) != 0;
    spec->input_is_twice = (shape.steps & Shape::input_is_twice) != 0;
    auto kernel = gpu::Kernel::create(context, *spec, pass_->stage);
    if (!kernel) return failure(std::move(kernel));
    lean_[count] = {shape, std::move(*kernel)};
    count_.store(count + 1, std::memory_order_release);
    return {};
}

const gpu::Kernel& Variants::find(Shape shape) {
    const std::size_t count = count_.load(std::memory_order_acquire);
    for (std::size_t i = 0; i < count; ++i)
        if (lean_[i].shape == shape) return *lean_[i].kernel;
    if (has_lean() && count < capacity) {
        wanted_steps_.store(shape.steps, std::memory_order_relaxed);
        wanted_choices_.store(shape.choices, std::memory_order_relaxed);
        is_wanted_.store(true, std::memory_order_release);
    }
    return *complete_;
}

std::optional<Shape> Variants::take_wanted() {
    if (!is_wanted_.exchange(false, std::memory_order_acquire)) return std::nullopt;
    return Shape{wanted_steps_.load(std::memory_order_relaxed), wanted_choices_.load(std::memory_order_relaxed)};
}

Builders::Builders(gpu::Context& context, std::vector<std::unique_ptr<Variants>>& variants)
    : context_(context), variants_(variants), thread_([this] { work(); }) {}

Builders::~Builders() {
    is_ending_ = true;
    wake();
    thread_.join();
}

void Builders::wake() {
    calls_.fetch_add(1, std::memory_order_release);
    calls_.notify_one();
}

void Builders::work() {
    std::uint32_t seen = 0;
    while (true) {
        calls_.wait(seen, std::memory_order_acquire);
        seen = calls_.load(std::memory_order_acquire);
        for (const auto& variants : variants_) {
            if (is_ending_) return;
            if (!variants) continue;
            const std::optional<Shape> shape = variants->take_wanted();
            if (!shape) continue;
            if (const auto ok = variants->build(context_, *shape); !ok)
                context_.say(Severity::Warning, "a lean kernel could not be built: " + ok.error().text);
        }
        if (is_ending_) return;
    }
}

}  // namespace darkroom::compose
