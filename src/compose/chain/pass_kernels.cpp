// SPDX-License-Identifier: MIT
#include "compose/chain/pass_kernels.hpp"

#include <algorithm>
#include <bit>

#include "gpu/device/context.hpp"
#include "gpu/shader/shader.hpp"

namespace darkroom::compose {

PassKernels::~PassKernels() {
    for (Arrival* arrival = arrivals_.take_all(); arrival != nullptr;) {
        Arrival* const after = arrival->next;
        delete arrival;
        arrival = after;
    }
}

Result<> PassKernels::build_complete(gpu::KernelStore& store) {
    auto spec = plan::complete_spec(pass_);
    if (!spec) return failure(std::move(spec));
    auto kernel = store.get(*spec, pass_.stage);
    if (!kernel) return failure(std::move(kernel));
    complete_ = std::move(*kernel);
    return {};
}

Result<> PassKernels::build(gpu::Context& context, const plan::Shape& shape) {
    auto arrival = std::make_unique<Arrival>();
    arrival->lean.shape = shape;
    Result<> result;
    if (auto spec = plan::lean_spec(pass_, shape); !spec)
        result = failure(std::move(spec));
    else if (auto kernel = context.kernels->get(*spec, pass_.stage); kernel)
        arrival->lean.kernel = std::move(*kernel);
    else if (context.shaders->is_missing(kernel.error()))
        context.say(Severity::Info, kernel.error().text + "; the complete kernel, which is slower, takes its place");
    else
        result = failure(std::move(kernel));
    arrivals_.push(*arrival.release());
    const std::scoped_lock lock(built_mutex_);
    if (std::ranges::find(built_, shape) == built_.end()) built_.push_back(shape);
    return result;
}

bool PassKernels::was_built(const plan::Shape& shape) const {
    const std::scoped_lock lock(built_mutex_);
    return std::ranges::find(built_, shape) != built_.end();
}

std::optional<plan::Shape> PassKernels::take_wanted() {
    // Also a release: whoever wants something next may link it anew, after the worker has read the link.
    if (!is_wanted_.exchange(false, std::memory_order_acq_rel)) return std::nullopt;
    ShapeWords words;
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = wanted_[i].load(std::memory_order_relaxed);
    return std::bit_cast<plan::Shape>(words);
}

bool PassKernels::want(const plan::Shape& shape) {
    const auto words = std::bit_cast<ShapeWords>(shape);
    for (std::size_t i = 0; i < words.size(); ++i) wanted_[i].store(words[i], std::memory_order_relaxed);
    return !is_wanted_.exchange(true, std::memory_order_acq_rel);
}

PassKernels::Lean* PassKernels::known(const plan::Shape& shape) {
    const auto end = lean_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto found = std::find_if(lean_.begin(), end, [&](const Lean& lean) { return lean.shape == shape; });
    return found == end ? nullptr : &*found;
}

PassKernels::Lean* PassKernels::place_for_another(std::uint64_t recording, std::uint64_t unfinished) {
    if (count_ < lean_.size()) return &lean_[count_++];
    Lean& oldest = *std::ranges::min_element(lean_, {}, &Lean::last_used);
    return oldest.last_used + unfinished <= recording ? &oldest : nullptr;
}

void PassKernels::take_arrivals(std::uint64_t recording, std::uint64_t unfinished, AtomicStack<Garbage>& garbage) {
    for (Arrival* arrival = arrivals_.take_all(); arrival != nullptr;) {
        Arrival* const after = arrival->next;
        if (known(arrival->lean.shape) == nullptr) {
            if (Lean* const place = place_for_another(recording, unfinished)) {
                arrival->lean.last_used = recording;
                std::swap(*place, arrival->lean);
            }
        }
        garbage.push(*arrival);
        arrival = after;
    }
}

const gpu::Kernel* PassKernels::find(const plan::Shape& shape, std::uint64_t recording, std::uint64_t unfinished,
                                     AtomicStack<Garbage>& garbage) {
    if (!arrivals_.is_empty()) take_arrivals(recording, unfinished, garbage);
    Lean* const lean = known(shape);
    if (lean == nullptr) return nullptr;
    lean->last_used = recording;
    return lean->kernel ? lean->kernel.get() : complete_.get();
}

}  // namespace darkroom::compose
