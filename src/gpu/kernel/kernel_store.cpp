// SPDX-License-Identifier: MIT
#include "gpu/kernel/kernel_store.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/caught.hpp"

namespace darkroom::gpu {

namespace {

/// What the text does not say: a fragment shader names no format and no blending.
Hash key_of(const KernelSpec& spec, Stage stage, const std::string& source) {
    std::string key;
    key.reserve(source.size() + 64);
    key += static_cast<char>(stage);
    key += spec.is_additive ? '+' : '=';
    for (const VkFormat format : spec.outputs) key.append(std::to_string(format)).push_back(',');
    return content_hash(key += source);
}

}  // namespace

Result<std::shared_ptr<const Kernel>> KernelStore::get(const KernelSpec& spec, Stage stage) {
    std::string source = kernel_source(spec, stage);
    const Hash key = key_of(spec, stage, source);
    std::unique_lock lock(mutex_);
    const std::uint64_t now = ++counters_.requests;
    for (auto found = entries_.find(key); found != entries_.end(); found = entries_.find(key)) {
        Entry& entry = found->second;
        entry.last_used = now;
        if (entry.kernel) return entry.kernel;
        if (entry.error) return failure(*entry.error);
        built_.wait(lock);
    }
    entries_[key].last_used = now;
    lock.unlock();
    // Whoever waits for this kernel waits until it is made or has failed.
    auto made = [&]() -> Result<std::unique_ptr<Kernel>> {
        try {
            return Kernel::create(context_, spec, stage, std::move(source));
        } catch (...) {
            return caught("making a kernel");
        }
    }();
    lock.lock();
    ++(made ? counters_.built : counters_.failed);
    Result<std::shared_ptr<const Kernel>> result;
    if (made) {
        Entry& entry = entries_[key];
        entry.kernel = std::move(*made);
        result = entry.kernel;
    } else {
        result = failure(made.error());
        if (made.error().fault == Fault::User)
            entries_[key].error = made.error();
        else
            entries_.erase(key);
    }
    built_.notify_all();
    if (made) drop_unused();
    return result;
}

/// In steps of a quarter, so that not every new kernel sorts them.
void KernelStore::drop_unused() {
    using Place = decltype(entries_)::iterator;
    std::vector<Place> unused;
    for (auto place = entries_.begin(); place != entries_.end(); ++place)
        if (place->second.error || (place->second.kernel && place->second.kernel.use_count() == 1))
            unused.push_back(place);
    if (unused.size() <= most_unused_) return;
    std::ranges::sort(unused, {}, [](Place place) { return place->second.last_used; });
    unused.resize(unused.size() - most_unused_ * 3 / 4);
    for (const Place place : unused) entries_.erase(place);
}

KernelStore::Counters KernelStore::counters() const {
    const std::scoped_lock lock(mutex_);
    Counters out = counters_;
    out.held = entries_.size();
    return out;
}

}  // namespace darkroom::gpu
