// SPDX-License-Identifier: MIT
#include "compose/chain/value_copies.hpp"

#include <cstring>
#include <utility>

#include "gpu/resource/barriers.hpp"

namespace darkroom::compose {

Result<ValueCopies> ValueCopies::create(gpu::Context& context, std::span<const plan::Program::NamedValue> values,
                                        std::uint32_t slots) {
    ValueCopies out;
    if (values.empty()) return out;
    out.context_ = &context;
    out.first_.push_back(0);
    for (const plan::Program::NamedValue& value : values) out.first_.push_back(out.first_.back() + value.numbers);
    out.written_.resize(slots);
    out.kept_.resize(slots);
    out.numbers_.resize(out.first_.back() * slots);
    DARKROOM_TRY_VALUE(
        out.buffer_, gpu::Buffer::create(context, out.numbers_.size() * sizeof(float), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                         gpu::Memory::Kind::Readback, "values"));
    return out;
}

void ValueCopies::begin(std::uint32_t slot) {
    if (written_.empty() || written_[slot].number == 0) return;
    kept_[slot] = std::exchange(written_[slot], {});
    const std::size_t first = first_.back() * slot;
    std::memcpy(numbers_.data() + first, buffer_.memory.mapped + first * sizeof(float), first_.back() * sizeof(float));
}

void ValueCopies::record(VkCommandBuffer commands, std::uint32_t slot, std::size_t value, VkBuffer from,
                         VkDeviceSize offset) const {
    const VkBufferCopy region{.srcOffset = offset,
                              .dstOffset = (first_.back() * slot + first_[value]) * sizeof(float),
                              .size = (first_[value + 1] - first_[value]) * sizeof(float)};
    context_->vk.CmdCopyBuffer(commands, from, buffer_.handle, 1, &region);
}

void ValueCopies::end(VkCommandBuffer commands, std::uint32_t slot, const Recording& recording) {
    gpu::record_barrier(context_->vk, commands, gpu::copied_to, gpu::read_by_host);
    written_[slot] = recording;
}

void ValueCopies::take_back(std::uint32_t slot) {
    if (!written_.empty()) written_[slot] = {};
}

ValueReading ValueCopies::find(std::size_t value, std::uint32_t view) const {
    const std::size_t none = kept_.size();
    std::size_t newest = none;
    for (std::size_t slot = 0; slot < kept_.size(); ++slot)
        if (kept_[slot].view == view && kept_[slot].number > (newest == none ? 0 : kept_[newest].number)) newest = slot;
    if (newest == none) return {};
    const float* const numbers = numbers_.data() + first_.back() * newest + first_[value];
    return {kept_[newest].frame_index, {numbers, first_[value + 1] - first_[value]}};
}

}  // namespace darkroom::compose
