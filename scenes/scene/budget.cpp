// SPDX-License-Identifier: MIT
#include "scene/budget.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace darkroom::scene {

Budget::Budget(std::uint64_t file_bytes, std::uint64_t sharers)
    : memory_{.limit = free_bytes / sharers}, work_{.limit = free_work / sharers} {
    add_file(file_bytes);
}

void Budget::add_file(std::uint64_t bytes) {
    file_bytes_ += bytes;
    memory_.limit += bytes * bytes_per_file_byte;
    work_.limit += bytes * work_per_file_byte;
}

void Budget::add_unpacked(std::uint64_t packed_bytes, std::uint64_t unpacked_bytes) {
    const std::uint64_t packed = std::min(packed_bytes, file_bytes_ - worth_ - packed_);
    packed_ += packed;
    if (unpacked_bytes <= packed) return;
    const std::uint64_t worth = std::min(unpacked_bytes, packed * max_unpacked_per_byte) - packed;
    worth_ += worth;
    add_file(worth);
}

Result<> Budget::take_from(Account& account, std::string_view place, std::string_view things, std::uint64_t count,
                           std::uint64_t size) {
    const std::uint64_t left = account.limit - account.taken;
    if (count == 0 || size <= left / count) {
        account.taken += count * size;
        return {};
    }
    Failure refused =
        user_error(fmt::format("{}: {} {} of {} bytes, {} are left of the {} that {} bytes of file may become", place,
                               count, things, size, left, account.limit, file_bytes_));
    if (!refusal_) refusal_ = refused.value();
    return refused;
}

Result<> Budget::take(std::string_view place, std::string_view things, std::uint64_t count, std::uint64_t size) {
    DARKROOM_TRY(take_from(memory_, place, things, count, size));
    return take_from(work_, place, things, count, size);
}

Result<> Budget::work(std::string_view place, std::string_view things, std::uint64_t count, std::uint64_t size) {
    return take_from(work_, place, things, count, size);
}

Result<> Budget::check() const {
    if (!refusal_) return {};
    return failure(*refusal_);
}

}  // namespace darkroom::scene
