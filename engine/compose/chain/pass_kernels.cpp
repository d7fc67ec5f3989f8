// SPDX-License-Identifier: MIT
#include "compose/chain/pass_kernels.hpp"

#include <algorithm>
#include <utility>

#include "gpu/device/context.hpp"
#include "gpu/shader/shader.hpp"

namespace darkroom::compose {

Result<> PassKernels::build_complete(gpu::KernelStore& store) {
    DARKROOM_TRY_VALUE(auto spec, plan::complete_spec(pass_));
    DARKROOM_TRY_VALUE(complete_, store.get(spec, pass_.stage));
    return {};
}

Result<> PassKernels::build(gpu::Context& context, const plan::Shape& shape) try {
    Lean lean{.shape = shape};
    Result<> result;
    if (auto spec = plan::lean_spec(pass_, shape); !spec)
        result = failure(std::move(spec));
    else if (auto kernel = context.kernels->get(*spec, pass_.stage); kernel)
        lean.kernel = std::move(*kernel);
    else if (context.shaders->is_missing(kernel.error()))
        context.say(Severity::Info, kernel.error().text + "; the complete kernel, which is slower, takes its place");
    else
        result = failure(std::move(kernel));
    std::vector<Lean> spent;
    const std::scoped_lock lock(mutex_);
    if (!has_arrivals_) spent.swap(arrivals_);
    arrivals_.push_back(std::move(lean));
    if (std::ranges::find(built_, shape) == built_.end()) built_.push_back(shape);
    has_arrivals_ = true;
    return result;
} catch (...) {
    // Recordings have asked for it, and may ask again.
    const std::scoped_lock lock(mutex_);
    if (!has_arrivals_) arrivals_.clear();
    is_given_up_ = has_arrivals_ = true;
    throw;
}

bool PassKernels::was_built(const plan::Shape& shape) const {
    const std::scoped_lock lock(mutex_);
    return std::ranges::find(built_, shape) != built_.end();
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

void PassKernels::take_arrivals(std::uint64_t recording, std::uint64_t unfinished) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return;
    if (std::exchange(is_given_up_, false)) wanted_.reset();
    for (Lean& arrival : arrivals_) {
        if (wanted_ == arrival.shape) wanted_.reset();
        if (known(arrival.shape) != nullptr) continue;
        if (Lean* const place = place_for_another(recording, unfinished)) {
            arrival.last_used = recording;
            std::swap(*place, arrival);
        }
    }
    has_arrivals_ = false;
}

const gpu::Kernel* PassKernels::find(const plan::Shape& shape, std::uint64_t recording, std::uint64_t unfinished) {
    if (has_arrivals_) take_arrivals(recording, unfinished);
    Lean* const lean = known(shape);
    if (lean == nullptr) return nullptr;
    lean->last_used = recording;
    return lean->kernel ? lean->kernel.get() : complete_.get();
}

}  // namespace darkroom::compose
