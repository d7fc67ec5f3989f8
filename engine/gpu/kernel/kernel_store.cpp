// SPDX-License-Identifier: MIT
#include "gpu/kernel/kernel_store.hpp"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "core/assert.hpp"
#include "core/caught.hpp"

namespace darkroom::gpu {

namespace {

#ifdef NDEBUG
constexpr bool keeps_texts = false;
#else
constexpr bool keeps_texts = true;
#endif

}  // namespace

std::size_t KernelStore::HashOfKey::operator()(const Key& key) const {
    std::size_t out = 0;
    std::memcpy(&out, key.text.data(), sizeof out);
    return out;
}

KernelStore::Key KernelStore::key_of(const KernelSpec& spec, Stage stage, const Digest& text) {
    Key key{.text = text, .stage = stage, .is_additive = spec.is_additive};
    std::ranges::copy(spec.outputs, key.outputs.begin());
    return key;
}

Result<std::shared_ptr<const Kernel>> KernelStore::get(const KernelSpec& spec, Stage stage) {
    DARKROOM_ASSERT(spec.outputs.size() <= max_outputs);
    const KernelText text(spec, stage);
    const Key key = key_of(spec, stage, text.digest);
    std::unique_lock lock(mutex_);
    const std::uint64_t now = ++counters_.requests;
    for (auto found = entries_.find(key); found != entries_.end(); found = entries_.find(key)) {
        Entry& entry = found->second;
        entry.last_used = now;
        DARKROOM_ASSERT(!keeps_texts || without_file_names(entry.text) == without_file_names(text.source));
        if (entry.kernel) return entry.kernel;
        if (entry.error && entry.text == text.source) return failure(*entry.error);
        if (entry.error) break;  // it names a file of the same text
        built_.wait(lock);
    }
    entries_[key] = {.last_used = now, .text = keeps_texts ? text.source : std::string()};
    lock.unlock();
    // Whoever waits for this kernel waits until it is made or has failed.
    auto made = [&]() -> Result<std::unique_ptr<Kernel>> {
        try {
            return Kernel::create(context_, spec, stage, text);
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
            entries_[key] = {.error = made.error(), .last_used = now, .text = text.source};
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
    if (unused.size() <= max_unused_) return;
    std::ranges::sort(unused, {}, [](Place place) { return place->second.last_used; });
    unused.resize(unused.size() - max_unused_ * 3 / 4);
    for (const Place place : unused) entries_.erase(place);
}

KernelStore::Counters KernelStore::counters() const {
    const std::scoped_lock lock(mutex_);
    Counters out = counters_;
    out.held = entries_.size();
    return out;
}

}  // namespace darkroom::gpu
