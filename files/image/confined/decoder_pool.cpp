// SPDX-License-Identifier: MIT
#include "image/confined/decoder_pool.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <thread>

#include "core/program_module.hpp"

namespace darkroom {
namespace {

std::atomic<bool> is_allowed_here{true};

}  // namespace

void allow_decoding(bool is_allowed) { is_allowed_here = is_allowed; }
bool is_decoding_allowed() { return is_allowed_here; }

DecoderPool& DecoderPool::shared() {
    static DecoderPool pool;
    return pool;
}

Result<DecoderProcess*> DecoderPool::take(std::uint64_t source, bool needs_openimageio) {
    const std::size_t most = std::max(1U, std::thread::hardware_concurrency());
    DecoderProcess* found = nullptr;
    {
        std::unique_lock lock(mutex_);
        for (;;) {
            std::size_t count = 0;
            for (const auto& one : processes_) {
                if (one->has_openimageio != needs_openimageio) continue;
                ++count;
                if (!one->is_busy && (found == nullptr || one->source == source)) found = one.get();
            }
            if (found != nullptr) break;
            if (count < most) {
                found = processes_.emplace_back(std::make_unique<DecoderProcess>()).get();
                found->has_openimageio = needs_openimageio;
                break;
            }
            is_free_.wait(lock);
        }
        found->is_busy = true;
    }
    std::array<std::string, 1> module;
    if (needs_openimageio) module[0] = program_module("libdarkroom_oiio.so").string();
    if (!found->process.is_running()) {
        found->source = 0;
        found->memory = {};
        found->samples = {};
    }
    auto started = found->process.start(std::span<const std::string>(module).first(needs_openimageio ? 1 : 0));
    if (started) return found;
    give_back(*found);
    return failure(std::move(started));
}

void DecoderPool::give_back(DecoderProcess& process) {
    {
        const std::lock_guard lock(mutex_);
        process.is_busy = false;
    }
    is_free_.notify_all();
}

}  // namespace darkroom
