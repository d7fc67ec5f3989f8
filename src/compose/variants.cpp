// SPDX-License-Identifier: MIT
#include "compose/variants.hpp"

namespace darkroom::compose {

Result<> Variants::build_complete(gpu::Context& context) {
    auto kernel = gpu::Kernel::create(context, pass_->spec, pass_->stage);
    if (!kernel) return failure(std::move(kernel));
    complete_ = std::move(*kernel);
    return {};
}

Result<> Variants::build(gpu::Context& context, Shape shape) {
    if (!has_lean() || shape == no_shape) return {};
    const std::scoped_lock lock(building_);
    const std::size_t count = count_.load(std::memory_order_relaxed);
    for (std::size_t i = 0; i < count; ++i)
        if (lean_[i].shape == shape) return {};
    if (count == capacity) return {};

    std::vector<FusedStep> steps;
    for (std::size_t i = 0; i < pass_->steps.size(); ++i) {
        const Shape bits = shape >> (2 * i) & 3;
        if ((bits & 1) == 0) continue;
        steps.push_back(pass_->steps[i]);
        steps.back().is_certain = true;
        steps.back().is_plain = (bits & 2) == 0;
    }
    auto spec = lean_spec(*pass_, steps);
    if (!spec) return failure(std::move(spec));
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
    if (has_lean() && count < capacity) wanted_.store(shape, std::memory_order_relaxed);
    return *complete_;
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
            const Shape shape = variants->take_wanted();
            if (shape == no_shape) continue;
            if (const auto ok = variants->build(context_, shape); !ok)
                context_.say(Severity::Warning, "a lean kernel could not be built: " + ok.error().text);
        }
        if (is_ending_) return;
    }
}

}  // namespace darkroom::compose
